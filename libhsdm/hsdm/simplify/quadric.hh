#pragma once
// Quadric error metrics: sums of squared distances to planes, for the position of a vertex that stands for
// many others and its error.

#include "hsdm/polygon_mesh.hh"

#include <algorithm>
#include <array>

namespace hsdm {

struct Plane {
    Vec3 normal{0, 0, 0}; ///< unit
    double offset = 0;

    double height(const Vec3& x) const { return (normal | x) - offset; }
};

/// sum w (n . x - d)^2 over planes, and the mean of some points that fixes directions the planes leave open.
/// Planes shared by many facets (those of patches) count once each, however many facets have them: up to four
/// of them; further ones are weighted by area like any other plane.
class Quadric {
public:
    static constexpr std::size_t most_shared = 4;

    void add_plane(const Vec3& normal, const Vec3& point, double weight);
    /// Adds a plane of a patch, which must outlive all sums that it is in. `weight`, of its facets, is what
    /// the weight of other planes is compared with.
    void add_shared(const Plane& plane, double weight);
    void add_shared(Plane&&, double) = delete;
    void add_point(const Vec3& point);
    Quadric& operator+=(const Quadric& other);

    /// The minimiser; in directions that the planes do not determine (eigenvalues below a fiftieth of the
    /// largest: normals that spread less fix no position; for shared planes a degree between them suffices)
    /// the mean of the points.
    Vec3 minimum() const;
    /// The error at x: the root of the weighted mean of the squared distances, in which facets with shared
    /// planes count as zero, or the distance from the farthest shared plane if that is larger; 0 without
    /// planes.
    double rms(const Vec3& x) const;

    /// While the shared planes miss the point where they meet best by more than `tolerance` and there are
    /// more than two, drops one without which the others meet; of several such, the farthest from x.
    void drop_shared(const Vec3& x, double tolerance);
    /// The normals of the shared planes if other facets have next to no weight, else none.
    std::span<const Vec3> shared_normals(std::array<Vec3, most_shared>& normals) const;
    bool has_shared() const { return shared_count_ > 0; }

private:
    std::span<const Plane* const> shared() const { return std::span(shared_).first(shared_count_); }
    bool is_all_shared() const;
    double missed_without(const Plane* left_out, const Vec3& x) const;

    double a_[6] = {0, 0, 0, 0, 0, 0}; // xx, xy, xz, yy, yz, zz
    Vec3 b_{0, 0, 0};
    double c_ = 0, weight_ = 0;
    Vec3 sum_{0, 0, 0};
    double points_ = 0;
    std::array<const Plane*, most_shared> shared_{};
    std::uint8_t shared_count_ = 0;
    double shared_weight_ = 0;
};

} // namespace hsdm
