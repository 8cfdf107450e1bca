#include "hsdm/pipeline/confidence.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "hsdm/pipeline/measure.hh"

#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

/// Measured points within a voxel's edge of a place that face along a unit normal.
Index count_around(const Octree& octree, const OctreeLevel& level, const Vec3& place, const Vec3& normal) {
    const double h = level.voxel_size;
    VoxelCoord at;
    for (unsigned k = 0; k < 3; ++k) at[k] = static_cast<std::int32_t>(std::floor(place[k] / h));
    Index count = 0;
    const auto look = [&](const VoxelCoord& c) {
        const Index voxel = level.find(c);
        if (voxel == no_index) return;
        for (Index p = level.first_point[voxel]; p < level.first_point[voxel + 1]; ++p)
            count += octree.is_measured(p) && (octree.positions[p] - place).sqrnorm() < h * h
                     && (octree.normals[p] | normal) > 0.5;
    };
    look(at);
    for (const VoxelCoord& o : neighbor_offsets) look({at[0] + o[0], at[1] + o[1], at[2] + o[2]});
    return count;
}

} // namespace

std::vector<double> vertex_confidence(const Octree& octree, const OctreeLevel& level, const PolygonMesh& mesh,
                                      double spacing, bool turned) {
    const std::vector<Vec3> directions = vertex_area_vectors(mesh);
    const double wide = level.voxel_size / spacing, expected = std::numbers::pi * wide * wide;
    std::vector<double> confidence = large_vector<double>(mesh.vertex_count());
    for_each_index(mesh.vertex_count(), chunks::heavy, [&](Index v) {
        const Vec3 normal = unit(directions[v]) * (turned ? -1.0 : 1.0);
        const Index count = count_around(octree, level, mesh.positions[v], normal);
        confidence[v] = std::min(1.0, count / expected);
    });
    return confidence;
}

void trim_by_confidence(double least, const MethodInput& in, PolygonMesh& facets, FacetKnowledge& known,
                        Report& report) {
    const auto property = std::ranges::find(facets.properties, confidence_property, &VertexProperty::name);
    if (property == facets.properties.end()) return;
    Occurrences trimmed = remove_facets(facets, known.hints.sides, [&](std::size_t f) {
        double sum = 0;
        for (const Index v : facets.facet(f)) sum += property->values[v];
        return sum < least * static_cast<double>(facets.facet(f).size());
    });
    report.rejected["facets_trimmed"] = trimmed.count;
    if (trimmed.count == 0) return;
    if (facets.facet_count() == 0) throw Error("trim: no facet has so much confidence; trim less");
    remove_isolated_vertices(facets);
    known.links.reset();
    known.cells.reset();
    if (known.intersections.count > 0) known.intersections = facets_that_meet(facets);
    trimmed.first += in.octree.origin;
    note_dropped("facets of less confidence than asked for", trimmed, in.frame, report);
}

} // namespace hsdm
