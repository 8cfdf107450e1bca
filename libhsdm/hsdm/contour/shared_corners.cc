#include "hsdm/contour/shared_corners.hh"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace hsdm {
namespace {

constexpr double same_place = 0.1; // voxels: corners this near are one, planes this near pass through it
constexpr double same_sheet_cosine = 0.77; // normals within 40 degrees

class SharedCorners {
public:
    SharedCorners(const CornerLattice& lattice, const Crossings& crossings, const Fans& fans,
                  double voxel_size, const VertexPositions& vertices)
        : lattice_(lattice), crossings_(crossings), fans_(fans), h_(voxel_size), vertices_(vertices) {}

    void find(const VertexPositions::Beyond& beyond, std::vector<EdgeCollapse>& edges) {
        if (fans_.open[beyond.fan]) return;
        holders_.clear();
        for (Node node : fans_.fan(beyond.fan)) {
            const Index x = node / 4;
            const unsigned j = node % 4;
            for (Index next : {fans_.at(x, (j + 1) % 4, j), fans_.at(x, (j + 3) % 4, (j + 3) % 4)})
                if (can_hold(next, beyond))
                    holders_.push_back({!is_corner(next), outside(next, beyond.position), next});
        }
        std::sort(holders_.begin(), holders_.end());
        holders_.erase(std::unique(holders_.begin(), holders_.end()), holders_.end());
        for (const auto& [has_none, distance, holder] : holders_)
            edges.push_back({beyond.fan, holder, has_none ? beyond.position : vertices_.positions[holder]});
    }

private:
    /// Where its planes meet?
    bool is_corner(Index fan) const {
        return vertices_.classes[fan] == VertexClass::corner && !vertices_.is_clamped[fan];
    }

    bool can_hold(Index fan, const VertexPositions::Beyond& beyond) const {
        if (fan == beyond.fan || fans_.open[fan] || !may_reach(fan, beyond)) return false;
        const double near = same_place * h_;
        if (is_corner(fan)) return (vertices_.positions[fan] - beyond.position).norm() < near;
        const auto nodes = fans_.fan(fan);
        return std::all_of(nodes.begin(), nodes.end(), [&](Node node) {
            const Crossing& x = crossings_.crossings[node / 4];
            return std::abs(x.normal | (beyond.position - crossing_position(lattice_, x, h_))) < near
                   && has_sheet(beyond, x.normal);
        });
    }

    /// May the vertex of a neighbouring voxel lie at the corner, in its own voxel or beyond a face of that
    /// across which no sheet crosses an edge?
    bool may_reach(Index fan, const VertexPositions::Beyond& beyond) const {
        if (outside(fan, beyond.position) < same_place) return true;
        const VoxelCoord here = voxel_of(beyond.fan), there = voxel_of(fan);
        unsigned axis = 0;
        while (axis < 2 && here[axis] == there[axis]) ++axis;
        if (there[axis] != here[axis] + beyond.step[axis]) return false;
        for (unsigned way = 1; way < 8; ++way)
            if (way >> axis & 1u && way != 1u << axis && beyond.crossed >> way & 1u) return false;
        return true;
    }

    static bool has_sheet(const VertexPositions::Beyond& beyond, const Vec3& normal) {
        return std::ranges::any_of(beyond.normals,
                                   [&](const Vec3& n) { return (n | normal) > same_sheet_cosine; });
    }

    /// How far a point lies beyond the faces of a fan's voxel, in voxels; 0 inside.
    double outside(Index fan, const Vec3& point) const {
        const VoxelCoord voxel = voxel_of(fan);
        double most = 0;
        for (unsigned k = 0; k < 3; ++k) {
            const double at = point[k] / h_ - voxel[k];
            most = std::max({most, -at, at - 1});
        }
        return most;
    }

    VoxelCoord voxel_of(Index fan) const {
        const Node node = fans_.fan(fan)[0];
        const Index edge = crossings_.crossings[node / 4].edge;
        const unsigned octant = Ring::octant(edge % 3, node % 4);
        VoxelCoord voxel = lattice_.coord(edge / 3);
        for (unsigned k = 0; k < 3; ++k) voxel[k] += static_cast<int>(octant >> k & 1u) - 1;
        return voxel;
    }

    const CornerLattice& lattice_;
    const Crossings& crossings_;
    const Fans& fans_;
    double h_;
    const VertexPositions& vertices_;
    // Those with the corner already first, then by how far beyond their voxels it lies.
    std::vector<std::tuple<bool, double, Index>> holders_;
};

/// A vertex can stand for one corner only: of the edges to it those whose corner is the first one's, at the
/// same place.
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

std::vector<EdgeCollapse> shared_corners(const CornerLattice& lattice, const Crossings& crossings,
                                         const Fans& fans, double voxel_size,
                                         const VertexPositions& vertices) {
    std::vector<EdgeCollapse> edges;
    SharedCorners corners(lattice, crossings, fans, voxel_size, vertices);
    for (const VertexPositions::Beyond& beyond : vertices.beyond) corners.find(beyond, edges);
    return with_one_corner_each(edges, same_place * voxel_size);
}

} // namespace hsdm
