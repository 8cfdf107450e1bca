#pragma once
// Smoothing of positions that keeps creases, on flat arrays.

#include "hsdm/features/half_edges.hh"

#include <optional>

namespace hsdm {

struct VertexSmoothingOptions {
    /// >= 0: each filters the facets' normals and moves the vertices towards them. 3 for noise of a fifth of
    /// an edge; more round what is coarse.
    int rounds = 1;
    int normal_rounds = 5;   ///< >= 0: of filtering in each round
    int position_rounds = 5; ///< >= 0: of moving in each round
    /// Radians, in (0, pi): neighbours whose normals differ by this count for 0.61 of one that agrees, by
    /// twice this for 0.14. Larger is smoother, smaller keeps unmarked folds better. 20 degrees.
    double similarity_angle = 0.35;
    /// Radians, in (0, pi): a vertex where two sharp edges meet is a corner, and stays, if the line they form
    /// turns by more. 60 degrees.
    double corner_angle = 1.05;
    /// The mesh's units, > 0: no vertex moves farther; without it `max_drift_share` says how far.
    std::optional<double> max_drift = std::nullopt;
    /// Mean edges, > 0: the same as a share of their length.
    double max_drift_share = 0.25;
    /// Share of the volume, >= 0, by which that of a closed mesh may change. One with a boundary encloses
    /// none, but its boundary stays.
    double max_volume_change = 0.01;
    /// A mesh that does not pass through itself still does not in the end: facets that would are taken back
    /// to where they were. False saves the search for them.
    bool keep_apart = true;
};

struct VertexSmoothingResult {
    std::size_t moved = 0;  ///< vertices
    double drift_max = 0;   ///< the mesh's units: how far a vertex is from where it was
    double drift_mean = 0;  ///< of the vertices that moved
    double drift_bound = 0; ///< that no vertex could exceed
    /// Enclosed by a closed mesh; with a boundary that of the cone over it, from the centre of its box.
    double volume_before = 0, volume_after = 0;
    /// Facets that a step would have turned over, and whose vertices it therefore left; summed over steps.
    std::size_t refused = 0;
    std::size_t taken_back = 0;    ///< vertices put back in the end, of facets that met others
    bool volume_bound_met = false; ///< smoothing ended there
    bool operator==(const VertexSmoothingResult&) const = default;
};

/// Throws OptionError naming the option, its value and its range.
void validate(const VertexSmoothingOptions& options);

/// Moves the mesh's vertices until its facets face along their filtered normals (filter_normals). As in
/// bilateral normal filtering (Zheng, Fu, Au, Tai 2011) a step moves a vertex by the mean of the ways to the
/// planes, along filtered normals through the centroids, of its facets (Sun, Rosin, Martin, Langbein 2007);
/// departs in weighting them by area. On a crease, where sectors meet, the step meets the mean planes of
/// both. Corners (curve_roles) and boundary vertices stay. Filters never average across a sharp edge. A step
/// that would leave the volume's bound is made shorter, and the last one. In the end facets that meet
/// others go back to where they began, if none met before. O(corners) a round and a search for
/// self-intersections, parallel; the same bits for any number of threads.
VertexSmoothingResult smooth_positions(HalfEdges& mesh, const VertexSmoothingOptions& options);

} // namespace hsdm
