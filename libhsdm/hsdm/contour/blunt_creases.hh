#pragma once
// Section 3.4.2: creases too blunt for their two faces to be two sheets (angles::one_sheet). See
// docs/sheets.md.

#include "hsdm/contour/normal_sets.hh"

#include <span>

namespace hsdm {

/// A point, a plane or a set of points, as evidence of a crease.
struct CreaseSample {
    Vec3 position, normal; ///< normal of unit length
    double weight = 1;
    double turn = 0;                ///< of a set: NormalSet::turn
    const Spread* spread = nullptr; ///< of a set, or none
};

inline CreaseSample crease_sample(const NormalSet& set) {
    return {set.centroid, set.normal, static_cast<double>(set.count), set.turn, &set.spread};
}

/// May there be a crease, from the weighted sum of unit normals? Saves time: of two faces with
/// bluntest_cosine between them, one a fifth of both, the sum is so long. A smaller part of so blunt an edge
/// is left out.
inline bool is_bent(const Vec3& sum, double weight) {
    return sum.norm() < 0.9965 * weight;
}

struct BluntCrease {
    std::array<Vec3, 2> normals; ///< unit mean normals of the two faces
    bool is_convex = false;
};

/// Do normals turn less along a face than halfway to how they would on a round surface? `turn` is its
/// NormalSet::turn; `extent` the variance of its points and `way` the way from one face to the other, both
/// along the difference of the two normals, not of unit length.
inline bool is_nearer_to_flat(double turn, double extent, double way) {
    return turn * way <= 0.5 * extent;
}

/// Do samples of one sheet lie on two faces that meet in a crease? Their normals fall into two groups with
/// little scatter, each group lies on its own side of the line where the two planes meet, and normals turn
/// from one face to the other by more than they turn along the faces: on a round surface they turn alike
/// everywhere. Writes the face of each sample, 0 or 1, to `face`; each face must weigh `least_weight`. The
/// sizes of the two spans agree. O(samples).
bool find_blunt_crease(std::span<const CreaseSample> samples, double least_weight,
                       std::span<std::uint8_t> face, BluntCrease& crease);

} // namespace hsdm
