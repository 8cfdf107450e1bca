#include "hsdm/sheets/plane_area.hh"

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

Polygon clipped(const Polygon& polygon, const HalfSpace& keep) {
    Polygon result;
    for (std::size_t i = 0; i < polygon.size; ++i) {
        const Vec3& a = polygon.corners[i];
        const Vec3& b = polygon.corners[(i + 1) % polygon.size];
        const double da = (keep.normal | a) - keep.offset, db = (keep.normal | b) - keep.offset;
        if (da <= 0) result.add(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) result.add(a + (b - a) * (da / (da - db)));
    }
    return result;
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
    Polygon polygon = covering_square(normal, offset, lo, size);
    for (unsigned axis = 0; axis < 3; ++axis) {
        Vec3 up(0, 0, 0);
        up[axis] = 1;
        polygon = clipped(polygon, {up, lo[axis] + size});
        polygon = clipped(polygon, {-up, -lo[axis]});
    }
    for (const HalfSpace& clip : clips) polygon = clipped(polygon, clip);
    return area(polygon);
}

} // namespace hsdm
