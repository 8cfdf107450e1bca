#pragma once
// Phase 2 by the extended method, section 3.4.2: graph and facets from normal-consistent sets.

#include "hsdm/completion/complete_surface.hh"
#include "hsdm/contour/dual_contour.hh"
#include "hsdm/pipeline/method.hh"
#include "hsdm/polygon_mesh.hh"

#include <functional>

namespace hsdm {

inline constexpr const char* completed_property = "hsdm_completed"; ///< std::uint8_t, 1 where no point was

/// Facets relative to the octree's origin, an oriented 2-manifold with the vertices' properties. The octree
/// must have normals. Adds its seconds (graph, facets) and what each stage counted to the report. Fills in
/// those parts of `known` that it finds out. Throws Cancelled.
PolygonMesh extended_method(const MethodInput& input, Report& report, FacetKnowledge& known);

/// Which points are of a surface that is completed: those of both rounds are known to go all round a solid,
/// and after the second no hole is left open.
enum class CompletedRound : std::uint8_t { none, first, second };

/// What is to be known of the whole level to make part of it.
struct PartOfLevel {
    double spacing = 0;                              ///< of the points
    double typical_set = 0;                          ///< points in a normal set, the mean over points
    bool turned = false;                             ///< do the points' normals point into a closed solid?
    bool go_back = false;                            ///< as in RelaxOptions
    TanglePlan tangles{};                            ///< of the whole
    LargestOfWhole largest{};                        ///< as in DualContourOptions
    CompletedRound completed = CompletedRound::none; ///< of its points
    /// Does the part own this voxel, or does it lie near those that it owns?
    std::function<bool(MortonCode)> owns, is_near;
};

/// What must be added up over parts.
struct FacetCounts {
    std::size_t sets = 0;                       ///< of own voxels
    std::size_t middle = 0, tilted = 0;         ///< as in SheetFeatures, of edges of own facets
    double misfit_placed = 0, misfit_moved = 0; ///< as in DualContour, of own voxels
    TangleCounts tangles;                       ///< as in DualContour
    bool looked_far = false;                    ///< the same, of one part

    void operator+=(const FacetCounts& other);
};

/// Facets of part of a level and of what is around it, in the order of voxels.
struct PartFacets {
    PolygonMesh mesh; ///< as extended_method() makes it of the whole, but near the rim of what is known
    std::vector<Index> voxel; ///< per vertex
    FacetKnowledge known;     ///< hints: smooth ones for judge_normals()
    FacetCounts counts;
    std::array<PartComponents, 2> components; ///< as in DualContour
};

/// The local part of extended_method(): all but points that are added. `input`:
/// the points of the part and of what is around it. Throws Cancelled.
PartFacets facets_of_part(const MethodInput& input, const PartOfLevel& part);

/// What closes slits of facets.
struct SlitCompletion {
    BoundaryLoops loops;    ///< none: there are no slits
    CompletedPoints points; ///< relative to the octree's origin
};

/// How far facets are from what they should be.
struct FacetFaults {
    std::size_t meeting; ///< pairs
    std::size_t border;  ///< edges of their loops
};
/// Are facets with slits closed worth it: no worse, and less open?
inline bool are_better(const FacetFaults& closed, const FacetFaults& before) {
    return closed.meeting <= before.meeting && closed.border < before.border;
}

/// How a completion of all loops went, whose border is what its first round left.
struct CompletionCheck {
    FacetFaults before;
    bool sees_space; ///< is it known what scanners looked through?

    /// Did it tear the mesh? A surface through the mesh does, and what closes the tears does not meet it
    /// where it keeps out of free space.
    bool tore(const FacetFaults& completed) const { return sees_space && completed.border >= before.border; }
    /// Is it to be done again, with a surface that keeps beside the mesh?
    bool is_doubtful(const FacetFaults& completed) const {
        return tore(completed) || completed.meeting > before.meeting;
    }
    /// Is that one the better?
    bool is_better(const FacetFaults& beside, const FacetFaults& completed) const {
        return beside.meeting < completed.meeting
               || (tore(completed) && beside.meeting == completed.meeting
                   && beside.border < completed.border);
    }
};

/// Cavities of a completed solid that the measured one did not have were seen through its holes, and go.
/// Nothing else of the facets changes but what is known of them.
void drop_cavities(const MethodInput& input, PolygonMesh& facets, FacetKnowledge& known, Report& report);

/// Of facets in the order of voxels, as facets_of_part() has them, and their loops.
SlitCompletion slit_completion(const MethodInput& input, double spacing, const PolygonMesh& facets,
                               const BoundaryLoops& loops);

/// Do these facets of a closed solid face inward?
bool faces_inward(const PolygonMesh& facets);

} // namespace hsdm
