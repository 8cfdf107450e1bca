#pragma once
// Sums of squared distances to planes: where a vertex that stands for many lies, and how far off it is.

#include "hsdm/polygon_mesh.hh"

#include <algorithm>
#include <array>

namespace hsdm {

struct Plane {
    Vec3 normal{0, 0, 0}; ///< unit
    double offset = 0;

    double height(const Vec3& x) const { return (normal | x) - offset; }
};

/// sum w (n . x - d)^2 over planes, and the mean of some points to hold on to where the planes leave open.
/// Planes that many facets share count once each, however many facets those are: four of them, and what there
/// is beyond these by its facets' weight like any other.
class Quadric {
public:
    static constexpr std::size_t most_shared = 4;

    void add_plane(const Vec3& normal, const Vec3& point, double weight);
    /// The plane is to outlive all sums that it is in. Its facets' weight tells what that of others comes to.
    void add_shared(const Plane& plane, double weight);
    void add_shared(Plane&&, double) = delete;
    void add_point(const Vec3& point);
    Quadric& operator+=(const Quadric& other);

    /// Where the sum is least, the least change from the mean of the points in directions that the planes do
    /// not determine (eigenvalues below a fiftieth of the largest: normals spread by less fix no position;
    /// shared planes do from a degree between them on).
    Vec3 minimum() const;
    /// Root of the weighted mean of the squared distances at x, those of facets with shared planes counted as
    /// zero, or the distance from the farthest shared plane if that is larger; 0 without planes.
    double rms(const Vec3& x) const;

    /// While shared planes are farther than `tolerance` from where they meet best, lets go of one without
    /// which the others meet, the farthest from x of several such, down to two.
    void drop_shared(const Vec3& x, double tolerance);
    /// The normals of shared planes, if other facets count next to nothing: else none.
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
