#include "hsdm/contour/set_relation.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/check_option.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
RelationTest::RelationTest(const RelationOptions& options, double voxel_size)
    : cos_smooth_(std::cos(options.smooth_angle)),
      gap_(options.smooth_gap * voxel_size),
      least_gap_(gap_ * std::sqrt(2 + 2 * cos_smooth_) * (1 - 1e-9)),
      crease_gap_(options.crease_gap * voxel_size),
      voxel_size_(voxel_size) {
    check_option(options.smooth_angle > 0 && options.smooth_angle < 1.5707963, "smooth_angle",
                 options.smooth_angle, "lie in (0, pi/2)");
    if (!(options.smooth_gap > 0 && options.crease_gap > 0))
        throw OptionError("smooth_gap and crease_gap must be positive");
}

Relation RelationTest::operator()(const NormalSet& a, const NormalSet& b) const {
    const Relation relation = by_planes(a, b);
    return relation != Relation::none && apart(a, b) ? Relation::none : relation;
}

Relation RelationTest::by_planes(const NormalSet& a, const NormalSet& b) const {
    const double cosine = a.normal | b.normal;
    if (cosine < cos_smooth_) return crease(a, b, cosine);
    return one_sheet(a, b) ? Relation::smooth : Relation::none;
}

Relation RelationTest::crease(const NormalSet& a, const NormalSet& b, double cosine) const {
    const double sine_squared = 1 - cosine * cosine;
    if (sine_squared < relations::least_sine_squared) return Relation::none;
    const Vec3 chord = b.centroid - a.centroid;
    const double b_above_a = a.normal | chord;
    const double a_above_b = -(b.normal | chord);
    const bool convex = b_above_a + a_above_b < 0;
    return ends_at(a, b.normal, a_above_b, convex, cosine) && ends_at(b, a.normal, b_above_a, convex, cosine)
               ? (convex ? Relation::convex : Relation::concave)
               : Relation::none;
}

/// Do the points of a set end at the other set's plane, which its centroid lies `above` (signed)? Evenly
/// spread points reach sqrt(3) standard deviations from the centroid; few points reach less far, by about
/// their spacing.
bool RelationTest::ends_at(const NormalSet& set, const Vec3& plane, double above, bool convex,
                           double cosine) const {
    const double short_of = convex ? -above : above;
    const double reach = std::sqrt(set.spread.reach_squared(plane));
    const double sine = std::sqrt(1 - cosine * cosine);
    const double spacing = 0.5 * voxel_size_ / std::sqrt(static_cast<double>(set.count));
    return short_of - reach < (crease_gap_ + spacing) * sine
           && reach - short_of < relations::smooth_gap * voxel_size_;
}

} // namespace hsdm
