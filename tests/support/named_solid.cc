#include "support/named_solid.hh"

#include "support/crowded_parts.hh"

namespace hsdm::support {

const std::vector<std::string>& solid_names() {
    static const std::vector<std::string> names{
        "sphere", "torus", "box",       "cylinder",  "cup",   "plate", "wedge", "fillet", "nested",
        "part",   "comb",  "honeycomb", "heat-sink", "hinge", "can",   "roll",  "random"};
    return names;
}

Solid solid_named(const std::string& name, std::uint64_t seed, double width) {
    if (name == "sphere") return sphere(1);
    if (name == "torus") return torus(1, 0.4);
    if (name == "box") return box(Vec3(1, 1, 1));
    if (name == "cylinder") return cylinder(0.5, 2);
    if (name == "plate") return box(Vec3(1, 1, 0.05));
    if (name == "wedge") return wedge(std::numbers::pi / 6, 1, 1);
    if (name == "cup") return cylinder(0.8, 1.4) - cylinder(0.6, 1.4).placed({.shift = {0, 0, 0.2}});
    if (name == "fillet") return rounded_block(0.35);
    if (name == "nested") return nested_spheres(1, 0.8);
    if (name == "part") return mechanical_part();
    for (const CrowdedPart& part : crowded_parts())
        if (name == part.name) return part.of_width(width);
    return random_solid(seed);
}

Pose pose_by_seed(std::uint64_t seed) {
    Random random(seed + 0x9e3779b97f4a7c15u);
    return random_pose(random);
}

} // namespace hsdm::support
