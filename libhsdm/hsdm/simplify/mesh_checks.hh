#pragma once
// Finds the faults of one coarse mesh after the other.

#include "hsdm/simplify/distance_check.hh"
#include "hsdm/simplify/intersection_check.hh"
#include "hsdm/simplify/tolerance_envelope.hh"

namespace hsdm {

struct FaultCounts {
    std::size_t intersecting = 0; ///< pairs of facets that intersect
    /// places on the mesh beyond the bound, and fine vertices beyond twice the bound
    std::size_t distant = 0;
    std::size_t points = 0; ///< points that the mesh is to blame for (FarPoints)
};

struct Findings {
    std::vector<std::array<Index, 2>> intersecting; ///< pairs of facets that intersect
    FarPlaces far;
    FarPoints far_points;

    bool is_empty() const { return intersecting.empty() && far.size() == 0 && far_points.points.empty(); }
    FaultCounts count() const { return {intersecting.size(), far.size(), far_points.points.size()}; }
};

/// All checks, with what each remembers of one mesh for the next.
class MeshChecks {
public:
    /// Arguments as for DistanceCheck; `tolerance`, the mesh's units, > 0: that of the envelope round the
    /// fine mesh. The `origin` of meshes looked at is a vertex of the fine mesh (find_unchanged).
    MeshChecks(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points, double bound,
               double spacing, double tolerance);
    MeshChecks(const MeshChecks&) = delete;

    Findings look_at(const PolygonMesh& mesh);
    /// Runs only the check of the points, as the last of all checks.
    FarPoints far_points(const PolygonMesh& mesh);

    /// The distance check, as of the mesh last looked at.
    const DistanceCheck& distances() const { return distances_; }
    const ToleranceEnvelope& envelope() const { return envelope_; }

private:
    Unchanged compare_with_last(const PolygonMesh& mesh);

    PolygonMesh last_; // the mesh last looked at
    DistanceCheck distances_;
    IntersectionCheck intersections_;
    ToleranceEnvelope envelope_;
};

} // namespace hsdm
