#pragma once
// Section 3.4.2 as a whole: sets -> local sheets -> crossings -> pairs -> dual vertices -> facets.

#include "hsdm/contour/components_of_part.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/contour/handles.hh"
#include "hsdm/contour/relax_vertices.hh"
#include "hsdm/contour/tangles_of_part.hh"
#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/small_components.hh"

#include <optional>

namespace hsdm {

/// At two stages.
using LargestOfWhole = std::array<std::size_t, 2>;

struct DualContourOptions {
    RelationOptions relation;
    CrossingOptions crossing;
    RelaxOptions relax;
    /// The lengths in these three are in voxels here.
    SplinterOptions splinters{.flat = splinters::flat};
    FillHolesOptions holes{.max_edges = holes::most_edges, .max_diameter = holes::widest};
    UntangleOptions untangle{.reach = placement::farthest_out, .nearby = 2 * placement::farthest_out};
    bool fill = true; ///< close small boundary loops
    /// voxels: not wider ones than that in whose middle points lack (middle_of_hole)
    double widest_free = std::numeric_limits<double>::infinity();
    bool better_quads = true; ///< collapse_flat_corners, cut_doubtful_quads, recut_odd_facets
    /// the data go round the whole solid: it has no border (label_grid_signs, trim_unsupported)
    bool all_round = false;
    PartVoxels part{};    ///< where the level is part of a larger one
    TanglePlan tangles{}; ///< the same: what is done about intersections
    /// The same: facets of the largest component, at most SplinterOptions::enough(), when splinters are
    /// looked for the first time and the second.
    LargestOfWhole largest{};
};

struct DualContour {
    PolygonMesh mesh;                  ///< relative to the octree's origin; an oriented 2-manifold
    std::vector<VertexClass> classes;  ///< per vertex
    std::vector<Index> voxel;          ///< per vertex, the occupied voxel it stands for
    std::size_t grid_points_moved = 0; ///< to the lines of bars and bores (move_to_bar_lines)
    std::size_t beyond_crease = 0;     ///< crossings clipped where another sheet crosses theirs
    std::size_t settled = 0;           ///< crossings dropped, restored or added so that signs agree
    std::size_t trimmed = 0;           ///< crossings dropped beyond the end of the data
    std::size_t tips = 0;              ///< pairs of crossings dropped
    std::size_t webs_opened = 0;       ///< rows of links that changed partners (open_webs)
    std::size_t handles_cut = 0;       ///< rings of edges that no points speak for (cut_handles)
    std::size_t clamped = 0;           ///< vertices kept in their voxels
    std::size_t drawn_in = 0;          ///< vertices that stood far out from all points (draw_in_spikes)
    std::size_t reached = 0;           ///< moves of vertices to points that stood out (reach_points)
    /// vertices merged into the vertex of the next voxel, which holds their corner (shared_corners)
    std::size_t corners_merged = 0;
    std::size_t flat_corners = 0; ///< vertices merged into others on creases (collapse_flat_corners)
    std::size_t straight = 0;     ///< vertices of two facets taken out of them (drop_straight_vertices)
    std::size_t quads_cut = 0;    ///< quads cut at a straight corner (cut_doubtful_quads)
    std::size_t facets_recut = 0; ///< facets replaced by quads over the same vertices (recut_odd_facets)
    std::size_t midpoints = 0;    ///< vertices added so that no two mesh edges join the same two vertices
    std::size_t doublets = 0;     ///< pairs of facets round one vertex merged into one facet
    Occurrences splinters;        ///< facets of splinters, removed
    FillHolesCounts holes;
    Occurrences wide_holes; ///< of those that were closed, wider than the sampling leaves; none of a part
    UntangleCounts intersections;
    std::optional<FacetCells> cells; ///< the mesh's facets by voxel; empty if untangling moved vertices
    std::optional<FacetLinks> links; ///< the mesh's; empty if facets changed after they were found
    ManifoldCounts manifold;         ///< what make_manifold still had to mend at the end
    std::array<PartComponents, 2> components; ///< with DualContourOptions::part
    TangleCounts tangles;                     ///< in the place of `intersections`
    bool looked_far = false; ///< of a part: as in HandleCounts, or a hole to be closed is known in part
    double misfit_placed = 0, misfit_moved = 0; ///< with RelaxOptions::part_of_whole: see there
};

/// Facets from the normal sets of one level (docs/sheets.md): an oriented 2-manifold, possibly with a border.
/// O(sets), parallel. Throws OptionError.
DualContour dual_contour(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                         const DualContourOptions& options = {});

} // namespace hsdm
