#include "support/scanner.hh"

#include "support/random.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hsdm::support {
namespace {

/// How far along the ray the solid begins; infinity where it passes. Sphere tracing: distances of solids are
/// never more than the true ones.
double depth_along(const Solid& solid, const Vec3& from, const Vec3& way, double begin, double end) {
    double t = begin;
    for (int step = 0; step < 1000 && t < end; ++step) {
        const double d = solid.distance(from + way * t);
        if (d < 1e-7) return t;
        t += d;
    }
    return Box::inf;
}

Vec3 normal_at(const Solid& solid, const Vec3& p) {
    Vec3 slope;
    for (unsigned k = 0; k < 3; ++k) {
        Vec3 step(0, 0, 0);
        step[k] = 1e-5;
        slope[k] = solid.distance(p + step) - solid.distance(p - step);
    }
    return slope.norm() > 0 ? slope.normalized() : Vec3(0, 0, 1);
}

/// A direction from a position into the cone that holds the ball of this radius about the origin.
Vec3 ray(const Vec3& from, double radius, Random& random) {
    const double least = std::sqrt(1 - std::min(1.0, radius * radius / from.sqrnorm()));
    const double cosine = random.uniform(least, 1), sine = std::sqrt(1 - cosine * cosine);
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    const Vec3 axis = -from.normalized();
    const Vec3 side = (axis % (std::abs(axis[2]) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0))).normalized();
    return axis * cosine + (side * std::cos(turn) + (axis % side) * std::sin(turn)) * sine;
}

} // namespace

PointCloud scan_from(const std::vector<Vec3>& places, const Solid& solid, double radius,
                     const ScannerOptions& options) {
    Random random(options.seed);
    std::array<Vec3, 2> blind;
    for (Vec3& centre : blind) {
        SurfacePoint point{};
        while (!solid.sample(random, point)) continue;
        centre = point.position;
    }
    PointCloud cloud;
    cloud.sensors = places;
    for (std::size_t position = 0; position < places.size(); ++position) {
        const Vec3& from = places[position];
        const double distance = from.norm();
        const Vec3 shift = random.gauss3() * options.misalignment;
        for (std::size_t i = 0; i < options.points / places.size(); ++i) {
            const Vec3 way = ray(from, radius, random);
            const double depth =
                depth_along(solid, from, way, distance - 1.5 * radius, distance + 1.5 * radius);
            const double noise = random.gauss(), stray = random.uniform(), anywhere = random.uniform(-1, 1);
            if (depth == Box::inf) continue;
            const Vec3 hit = from + way * depth;
            if (std::ranges::any_of(blind, [&](const Vec3& b) { return (hit - b).norm() < options.holes; }))
                continue;
            const double slant = std::max(0.2, std::abs(normal_at(solid, hit) | way));
            const double off = stray < options.outliers ? anywhere * radius : noise * options.noise / slant;
            cloud.positions.push_back(hit + way * off + shift);
            cloud.sensor_of.push_back(static_cast<std::int32_t>(position));
        }
    }
    return cloud;
}

PointCloud scan_from_above(const Solid& solid, double radius, const ScannerOptions& options) {
    std::vector<Vec3> places;
    for (int position = 0; position < options.positions; ++position) {
        const double turn = 2 * std::numbers::pi * (position + 0.3) / options.positions;
        places.push_back(Vec3(std::cos(turn), std::sin(turn), 0.6).normalized() * (4 * radius));
    }
    return scan_from(places, solid, radius, options);
}

} // namespace hsdm::support
