#pragma once
// Section 3.4.2, "the connection should satisfy normal consistency": how two sets near each other are
// related.

#include "hsdm/contour/normal_sets.hh"

#include <algorithm>

namespace hsdm {

enum class Relation : std::uint8_t {
    none,    ///< different surfaces, e.g. the two sides of a plate
    smooth,  ///< one sheet
    convex,  ///< two sheets that meet in a crease, each centroid below the other's plane
    concave, ///< the same, each above
};

struct RelationOptions {
    /// radians, (0, pi/2): normals closer than this belong to one sheet (40 degrees)
    double smooth_angle = relations::smooth_angle;
    /// voxels: how far two sets of one sheet may lie apart along their mean normal
    double smooth_gap = relations::smooth_gap;
    /// voxels: how far from the points of both sets the planes of a crease may meet
    double crease_gap = relations::crease_gap;
};

/// The relation of two sets of the same or of adjacent voxels. Symmetric. Smooth: a small angle between the
/// normals, and a chord between the centroids perpendicular to the sum of the normals, as on any circular
/// arc, so that curvature is no gap. Crease: a larger angle, and planes that meet close to where the points
/// of both sets end.
class RelationTest {
public:
    /// Throws OptionError.
    RelationTest(const RelationOptions& options, double voxel_size);
    /// The same for sets that must outlive it, whose patches were separated: sets apart have no relation.
    RelationTest(const RelationOptions& options, double voxel_size, const NormalSets& sets)
        : RelationTest(options, voxel_size) {
        if (!sets.first_apart.empty()) sets_ = &sets;
    }
    Relation operator()(const NormalSet& a, const NormalSet& b) const;
    /// Is that relation smooth? Costs less to ask.
    bool smooth(const NormalSet& a, const NormalSet& b) const { return one_sheet(a, b) && !apart(a, b); }
    /// Are they known to have a wall or gap between them?
    bool apart(const NormalSet& a, const NormalSet& b) const {
        if (sets_ == nullptr) return false;
        const NormalSet* const sets = sets_->sets.data();
        const auto* const first = sets_->first_apart.data() + (&a - sets);
        const auto* const others = sets_->apart.data();
        return first[0] != first[1]
               && std::binary_search(others + first[0], others + first[1], static_cast<Index>(&b - sets));
    }

    /// Cosine of the angle that normals of one sheet may make.
    double cos_smooth() const { return cos_smooth_; }

private:
    /// By their planes alone.
    bool one_sheet(const NormalSet& a, const NormalSet& b) const {
        if ((a.normal | b.normal) < cos_smooth_) return false;
        const Vec3 sum = a.normal + b.normal;
        const double gap = std::abs(sum | (b.centroid - a.centroid));
        return gap < least_gap_ || gap < gap_ * sum.norm();
    }
    Relation by_planes(const NormalSet& a, const NormalSet& b) const;
    Relation crease(const NormalSet& a, const NormalSet& b, double cosine) const;
    bool ends_at(const NormalSet& set, const Vec3& plane, double above, bool convex, double cosine) const;

    double cos_smooth_, gap_;
    double least_gap_; // gap_ times the least length of the sum of two normals of one sheet
    double crease_gap_, voxel_size_;
    const NormalSets* sets_ = nullptr;
};

} // namespace hsdm
