#pragma once
// Distances of many points to a surface for which a tree, a walk or a grid of cells exists already.

#include "hsdm/quality/distance.hh"

namespace hsdm {

class FacetCells;
class MeshDistance;
class SurfaceWalk;

/// Every point against its nearest triangle, through the tree; parallel, quickest when neighbours in the list
/// are neighbours in space, the same bits for any thread count. Zero for an empty list.
Distance points_to_mesh(std::span<const Vec3> points, const MeshDistance& mesh,
                        double beyond = std::numeric_limits<double>::infinity());

/// The same one by one, squared: what summary_of() makes of them are the same bits. O(points log triangles),
/// parallel.
std::vector<double> squared_distances(std::span<const Vec3> points, const MeshDistance& mesh);

/// What there is to know of many squared distances, in the order of the points. O(n), parallel.
Distance summary_of(std::span<const double> squared, double beyond = std::numeric_limits<double>::infinity());

/// The same of distances that come part by part: the same bits as if they came at once.
class DistanceSums {
public:
    explicit DistanceSums(double beyond = std::numeric_limits<double>::infinity()) : beyond_(beyond) {}
    void add(std::span<const double> squared);
    Distance result() const;
    std::size_t count() const { return count_; } ///< so far

private:
    struct Sums {
        double max = -1, sum = 0, squares = 0;
    };
    static void join(const Sums& sums, Sums& total);

    double beyond_;
    Sums chunk_, total_;
    Distance found_; // farthest and beyond
    std::size_t count_ = 0;
};

/// Every point against its nearest triangle by walks and searches, parallel, the same bits for any thread
/// count: for points that lie close to the surface.
Distance points_to_surface(std::span<const Vec3> points, const SurfaceWalk& surface,
                           const DistanceOptions& options = {});

/// Every point against its nearest triangle, by the cells of the mesh: in half the time if facets are about
/// as large as cells and the points of a cell follow each other in the list, as for a mesh of a uniform
/// octree level and its voxels; by the tree if the cells are not usable. Distances may differ from those of
/// the tree by rounding.
Distance points_to_mesh_by_cells(std::span<const Vec3> points, const PolygonMesh& mesh,
                                 const FacetCells& cells,
                                 double beyond = std::numeric_limits<double>::infinity());
/// The same one by one, squared.
std::vector<double> squared_distances_by_cells(std::span<const Vec3> points, const PolygonMesh& mesh,
                                               const FacetCells& cells);

} // namespace hsdm
