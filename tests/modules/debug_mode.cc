// A module whose containers are laid out in another way (_GLIBCXX_DEBUG is set for it).

#include "hsdm/plugin.hh"

namespace {

std::string nothing(hsdm::PolyMesh&, const hsdm::PluginOptions&) {
    return "";
}

} // namespace

HSDM_PLUGIN("debug_mode", "has checked containers", "", nothing)
