#include "support/scenes.hh"

#include <cmath>
#include <numbers>

namespace hsdm::support {
namespace {

Solid at(const Solid& solid, double x, double y, double z) {
    return solid.placed({.shift = {x, y, z}});
}

/// A box whose bottom lies at this height.
Solid box_on(double height, const Vec3& size, double x = 0, double y = 0) {
    return at(box(size), x, y, height + 0.5 * size[2]);
}

constexpr double sunk = 0.03; // what stands on something reaches into it

Scene table(Random& random) {
    const double height = random.uniform(0.3, 0.6), width = random.uniform(1.2, 1.5),
                 depth = random.uniform(0.9, 1.3), leg = random.uniform(0.2, 0.28);
    const int legs = 3 + static_cast<int>(random.below(2));
    Solid solid = box_on(height, {width, depth, 0.16});
    for (int k = 0; k < legs; ++k) {
        const double x = legs == 3 && k == 2 ? 0 : k % 2 == 0 ? -1 : 1, y = k < 2 ? -1 : 1;
        solid =
            solid
            | box_on(-sunk, {leg, leg, height + 2 * sunk}, x * (0.5 * width - leg), y * (0.5 * depth - leg));
    }
    return {"table", solid, 0, 2 - 2 * (legs - 1)};
}

Scene arch(Random& random) {
    const double height = random.uniform(0.35, 0.7), width = random.uniform(1, 1.4),
                 depth = random.uniform(0.6, 1.1), pillar = random.uniform(0.2, 0.3);
    const Vec3 size(pillar, depth, height + 2 * sunk);
    return {"arch",
            box_on(height, {width, depth + 0.1, 0.2}) | box_on(-sunk, size, -0.5 * width + pillar)
                | box_on(-sunk, size, 0.5 * width - pillar),
            0, 0};
}

Scene shelf(Random& random) {
    const double gap = random.uniform(0.4, 0.5), width = random.uniform(1, 1.3),
                 depth = random.uniform(0.5, 0.8), side = random.uniform(0.15, 0.2);
    const Vec3 board(width - side, depth - 0.04, 0.15), wall(side, depth, 2 * gap + 0.3);
    return {"shelf",
            box_on(gap, board) | box_on(2 * gap + 0.08, board) | box_on(-sunk, wall, -0.5 * width)
                | box_on(-sunk, wall, 0.5 * width),
            0, -2};
}

Scene mug(Random& random) {
    const double radius = random.uniform(0.4, 0.55), height = random.uniform(0.8, 1.1),
                 ring = random.uniform(0.28, 0.34), rod = random.uniform(0.1, 0.13);
    const Solid handle =
        torus(ring, rod).placed(turned({1, 0, 0}, 0.5 * std::numbers::pi, {radius + 0.03, 0, 0.5 * height}));
    const Solid body = at(cylinder(radius, height + sunk), 0, 0, 0.5 * (height - sunk)) | handle;
    return {"mug", body - at(cylinder(radius - 0.12, height), 0, 0, 0.5 * height + 0.12), 0, 0};
}

Scene windows(Random& random) {
    const int count = 1 + static_cast<int>(random.below(3));
    const double height = random.uniform(0.8, 1), radius = random.uniform(0.18, 0.22),
                 thickness = random.uniform(0.25, 0.5);
    Solid solid = box_on(-sunk, {1.7, thickness, height + sunk});
    for (int k = 0; k < count; ++k)
        solid = solid
                - cylinder(radius, 1).placed(turned({1, 0, 0}, 0.5 * std::numbers::pi,
                                                    {0.55 * (k - 0.5 * (count - 1)), 0, 0.55 * height}));
    return {"wall", solid, 0, 2 - 2 * count};
}

} // namespace

Scene scene(std::uint64_t seed) {
    Random random(seed);
    static constexpr std::array<Scene (*)(Random&), 5> kinds{table, arch, shelf, mug, windows};
    Scene made = kinds[seed % kinds.size()](random);
    const Solid whole = made.solid | box_on(-0.12, {2.4, 2.2, 0.12});
    made.solid = whole.placed(turned({0.1, 0.05, 1}, random.uniform(0, 2 * std::numbers::pi), {0, 0, -0.3}));
    made.radius = 1.75;
    return made;
}

} // namespace hsdm::support
