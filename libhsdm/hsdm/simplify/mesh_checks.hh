#pragma once
// What may be wrong with a coarse mesh, looked for in one after the other.

#include "hsdm/simplify/distance_check.hh"
#include "hsdm/simplify/intersection_check.hh"
#include "hsdm/simplify/tolerance_envelope.hh"

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
class MeshChecks {
public:
    /// As for DistanceCheck; `tolerance`, the mesh's units, > 0: the width of the band round the fine mesh.
    MeshChecks(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points, double bound,
               double spacing, double tolerance);
    MeshChecks(const MeshChecks&) = delete;

    Findings look_at(const PolygonMesh& mesh);
    /// Without all else.
    FarPoints far_points(const PolygonMesh& mesh);

    /// Of the mesh last looked at.
    const DistanceCheck& bound() const { return bound_; }
    ToleranceEnvelope& band() { return band_; }

private:
    DistanceCheck bound_;
    IntersectionCheck crossing_;
    ToleranceEnvelope band_;
};

} // namespace hsdm
