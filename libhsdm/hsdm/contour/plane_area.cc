#include "hsdm/contour/plane_area.hh"

#include <array>
#include <cmath>

namespace hsdm {
namespace {

/// A convex polygon on the stack: a square clipped by six faces and a few partners has at most 4 + 6 + 20
/// corners.
struct Polygon {
    static constexpr std::size_t most = 32;
    std::array<Vec3, most> corners;
    std::size_t size = 0;

    void add(const Vec3& p) {
        if (size < most) corners[size++] = p;
    }
};

/// Sets `result` to the part of a polygon at heights of at most 0.
template <class Height>
void clip(const Polygon& polygon, const Height& height, Polygon& result) {
    result.size = 0;
    if (polygon.size == 0) return;
    double da = height(polygon.corners[0]);
    for (std::size_t i = 0; i < polygon.size; ++i) {
        const Vec3& a = polygon.corners[i];
        const Vec3& b = polygon.corners[i + 1 < polygon.size ? i + 1 : 0];
        const double db = height(b);
        if (da <= 0) result.add(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) result.add(a + (b - a) * (da / (da - db)));
        da = db;
    }
}

double area(const Polygon& polygon) {
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 2; i < polygon.size; ++i)
        sum += (polygon.corners[i - 1] - polygon.corners[0]) % (polygon.corners[i] - polygon.corners[0]);
    return 0.5 * sum.norm();
}

/// A square on the plane that covers its part in the box.
Polygon covering_square(const Vec3& normal, double offset, const Vec3& lo, double size) {
    const Vec3 middle = lo + Vec3(0.5 * size, 0.5 * size, 0.5 * size);
    const Vec3 foot = middle - normal * ((normal | middle) - offset);
    const Vec3 axis = std::abs(normal[0]) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 u = (normal % axis).normalized() * size, v = normal % u;
    Polygon square;
    square.add(foot + u + v);
    square.add(foot - u + v);
    square.add(foot - u - v);
    square.add(foot + u - v);
    return square;
}

} // namespace

double plane_area(const Vec3& normal, double offset, const Vec3& lo, double size,
                  std::span<const HalfSpace> clips) {
    Polygon polygon = covering_square(normal, offset, lo, size), part;
    for (unsigned axis = 0; axis < 3; ++axis) {
        clip(
            polygon, [&](const Vec3& p) { return p[axis] - (lo[axis] + size); }, part);
        clip(
            part, [&](const Vec3& p) { return lo[axis] - p[axis]; }, polygon);
    }
    for (const HalfSpace& half : clips) {
        clip(
            polygon, [&](const Vec3& p) { return (half.normal | p) - half.offset; }, part);
        polygon = part;
    }
    return area(polygon);
}

} // namespace hsdm
