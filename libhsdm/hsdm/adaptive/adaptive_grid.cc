#include "hsdm/adaptive/adaptive_grid.hh"

#include "hsdm/adaptive/coarsen.hh"
#include "hsdm/errors.hh"
#include "hsdm/reconstruct.hh"

#include <cstdio>

namespace hsdm {
namespace {

constexpr double default_error = 0.1; // voxels of the finest level

double error_bound(const MethodInput& in) {
    if (!in.options.max_error) return default_error * in.level.voxel_size;
    const MaxError& asked = *in.options.max_error;
    return asked.of_diagonal ? asked.value * in.octree.bounds.diagonal() : asked.value;
}

/// Properties of the fine vertices that the coarse ones stand for; levels are their own.
std::vector<VertexProperty> properties_of(const PolygonMesh& fine, const AdaptiveMesh& coarse) {
    std::vector<VertexProperty> result = fine.properties;
    for (VertexProperty& property : result) {
        std::vector<double> values;
        for (std::size_t v = 0; v < coarse.source.size(); ++v)
            values.push_back(property.name == "hsdm_level" ? coarse.level[v]
                                                           : property.values[coarse.source[v]]);
        property.values = std::move(values);
    }
    return result;
}

} // namespace

bool wants_adaptive(const ReconstructOptions& options) {
    return options.grid == Grid::adaptive || (options.grid == Grid::automatic && options.max_error);
}

PolygonMesh adaptive_grid(const MethodInput& in, const PolygonMesh& fine, Report& report) {
    const double bound = error_bound(in);
    AdaptiveMesh coarse =
        coarsen(fine, in.octree.positions, in.octree.extent, in.level.depth, {.max_error = bound});
    report.grid.kind = "adaptive";
    report.grid.leaves_per_level = coarse.leaves_per_level;
    report.grid.balance_splits = coarse.balance_splits;
    report.grid.max_error = bound;
    report.grid.points_beyond = coarse.points_beyond;
    report.rejected["leaves_split_for_topology"] = coarse.topology_splits;
    report.rejected["leaves_split_for_error"] = coarse.error_splits;
    report.rejected["leaves_split_for_intersections"] = coarse.intersection_splits;
    if (coarse.points_beyond > coarse.unreachable) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "max_error %.6g: not kept for %zu points; ask for a larger one, or for a uniform grid",
                      bound, coarse.points_beyond - coarse.unreachable);
        throw Error(text);
    }
    coarse.mesh.properties = properties_of(fine, coarse);
    return std::move(coarse.mesh);
}

} // namespace hsdm
