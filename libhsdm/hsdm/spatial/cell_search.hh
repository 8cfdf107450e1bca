#pragma once
// Nearest facets through the lists of cells.

#include "hsdm/mesh/triangulate.hh"
#include "hsdm/spatial/eight_bounds.hh"
#include "hsdm/spatial/facet_cells.hh"

namespace hsdm {

/// Distances of points to the facets of a mesh; fastest if successive points lie in the same cell.
class CellSearch {
public:
    /// `cells` must be usable(); all three must outlive this.
    CellSearch(const PolygonMesh& mesh, const Triangulation& cut, const FacetCells& cells)
        : mesh_(mesh), cut_(cut), cells_(cells) {}

    /// Squared distance to the nearest facet, or infinity if it is farther than a cell.
    double squared_distance(const Vec3& point);

private:
    struct Eight {
        EightBounds bounds;
        std::array<Index, EightBounds::size> triangle;
    };
    struct Slice {
        bool loaded = false;
        std::size_t first = 0, triangles = 0; // from the first of an eight on; an even number
    };
    static constexpr std::size_t centre = 13; // of 3 x 3 x 3

    void enter(const VoxelCoord& cell);
    double nearest_in(std::size_t slot, const Vec3& point, double squared);
    double exactly(const Index* two_triangles, const Vec3& point) const;
    void load(std::size_t slot);

    const PolygonMesh& mesh_;
    const Triangulation& cut_;
    const FacetCells& cells_;
    const BoundLanes& lanes_ = bound_lanes().front();
    VoxelCoord cell_{-1, -1, -1};
    std::span<const Index> facets_; // of the cell
    std::array<Slice, 27> around_;  // the cell and, as far as needed, those beside it
    std::vector<Eight> eights_;     // of the slots that are loaded, and memory that is kept
    std::size_t eight_count_ = 0;
    std::vector<EightBounds::Row> beyond_; // of the slot that is looked at
};

} // namespace hsdm
