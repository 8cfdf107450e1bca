#pragma once
// A uniform grid whose cells list the facets that may reach into them; for meshes whose facets are about as
// large as the cells.

#include "hsdm/core/morton_index.hh"
#include "hsdm/core/radix_sort.hh"
#include "hsdm/polygon_mesh.hh"

#include <array>

namespace hsdm {

/// All cells between two corner cells, both included.
struct CellRange {
    VoxelCoord lo, hi;

    double count() const {
        double n = 1;
        for (std::size_t k = 0; k < 3; ++k) n *= std::max(0.0, hi[k] - lo[k] + 1.0);
        return n;
    }
    template <class F>
    void for_each(F&& visit) const {
        for (VoxelCoord c = lo; c[2] <= hi[2]; ++c[2])
            for (c[1] = lo[1]; c[1] <= hi[1]; ++c[1])
                for (c[0] = lo[0]; c[0] <= hi[0]; ++c[0]) visit(c);
    }
};

/// Every facet is listed in all cells that its box touches, so what lies in a cell belongs to the facets
/// listed there. Facets of a uniform octree level span the voxels of their vertices: where cells are those
/// voxels, nearly every list is the fan round one vertex.
class FacetCells {
public:
    /// Builds cells of edge `size` > 0, in the mesh's units, aligned to the origin. O(entries), parallel; the
    /// same for any number of threads. The mesh need not outlive it.
    FacetCells(const PolygonMesh& mesh, double size);

    /// False if there are too many cells per facet or facets per cell for the lists to be of use, or no facet
    /// at all: then the lists must not be used.
    bool usable() const { return usable_; }
    std::size_t size() const { return first_.size() - 1; }
    /// The facets listed in a cell, ascending.
    std::span<const Index> facets(Index cell) const {
        return {facet_.data() + first_[cell], facet_.data() + first_[cell + 1]};
    }
    /// The cell at these coordinates, or no_index if no facet touches it. O(1).
    Index find(const VoxelCoord& c) const;

    /// A position in cells from the least corner of the grid, off by no more than `rounding`; what lies
    /// outside is moved to the outermost cells, which no facet touches.
    using Place = std::array<double, 3>;
    static constexpr double rounding = 1e-8;
    Place place(const Vec3& p) const {
        Place place;
        for (unsigned k = 0; k < 3; ++k)
            place[k] = std::max(0.0, std::min((p[k] - origin_[k]) * per_size_, last_[k]));
        return place;
    }
    static VoxelCoord cell_of(const Place& p) {
        return {static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]),
                static_cast<std::int32_t>(p[2])};
    }
    double cell_size() const { return size_; }

    /// To be called when facets got other numbers: what was facet f is now now[f].
    void renumber(std::span<const Index> now);

private:
    bool fit(const Box& box);
    std::vector<std::size_t> list_ranges(const PolygonMesh& mesh, std::vector<CellRange>& ranges) const;
    void group(const std::vector<CodeIndex>& entries);

    double size_, per_size_;
    Vec3 origin_{0, 0, 0};
    Place last_{}; // the outermost cell along each axis
    bool usable_ = false;
    std::vector<Index> first_{0}, facet_;
    MortonIndex index_;
};

} // namespace hsdm
