#pragma once
// What may be wrong with a coarse mesh, looked for in one after the other.

#include "hsdm/simplify/bound_check.hh"
#include "hsdm/simplify/crossing_check.hh"
#include "hsdm/simplify/surface_band.hh"

namespace hsdm {

struct FaultCounts {
    std::size_t crossing = 0; ///< pairs of facets that intersect
    std::size_t distant =
        0; ///< places on the mesh beyond the bound, vertices of the fine one beyond twice that
    std::size_t points = 0; ///< points beyond it
};

struct Findings {
    std::vector<std::array<Index, 2>> crossing; ///< pairs of facets that intersect
    FarPlaces far;
    FarPoints far_points;

    FaultCounts count() const { return {crossing.size(), far.size(), far_points.points.size()}; }
};

/// All that is remembered of one mesh for the next.
class RoundChecks {
public:
    /// As for BoundCheck; `tolerance`, the mesh's units, > 0: the width of the band round the fine mesh.
    RoundChecks(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points, double bound,
                double spacing, double tolerance);
    RoundChecks(const RoundChecks&) = delete;

    Findings look_at(const PolygonMesh& mesh);
    /// Without all else.
    FarPoints far_points(const PolygonMesh& mesh);

    /// Of the mesh last looked at.
    const BoundCheck& bound() const { return bound_; }
    SurfaceBand& band() { return band_; }

private:
    BoundCheck bound_;
    CrossingCheck crossing_;
    SurfaceBand band_;
};

} // namespace hsdm
