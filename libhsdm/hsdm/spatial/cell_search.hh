#pragma once
// Nearest facets through the lists of cells.

#include "hsdm/core/vector_pair.hh"
#include "hsdm/mesh/triangulate.hh"
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
    /// Two triangles as a corner, the unit normal and, in the plane, unit vectors out over the sides that
    /// begin at the corner (0, 1) and the one across (2), which lies `across` farther out.
    struct Bounds {
        VectorPair corner, normal;
        std::array<VectorPair, 3> out;
        Double2 across;
        std::array<Index, 2> triangle;
    };
    struct Slice {
        bool loaded = false;
        std::size_t begin = 0, end = 0; // of bounds_
    };
    static constexpr std::size_t centre = 13; // of 3 x 3 x 3

    void enter(const VoxelCoord& cell);
    double nearest_in(std::size_t slot, const VectorPair& point, double squared);
    double exactly(const Bounds& bounds, const VectorPair& point) const;
    void load(std::size_t slot);
    void prepare(Bounds& bounds) const;

    const PolygonMesh& mesh_;
    const Triangulation& cut_;
    const FacetCells& cells_;
    VoxelCoord cell_{-1, -1, -1};
    std::span<const Index> facets_; // of the cell
    std::array<Slice, 27> around_;  // the cell and, as far as needed, those beside it
    std::vector<Bounds> bounds_;
    std::vector<Double2> low_; // per pair, no more than the squares of distances
};

} // namespace hsdm
