// A module of the right interface, built for another hsdm, with code that runs as soon as it is loaded.

#include "modules/when_loaded.hh"

#include "hsdm/plugin.hh"

#undef HSDM_PLUGIN_BUILD
#define HSDM_PLUGIN_BUILD "hsdm 0.0.0, compiler of old, OpenMesh 1"

namespace {

const hsdm::test::WhenLoaded when_loaded;

std::string nothing(hsdm::PolyMesh&, const hsdm::PluginOptions&) {
    return "";
}

} // namespace

HSDM_PLUGIN("wrong_build", "is of another build", "no options", nothing)
