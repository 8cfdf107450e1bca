#pragma once
// How well the facets round vertices fit the points of their voxels.

#include "hsdm/contour/place_vertices.hh"
#include "hsdm/core/groups.hh"

namespace hsdm {

/// Of so many points of a voxel, from one that is compared with facets to the next.
std::size_t sample_stride(std::size_t points);

/// Compares facets with points, at most eight per voxel, evenly taken. The points of a voxel are compared
/// with the facets round the voxel's vertices, or, if it has none, round those of the voxels beside it.
class PointFit {
public:
    /// O(dual vertices + voxels). Everything given must outlive it; positions are given anew to measure().
    PointFit(const Octree& octree, const OctreeLevel& level, const DualVertices& duals,
             const PlacedVertices& vertices);

    /// Mean height over the facets of the points whose feet lie in facets round a vertex, each weighted by
    /// the vertex's barycentric weight at the foot.
    struct Heights {
        double weight = 0, height = 0;                       ///< sums of w and w h
        double weight2 = 0, weight2_height = 0, height2 = 0; ///< of w^2, w^2 h and w^2 h^2
        void add(double w, double h) {
            weight += w;
            height += w * h;
            weight2 += w * w;
            weight2_height += w * w * h;
            height2 += w * w * h * h;
        }
        double mean() const { return weight > 0 ? height / weight : 0.0; }
        double variance() const; ///< of the mean
    };
    struct Measure {
        /// per voxel, sum of the distances of its sampled points from the facets
        std::vector<double> misfit;
        /// Voxels with a point that stands out from the facets: farther off than sheets may be, and than the
        /// points of the voxels around; ascending.
        std::vector<Index> standing_out;
        std::vector<Heights> heights; ///< per vertex; empty except at smooth vertices inside the surface
    };
    /// O(dual vertices), parallel, the same for any number of threads.
    Measure measure(const std::vector<Vec3>& positions) const;

    /// Per vertex, how far to move it along its direction so that the sheet passes amid its points: their
    /// mean height, shrunk where noise explains it. It is 0 where the squares of the means round the vertex
    /// are no larger than twice their own variance. O(dual vertices), parallel.
    std::vector<double> rises(const std::vector<Heights>& heights) const;

private:
    static constexpr std::size_t ranges = 16;
    struct Foreign {
        Index dual;
        double weight, height;
    };
    /// Heights over a block's points of vertices in other blocks' voxels: those of range r of vertices are
    /// all[first[r]] .. all[first[r + 1]].
    struct ForeignHeights {
        std::vector<Foreign> all;
        std::array<Index, ranges + 1> first{};
        explicit ForeignHeights(const std::array<std::vector<Foreign>, ranges>& by_range);
        ForeignHeights() = default;
    };
    std::vector<Index> standing_out(const std::vector<double>& farthest,
                                    const std::vector<double>& misfit) const;
    void gather_beside(Index voxel, std::vector<Index>& duals) const;

    const Octree& octree_;
    const OctreeLevel& level_;
    const DualVertices& duals_;
    const PlacedVertices& vertices_;
    Groups of_voxel_;                 // its dual vertices
    std::vector<std::uint8_t> rises_; ///< per vertex, are heights asked for?
};

} // namespace hsdm
