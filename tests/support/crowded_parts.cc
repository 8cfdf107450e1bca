#include "support/crowded_parts.hh"

#include <cmath>
#include <numbers>

namespace hsdm::support {
namespace {

Solid at(const Solid& solid, const Vec3& shift) {
    return solid.placed({.shift = shift});
}

/// A cylinder along x.
Solid rod(double radius, double length, double x = 0) {
    return cylinder(radius, length).placed(turned({0, 1, 0}, std::numbers::pi / 2, {x, 0, 0}));
}

/// A prism along z with six sides; `across` from side to side.
Solid hexagon(double across, double height) {
    const Solid slab = box({across, 2 * across, height});
    const double third = std::numbers::pi / 3;
    return slab & slab.placed(turned({0, 0, 1}, third)) & slab.placed(turned({0, 0, 1}, 2 * third));
}

} // namespace

Solid comb(double width) {
    constexpr int teeth = 16;
    const double length = (2 * teeth - 1) * width;
    Solid solid = at(box({length + 0.2, 0.5, 0.3}), {0, 0, -0.5});
    for (int i = 0; i < teeth; ++i) // sunk in the base: no two faces coincide
        solid = solid | at(box({width, 0.3, 1}), {2 * i * width + 0.5 * (width - length), 0, 0.05});
    return solid;
}

Solid honeycomb(double width) {
    const double across = 0.5, pitch = across + width;
    const Solid cell = hexagon(across, 1);
    Solid solid = cylinder(1.5 * pitch + 0.1, 0.5) - cell;
    for (int i = 0; i < 6; ++i) {
        const double angle = i * std::numbers::pi / 3;
        solid = solid - at(cell, {pitch * std::cos(angle), pitch * std::sin(angle), 0});
    }
    return solid;
}

Solid heat_sink(double width) {
    constexpr int fins = 8;
    const double pitch = 3 * width, length = (fins - 1) * pitch + width;
    Solid solid = at(box({length + 0.2, 1.4, 0.2}), {0, 0, -0.4});
    for (int i = 0; i < fins; ++i)
        solid = solid | at(box({width, 1.2, 0.8}), {i * pitch + 0.5 * (width - length), 0, 0});
    return solid - at(box({length + 1, width, 1}), {0, 0, 0.1});
}

Solid hinge(double width) {
    const double pin = 0.2, bore = pin + width, knuckle = bore + 0.2, part = 0.6;
    const double reach = knuckle + width; // of what a leaf keeps clear of the other's knuckles
    const auto leaf = [&](double side) {
        return at(box({3 * part, 1, 0.15}), {0, side * 0.6, 0.7 * knuckle});
    };
    const Solid hole = rod(bore, 4 * part);
    const Solid one = (((leaf(-1) - rod(reach, part + 3 * width)) | rod(knuckle, part, -part - width)
                        | rod(knuckle, part, part + width))
                       - hole);
    const Solid other =
        (((leaf(1) - rod(reach, part + 3 * width, -part - width) - rod(reach, part + 3 * width, part + width))
          | rod(knuckle, part))
         - hole);
    return one | other | rod(pin, 4 * part + 0.2);
}

Solid can(double width) {
    const double radius = 0.7, height = 1.4;
    return cylinder(radius, height) - at(cylinder(radius - width, height), {0, 0, width});
}

Solid roll(double width) {
    constexpr int halves = 5;
    constexpr double overlap = 1e-3, large = 4;
    const double pitch = 3 * width; // of a whole turn
    // Half rings about two centres by turns, half a pitch apart, go on from each other.
    const auto half = [&](int i) {
        const double inner = 0.25 + 0.5 * i * pitch, side = i % 2 == 0 ? 1 : -1;
        const Solid ring = cylinder(inner + width, 1.2) - cylinder(inner, 1.4);
        return at(ring, {-side * 0.25 * pitch, 0, 0})
               & at(box({large, large, 2}), {0, side * (0.5 * large - overlap), 0});
    };
    Solid solid = half(0);
    for (int i = 1; i < halves; ++i) solid = solid | half(i);
    return solid;
}

const std::vector<CrowdedPart>& crowded_parts() {
    static const std::vector<CrowdedPart> parts{{"comb", comb, 1, 2},
                                                {"honeycomb", honeycomb, 1, -12},
                                                {"heat-sink", heat_sink, 1, 2},
                                                {"hinge", hinge, 3, 0},
                                                {"can", can, 1, 2},
                                                {"roll", roll, 1, 2}};
    return parts;
}

Solid lattice(double width, double pitch) {
    const double length = 2 * pitch + width, inner = pitch - width, little = 0.005 * pitch;
    const auto channel = [&](const Vec3& size, const Vec3& middle) {
        return box(size).placed(turned({0, 0, 1}, 0, middle));
    };
    Solid bars = box({length, length, length});
    for (const double u : {-0.5 * pitch, 0.5 * pitch})
        for (const double w : {-0.5 * pitch, 0.5 * pitch})
            bars = bars - channel({2 * length, inner, inner}, {0, u, w})
                   - channel({inner + little, 2 * length, inner + little}, {u, 0, w})
                   - channel({inner + 2 * little, inner + 2 * little, 2 * length}, {u, w, 0});
    return bars;
}

} // namespace hsdm::support
