#include "support/pose.hh"

namespace hsdm::support {

Pose compose(const Pose& outer, const Pose& inner) {
    Pose result;
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned column = 0; column < 3; ++column) {
            double sum = 0;
            for (unsigned k = 0; k < 3; ++k) sum += outer.rotation[row][k] * inner.rotation[k][column];
            result.rotation[row][column] = sum;
        }
    result.shift = outer.to_world(inner.shift);
    return result;
}

Pose turned(const Vec3& axis, double angle, const Vec3& shift) {
    const Vec3 u = axis.normalized();
    const double c = std::cos(angle), s = std::sin(angle), t = 1 - c;
    Pose pose;
    pose.rotation = {
        Vec3(t * u[0] * u[0] + c, t * u[0] * u[1] - s * u[2], t * u[0] * u[2] + s * u[1]),
        Vec3(t * u[0] * u[1] + s * u[2], t * u[1] * u[1] + c, t * u[1] * u[2] - s * u[0]),
        Vec3(t * u[0] * u[2] - s * u[1], t * u[1] * u[2] + s * u[0], t * u[2] * u[2] + c),
    };
    pose.shift = shift;
    return pose;
}

Pose random_pose(Random& random, double reach) {
    // A unit quaternion from four normal deviates is even over the rotations.
    double q[4], norm = 0;
    do {
        norm = 0;
        for (double& x : q) {
            x = random.gauss();
            norm += x * x;
        }
    } while (norm < 1e-12);
    norm = std::sqrt(norm);
    const double w = std::clamp(q[0] / norm, -1.0, 1.0);
    const Vec3 axis = Vec3(q[1], q[2], q[3]);
    const Vec3 shift(random.uniform(-reach, reach), random.uniform(-reach, reach),
                     random.uniform(-reach, reach));
    if (axis.norm() == 0) return turned(Vec3(0, 0, 1), 0, shift);
    return turned(axis, 2 * std::acos(w), shift);
}

} // namespace hsdm::support
