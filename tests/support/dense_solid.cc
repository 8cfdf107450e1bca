#include "support/dense_solid.hh"

#include <algorithm>
#include <array>

namespace hsdm::support {
namespace {

constexpr std::size_t block = 8;

/// Of the simplices of a cell that have its lowest corner as their lowest: a simplex is a chain of corners,
/// each a proper subset of the next as sets of upper sides. Bit k of `inside`: corner k is inside.
int simplices_from_lowest(unsigned inside) {
    const auto in = [inside](unsigned corner) { return (inside >> corner & 1u) != 0; };
    const auto below = [](unsigned s, unsigned t) { return s != t && (s & t) == s; };
    if (!in(0)) return 0;
    int sum = 1;
    for (unsigned s = 1; s < 8; ++s) {
        if (!in(s)) continue;
        --sum;
        for (unsigned t = 1; t < 8; ++t) {
            if (!below(s, t) || !in(t)) continue;
            ++sum;
            for (unsigned u = 1; u < 8; ++u) sum -= below(t, u) && in(u);
        }
    }
    return sum;
}

std::array<std::int8_t, 256> simplex_table() {
    std::array<std::int8_t, 256> table{};
    for (unsigned inside = 0; inside < 256; ++inside)
        table[inside] = static_cast<std::int8_t>(simplices_from_lowest(inside));
    return table;
}

Vec3 normal_near(const Solid& solid, const Vec3& p, double step) {
    Vec3 gradient;
    for (unsigned k = 0; k < 3; ++k) {
        Vec3 d(0, 0, 0);
        d[k] = step;
        gradient[k] = solid.distance(p + d) - solid.distance(p - d);
    }
    const double length = gradient.norm();
    return length > 0 ? gradient / length : gradient;
}

/// Along a ray that starts on the surface into the side where `side` times the distance is positive.
double facing_distance(const Solid& solid, const Vec3& start, const Vec3& normal, double side, double limit,
                       double cos_facing) {
    const double least_step = 0.01 * limit;
    for (double t = least_step; t < limit;) {
        const Vec3 p = start + normal * (side * t);
        const double free = side * solid.distance(p);
        if (free <= 0) return (normal_near(solid, p, 1e-3 * least_step) | normal) < -cos_facing ? t : limit;
        t += std::max(free, least_step);
    }
    return limit;
}

} // namespace

DenseSolid::DenseSolid(const Solid& solid, const Box& bounds, double step) : step_(step) {
    for (unsigned k = 0; k < 3; ++k)
        size_[k] = block * (1 + static_cast<std::size_t>(bounds.size()[k] / step) / block);
    inside_.assign(size_[0] * size_[1] * size_[2], 0);
    const auto position = [&](double x, double y, double z) { return bounds.lo + Vec3(x, y, z) * step; };
    constexpr double half = (block - 1) / 2.0;
    const double radius = half * std::sqrt(3.0) * step;
    for (std::size_t z = 0; z < size_[2]; z += block)
        for (std::size_t y = 0; y < size_[1]; y += block)
            for (std::size_t x = 0; x < size_[0]; x += block) {
                const auto fx = static_cast<double>(x), fy = static_cast<double>(y),
                           fz = static_cast<double>(z);
                const double middle = solid.distance(position(fx + half, fy + half, fz + half));
                if (middle > radius) continue;
                for (std::size_t k = 0; k < block; ++k)
                    for (std::size_t j = 0; j < block; ++j)
                        for (std::size_t i = 0; i < block; ++i)
                            inside_[at(x + i, y + j, z + k)] =
                                middle < -radius
                                || solid.contains(position(fx + static_cast<double>(i),
                                                           fy + static_cast<double>(j),
                                                           fz + static_cast<double>(k)));
            }
}

long DenseSolid::surface_euler() const {
    static const std::array<std::int8_t, 256> table = simplex_table();
    long sum = 0;
    for (std::size_t z = 0; z + 1 < size_[2]; ++z)
        for (std::size_t y = 0; y + 1 < size_[1]; ++y)
            for (std::size_t x = 0; x + 1 < size_[0]; ++x) {
                const std::size_t p = at(x, y, z);
                if (!inside_[p]) continue;
                unsigned mask = 0;
                for (unsigned k = 0; k < 8; ++k)
                    mask |= unsigned{inside_[at(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2))]} << k;
                sum += table[mask];
            }
    return 2 * sum;
}

bool DenseSolid::on_surface(std::size_t point) const {
    const std::array<std::size_t, 3> strides{1, size_[0], size_[0] * size_[1]};
    return std::any_of(strides.begin(), strides.end(), [&](std::size_t stride) {
        return (point >= stride && inside_[point - stride] != inside_[point])
               || (point + stride < inside_.size() && inside_[point + stride] != inside_[point]);
    });
}

DenseSolid DenseSolid::grown(double reach) const {
    // The points that spread: those of the solid, or of its outside, at the surface.
    const std::uint8_t spreading = reach >= 0;
    const double radius = std::abs(reach) / step_;
    const auto r = static_cast<long>(radius);
    std::vector<std::array<long, 3>> ball;
    for (long z = -r; z <= r; ++z)
        for (long y = -r; y <= r; ++y)
            for (long x = -r; x <= r; ++x)
                if (static_cast<double>(x * x + y * y + z * z) <= radius * radius) ball.push_back({x, y, z});
    DenseSolid result = *this;
    for (std::size_t z = 0; z < size_[2]; ++z)
        for (std::size_t y = 0; y < size_[1]; ++y)
            for (std::size_t x = 0; x < size_[0]; ++x) {
                if (inside_[at(x, y, z)] != spreading || !on_surface(at(x, y, z))) continue;
                for (const auto& d : ball) {
                    const std::array<std::size_t, 3> q{x + static_cast<std::size_t>(d[0]),
                                                       y + static_cast<std::size_t>(d[1]),
                                                       z + static_cast<std::size_t>(d[2])};
                    if (q[0] < size_[0] && q[1] < size_[1] && q[2] < size_[2])
                        result.inside_[at(q[0], q[1], q[2])] = spreading;
                }
            }
    return result;
}

std::size_t DenseSolid::inside_count() const {
    return static_cast<std::size_t>(std::count(inside_.begin(), inside_.end(), 1));
}

double least_facing_distance(const Solid& solid, const PointCloud& surface, double limit, double angle) {
    double least = limit;
    for (std::size_t i = 0; i < surface.size(); ++i)
        for (double side : {-1.0, 1.0})
            least = std::min(least, facing_distance(solid, surface.positions[i], surface.normals[i], side,
                                                    limit, std::cos(angle)));
    return least;
}

} // namespace hsdm::support
