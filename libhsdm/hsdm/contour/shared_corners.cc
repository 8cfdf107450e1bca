#include "hsdm/contour/shared_corners.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace hsdm {
namespace {

class SharedCorners {
public:
    SharedCorners(const DualMesh& mesh, const PlacedVertices& vertices)
        : mesh_(mesh), duals_(mesh.duals), vertices_(vertices) {}

    void find(const PlacedVertices::Beyond& beyond, std::vector<EdgeCollapse>& edges) {
        if (duals_.open[beyond.dual]) return;
        holders_.clear();
        for (FacetCorner corner : duals_.corners_of(beyond.dual)) {
            for (Index next : {duals_.to(corner), duals_.from(corner.previous())})
                if (can_hold(next, beyond))
                    holders_.push_back({!is_corner(next), outside(next, beyond.position), next});
        }
        sort_unique(holders_);
        for (const auto& [has_none, distance, holder] : holders_)
            edges.push_back({beyond.dual, holder, has_none ? beyond.position : vertices_.positions[holder]});
    }

private:
    /// Is a dual vertex a corner that lies where its planes meet?
    bool is_corner(Index dual) const {
        return vertices_.classes[dual] == VertexClass::corner && !vertices_.is_clamped[dual];
    }

    bool can_hold(Index dual, const PlacedVertices::Beyond& beyond) const {
        if (dual == beyond.dual || duals_.open[dual] || !may_reach(dual, beyond)) return false;
        const double near = sheets::plane_error * mesh_.voxel_size;
        if (is_corner(dual)) return (vertices_.positions[dual] - beyond.position).norm() < near;
        const auto corners = duals_.corners_of(dual);
        return std::all_of(corners.begin(), corners.end(), [&](FacetCorner corner) {
            const Vec3& normal = mesh_.crossings.of(corner).normal;
            return std::abs(normal | (beyond.position - mesh_.crossing_position_of(corner))) < near
                   && has_sheet(beyond, normal);
        });
    }

    /// May the vertex of a neighbouring voxel lie at the corner: in its own voxel, or beyond a face of it
    /// into voxels of which no sheet crosses an edge?
    bool may_reach(Index dual, const PlacedVertices::Beyond& beyond) const {
        if (outside(dual, beyond.position) < sheets::plane_error) return true;
        const VoxelCoord here = mesh_.voxel_of(beyond.dual), there = mesh_.voxel_of(dual);
        unsigned axis = 0;
        while (axis < 2 && here[axis] == there[axis]) ++axis;
        if (there[axis] != here[axis] + beyond.step[axis]) return false;
        for (unsigned way = 1; way < 8; ++way)
            if (way >> axis & 1u && way != 1u << axis && beyond.crossed >> way & 1u) return false;
        return true;
    }

    static bool has_sheet(const PlacedVertices::Beyond& beyond, const Vec3& normal) {
        return std::ranges::any_of(beyond.normals,
                                   [&](const Vec3& n) { return (n | normal) > angles::one_sheet; });
    }

    /// How far a point lies beyond the faces of a dual vertex's voxel, in voxels; 0 inside.
    double outside(Index dual, const Vec3& point) const {
        const VoxelCoord voxel = mesh_.voxel_of(dual);
        Vec3 lo(0, 0, 0), hi(1, 1, 1), at;
        for (unsigned k = 0; k < 3; ++k) at[k] = point[k] / mesh_.voxel_size - voxel[k];
        if (mesh_.is_moved(dual)) include_crossings(dual, lo, hi);
        double most = 0;
        for (unsigned k = 0; k < 3; ++k) most = std::max({most, lo[k] - at[k], at[k] - hi[k]});
        return most;
    }

    /// In voxels, from the voxel's lowest corner.
    void include_crossings(Index dual, Vec3& lo, Vec3& hi) const {
        const VoxelCoord voxel = mesh_.voxel_of(dual);
        const Vec3 corner = Vec3(voxel[0], voxel[1], voxel[2]) * mesh_.voxel_size;
        Vec3 least = corner + lo * mesh_.voxel_size, most = corner + hi * mesh_.voxel_size;
        mesh_.include_crossings(dual, least, most);
        lo = (least - corner) / mesh_.voxel_size, hi = (most - corner) / mesh_.voxel_size;
    }

    const DualMesh& mesh_;
    const DualVertices& duals_;
    const PlacedVertices& vertices_;
    // Candidates: (is no corner itself, how far the corner lies outside its voxel, dual vertex). The best
    // comes first.
    std::vector<std::tuple<bool, double, Index>> holders_;
};

/// A vertex can stand for one corner only: keeps, of the edges to each vertex, those whose corner is at the
/// place of the first one's.
std::vector<EdgeCollapse> with_one_corner_each(const std::vector<EdgeCollapse>& edges, double near) {
    std::vector<EdgeCollapse> by_holder = edges, kept;
    std::stable_sort(by_holder.begin(), by_holder.end(),
                     [](const EdgeCollapse& a, const EdgeCollapse& b) { return a.to < b.to; });
    for (const EdgeCollapse& edge : edges) {
        const auto first =
            std::lower_bound(by_holder.begin(), by_holder.end(), edge.to,
                             [](const EdgeCollapse& a, Index holder) { return a.to < holder; });
        if ((first->position - edge.position).norm() < near)
            kept.push_back({edge.from, edge.to, first->position});
    }
    return kept;
}

} // namespace

std::vector<EdgeCollapse> shared_corners(const DualMesh& mesh, const PlacedVertices& vertices) {
    std::vector<EdgeCollapse> edges;
    SharedCorners corners(mesh, vertices);
    for (const PlacedVertices::Beyond& beyond : vertices.beyond) corners.find(beyond, edges);
    return with_one_corner_each(edges, sheets::plane_error * mesh.voxel_size);
}

} // namespace hsdm
