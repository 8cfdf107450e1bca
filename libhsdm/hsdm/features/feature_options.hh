#pragma once
// Options and results of phase 3 (section 3.3).

#include <cstddef>

namespace hsdm {

struct FeatureOptions {
    /// Radians, in (0, pi): an edge is sharp if the normals of its two facets differ by more. 35 degrees.
    double crease_angle = 0.61;
    /// Radians, in (0, pi): a vertex where two sharp edges meet is a corner if the line they form turns by
    /// more. 60 degrees.
    double corner_angle = 1.05;
    /// Rounds of normal smoothing, >= 0, that the angle at a sharp edge has to outlast: departs from the
    /// paper's plain dihedral test (0 rounds), which takes a scan's noise for creases (docs/features.md).
    int confirmation_rounds = 3;
    /// False leaves the vertices' normals to the smoother that comes next.
    bool write_normals = true;
};

/// What the classifier found on the mesh (deleted elements and isolated vertices are not counted).
struct FeatureCounts {
    std::size_t sharp_edges = 0;
    std::size_t smooth_vertices = 0;
    std::size_t edge_vertices = 0;
    std::size_t corner_vertices = 0;
    bool operator==(const FeatureCounts&) const = default;
};

struct NormalSmoothingOptions {
    /// Radians, in (0, pi): neighbours whose normals differ by this count for 0.61 of one that agrees, by
    /// twice this for 0.14. Larger is smoother, smaller keeps blunt creases better. 20 degrees.
    double similarity_angle = 0.35;
    /// Radians, > 0: a facet normal that turns by less in a round counts as settled.
    double settled_angle = 1e-3;
    /// Rounds the free function smooth_normals does, >= 0; the class takes them as an argument.
    int rounds = 3;
};

/// Throw OptionError naming the option, its value and its range.
void validate(const FeatureOptions& options);
void validate(const NormalSmoothingOptions& options);

namespace detail {

/// Measured on folds of 36 to 90 degrees, noise up to a fifth of the edge length: so smoothed, noise loses
/// nearly all of its angle, and a crease just above the limit keeps more than this share of it.
inline constexpr double confirming_similarity = 0.57; ///< similarity angle over crease angle
inline constexpr double confirmed_share = 0.6;        ///< of the crease angle

} // namespace detail

} // namespace hsdm
