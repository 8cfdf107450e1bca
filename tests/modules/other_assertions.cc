// A module that has assertions where hsdm has none, or the other way about.

#include "hsdm/plugin.hh"

namespace {

#ifdef NDEBUG
constexpr const char* assertions = "off";
#else
constexpr const char* assertions = "on";
#endif

/// Walks over all of the mesh and changes its arrays.
std::string split_and_count(hsdm::PolyMesh& mesh, const hsdm::PluginOptions&) {
    std::size_t corners = 0;
    for (const auto f : mesh.faces())
        for (const auto v : f.vertices()) corners += v.is_valid();
    mesh.triangulate();
    return std::to_string(corners) + " corners, assertions " + assertions;
}

} // namespace

HSDM_PLUGIN("other_assertions", "splits polygons", "", split_and_count)
