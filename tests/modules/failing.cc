// A module whose function throws, and of which other code runs as soon as it is loaded.

#include "modules/when_loaded.hh"

#include "hsdm/plugin.hh"

#include <stdexcept>

namespace {

const hsdm::test::WhenLoaded when_loaded;

std::string fail(hsdm::PolyMesh&, const hsdm::PluginOptions& options) {
    throw std::runtime_error(options.has("long") ? std::string(5000, 'x') : "out of luck");
}

} // namespace

HSDM_PLUGIN("failing", "always fails", "long= (text): with a long message", fail)
