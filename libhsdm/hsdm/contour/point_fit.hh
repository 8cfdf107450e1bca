#pragma once
// How well the facets round vertices fit the points of their voxels.

#include "hsdm/contour/place_vertices.hh"
#include "hsdm/core/groups.hh"

namespace hsdm {

/// Compares facets with points, of each voxel at most eight, evenly taken: with the facets round the vertices
/// in the voxel, or in the voxels beside it where it has none.
class PointFit {
public:
    /// O(dual vertices + voxels). Everything given must outlive it; positions are given anew to measure().
    PointFit(const Octree& octree, const OctreeLevel& level, const DualVertices& duals,
             const PlacedVertices& vertices);

    /// Heights over the facets of the points whose feet lie round a vertex, each weighing what the vertex
    /// weighs at its foot (barycentric).
    struct Heights {
        double weight = 0, height = 0;                       ///< sums of w and w h
        double weight2 = 0, weight2_height = 0, height2 = 0; ///< of w^2, w^2 h and w^2 h^2
        void add(double w, double h);
        double mean() const { return weight > 0 ? height / weight : 0.0; }
        double variance() const; ///< of the mean
    };
    struct Measure {
        std::vector<double> misfit;   ///< per voxel the sum of the distances of its points from the facets
        std::vector<Heights> heights; ///< per vertex; none for all but smooth ones inside the surface
    };
    /// O(dual vertices), parallel, the same for any number of threads.
    Measure measure(const std::vector<Vec3>& positions) const;

    /// Per vertex how far the sheet should move along the vertex's direction to pass amid its points: their
    /// mean height; less, down to nothing, where the means round the vertex are no larger than chance makes
    /// them (twice their own variance), so that noise moves nothing. O(dual vertices), parallel.
    std::vector<double> rises(const std::vector<Heights>& heights) const;

private:
    struct Foreign {
        Index dual;
        double weight, height;
    };
    void gather_beside(Index voxel, std::vector<Index>& duals) const;

    const Octree& octree_;
    const OctreeLevel& level_;
    const DualVertices& duals_;
    const PlacedVertices& vertices_;
    Groups of_voxel_; // its dual vertices
};

} // namespace hsdm
