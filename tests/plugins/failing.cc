// A module whose function throws.

#include "hsdm/plugin.hh"

#include <stdexcept>

namespace {

std::string fail(hsdm::PolyMesh&, const hsdm::PluginOptions& options) {
    options.allow({"long"});
    throw std::runtime_error(options.has("long") ? std::string(5000, 'x') : "out of luck");
}

} // namespace

HSDM_PLUGIN("failing", "always fails", "long: with a long message", fail)
