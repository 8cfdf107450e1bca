#pragma once
// A rotation and a shift: where a solid stands.

#include "support/random.hh"

#include <array>

namespace hsdm::support {

/// world = rotation * local + shift; the rows of `rotation` are orthonormal, right-handed.
struct Pose {
    std::array<Vec3, 3> rotation{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    Vec3 shift{0, 0, 0};

    Vec3 rotate(const Vec3& v) const { return {rotation[0] | v, rotation[1] | v, rotation[2] | v}; }
    Vec3 unrotate(const Vec3& v) const {
        return rotation[0] * v[0] + rotation[1] * v[1] + rotation[2] * v[2];
    }
    Vec3 to_world(const Vec3& local) const { return rotate(local) + shift; }
    Vec3 to_local(const Vec3& world) const { return unrotate(world - shift); }
};

/// The pose that places first by `inner`, then by `outer`.
Pose compose(const Pose& outer, const Pose& inner);

/// Turns by `angle` radians about `axis` (any length but zero), then shifts.
Pose turned(const Vec3& axis, double angle, const Vec3& shift = Vec3(0, 0, 0));

/// Even over all rotations; every coordinate of the shift in [-reach, reach].
Pose random_pose(Random& random, double reach = 0);
inline Pose random_pose(std::uint64_t seed) {
    Random random(seed);
    return random_pose(random);
}

} // namespace hsdm::support
