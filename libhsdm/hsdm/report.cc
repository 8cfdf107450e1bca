#include "hsdm/report.hh"

#include "hsdm/version.hh"

#include <nlohmann/json.hpp>

namespace hsdm {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

Json to_json(const Report::Input& input) {
    return {{"file", input.file},
            {"points", input.points},
            {"dropped_nonfinite", input.dropped_nonfinite},
            {"merged_duplicates", input.merged_duplicates},
            {"has_normals", input.has_normals},
            {"bbox_min", to_json(input.bbox.lo)},
            {"bbox_max", to_json(input.bbox.hi)},
            {"spacing", input.spacing}};
}

Json to_json(const Report::Grid& grid) {
    return {{"kind", grid.kind},
            {"depth", grid.depth},
            {"voxel_size", grid.voxel_size},
            {"voxels", grid.voxels},
            {"leaves_per_level", grid.leaves_per_level},
            {"sets", grid.sets},
            {"balance_splits", grid.balance_splits},
            {"merged", grid.merged},
            {"max_error", grid.max_error},
            {"points_beyond", grid.points_beyond}};
}

Json to_json(const Report::Mesh& mesh) {
    return {{"vertices", mesh.vertices},
            {"edges", mesh.edges},
            {"faces", mesh.faces},
            {"triangles", mesh.triangles},
            {"quads", mesh.quads},
            {"larger", mesh.larger},
            {"components", mesh.components},
            {"boundary_loops", mesh.boundary_loops},
            {"boundary_edges", mesh.boundary_edges},
            {"euler", mesh.euler},
            {"genus", mesh.genus},
            {"closed", mesh.closed}};
}

Json to_json(const Report::Seconds& s) {
    return {{"read", s.read},     {"normals", s.normals}, {"octree", s.octree},     {"graph", s.graph},
            {"facets", s.facets}, {"mesh", s.mesh},       {"features", s.features}, {"error", s.error},
            {"write", s.write},   {"total", s.total}};
}

} // namespace

std::string to_json(const Report& report) {
    if (!report.failure.empty()) {
        const Json json = {{"version", version},
                           {"options", report.options},
                           {"input", to_json(report.input)},
                           {"grid", {{"depth", report.grid.depth}}},
                           {"failure", report.failure}};
        return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
    }
    const Json json = {
        {"version", version},
        {"options", report.options},
        {"input", to_json(report.input)},
        {"grid", to_json(report.grid)},
        {"mesh", to_json(report.mesh)},
        {"features",
         {{"sharp_edges", report.features.sharp_edges},
          {"smooth_vertices", report.features.smooth_vertices},
          {"edge_vertices", report.features.edge_vertices},
          {"corner_vertices", report.features.corner_vertices}}},
        {"error",
         {{"points_to_mesh_max", report.error.points_to_mesh_max},
          {"points_to_mesh_mean", report.error.points_to_mesh_mean},
          {"points_to_mesh_rms", report.error.points_to_mesh_rms},
          {"normalised_max", report.error.normalised_max},
          {"mesh_to_surface_max", report.error.mesh_to_surface_max},
          {"mesh_to_surface_mean", report.error.mesh_to_surface_mean}}},
        {"rejected", report.rejected},
        {"seconds", to_json(report.seconds)},
        {"peak_memory_bytes", report.peak_memory_bytes},
        {"threads", report.threads},
    };
    // A file name need not be UTF-8; JSON must be.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

} // namespace hsdm
