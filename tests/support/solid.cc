#include "support/solid.hh"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace hsdm::support {

Solid::Solid(std::shared_ptr<const Primitive> primitive, const Pose& pose)
    : leaves_{{std::move(primitive), pose}}, steps_(1) {}

Solid Solid::placed(const Pose& pose) const {
    Solid result = *this;
    for (Leaf& leaf : result.leaves_) leaf.pose = compose(pose, leaf.pose);
    return result;
}

Solid in_general_pose(const Solid& solid) {
    return solid.placed(random_pose(4));
}

Solid Solid::combine(Operation operation, const Solid& a, const Solid& b) {
    if (a.leaves_.size() + b.leaves_.size() > most_leaves)
        throw std::invalid_argument("a solid has at most " + std::to_string(most_leaves) + " primitives");
    Solid result = a;
    result.leaves_.insert(result.leaves_.end(), b.leaves_.begin(), b.leaves_.end());
    for (Step step : b.steps_) {
        step.leaf += a.leaves_.size();
        result.steps_.push_back(step);
    }
    result.steps_.push_back({operation, 0});
    return result;
}

double Solid::distance(const Vec3& p) const {
    std::array<double, most_leaves> stack;
    std::size_t size = 0;
    for (const Step& step : steps_) {
        if (step.operation == Operation::leaf) {
            const Leaf& leaf = leaves_[step.leaf];
            stack[size++] = leaf.primitive->distance(leaf.pose.to_local(p));
            continue;
        }
        const double b = stack[--size];
        double& a = stack[size - 1];
        switch (step.operation) {
        case Operation::join:
            a = std::min(a, b);
            break;
        case Operation::meet:
            a = std::max(a, b);
            break;
        default:
            a = std::max(a, -b);
        }
    }
    return stack[0];
}

bool Solid::contains_if(const std::bitset<most_leaves>& inside_leaf) const {
    std::bitset<most_leaves> stack;
    std::size_t size = 0;
    for (const Step& step : steps_) {
        if (step.operation == Operation::leaf) {
            stack[size++] = inside_leaf[step.leaf];
            continue;
        }
        const bool b = stack[--size], a = stack[size - 1];
        switch (step.operation) {
        case Operation::join:
            stack[size - 1] = a || b;
            break;
        case Operation::meet:
            stack[size - 1] = a && b;
            break;
        default:
            stack[size - 1] = a && !b;
        }
    }
    return stack[0];
}

double Solid::primitive_area() const {
    double sum = 0;
    for (const Leaf& leaf : leaves_) sum += leaf.primitive->area();
    return sum;
}

bool Solid::sample(Random& random, SurfacePoint& point) const {
    double pick = random.uniform() * primitive_area();
    std::size_t chosen = 0;
    while (chosen + 1 < leaves_.size() && pick >= leaves_[chosen].primitive->area())
        pick -= leaves_[chosen++].primitive->area();
    const SurfacePoint local = leaves_[chosen].primitive->sample(random);
    point.position = leaves_[chosen].pose.to_world(local.position);
    point.normal = leaves_[chosen].pose.rotate(local.normal);

    // On the boundary of the tree if crossing this one surface changes what the tree says.
    std::bitset<most_leaves> inside;
    for (std::size_t i = 0; i < leaves_.size(); ++i)
        inside[i] = leaves_[i].primitive->distance(leaves_[i].pose.to_local(point.position)) < 0;
    inside[chosen] = true;
    const bool before = contains_if(inside);
    inside[chosen] = false;
    if (before == contains_if(inside)) return false;
    if (!before) point.normal = -point.normal;
    return true;
}

namespace {

Solid bar_with_rounded_edge(double length, double radius) {
    const Pose along_x = turned(Vec3(0, 1, 0), std::numbers::pi / 2, Vec3(0, 0.5 - radius, 0.5 - radius));
    const Solid corner =
        box(Vec3(length + 1, 2 * radius, 2 * radius)).placed({Pose().rotation, Vec3(0, 0.5, 0.5)});
    return box(Vec3(length, 1, 1)) - (corner - cylinder(radius, length + 2).placed(along_x));
}

} // namespace

Solid rounded_block(double radius) {
    return bar_with_rounded_edge(2, radius);
}

Solid hollow_step(double radius, double step) {
    const Vec3 shift(0, 1 - step, 1 - step);
    return box(Vec3(2, 1, 1))
           - bar_with_rounded_edge(3, radius).placed(turned(Vec3(1, 0, 0), std::numbers::pi, shift));
}

Solid nested_spheres(double outer, double inner) {
    return sphere(outer) - sphere(inner);
}

Solid mechanical_part(const Pose& pose) {
    const auto at = [](const Vec3& shift) { return Pose{Pose().rotation, shift}; };
    const Pose along_x = turned(Vec3(0, 1, 0), std::numbers::pi / 2);
    const Pose along_y = turned(Vec3(1, 0, 0), std::numbers::pi / 2);
    const Solid block = box(Vec3(1, 1, 1));
    const Solid upper = cylinder(0.3, 1.2).placed(at(Vec3(0, 0, 0.9)));
    const Solid lower = cylinder(0.2, 1.2).placed(at(Vec3(0, 0, -0.9)));
    const Solid holes = cylinder(0.24, 1.4).placed(along_x) | cylinder(0.24, 1.4).placed(along_y);
    return ((block | upper | lower) - holes).placed(pose);
}

namespace {

Solid random_primitive(Random& random, double thinnest, double thickest) {
    const double a = random.uniform(0.4, 1.2), b = random.uniform(0.4, 1.2), c = random.uniform(0.4, 1.2);
    const double wall = random.uniform(thinnest, thickest);
    switch (random.below(5)) {
    case 0:
        return box(Vec3(a, b, c));
    case 1:
        return cylinder(a / 2, b + c);
    case 2:
        return sphere(0.6 * a);
    case 3: // a tube, open at both ends; half as long again inside
        return a / 2 > 2 * wall ? cylinder(a / 2, b) - cylinder(a / 2 - wall, 1.5 * b) : cylinder(a / 2, b);
    default:
        return box(Vec3(a + 0.4, b + 0.4, wall));
    }
}

} // namespace

Solid random_solid(std::uint64_t seed, double thinnest, double thickest) {
    Random random(seed);
    Solid result = random_primitive(random, thinnest, thickest).placed(random_pose(random));
    const std::size_t further = 1 + random.below(4);
    for (std::size_t i = 0; i < further; ++i) {
        const Solid next = random_primitive(random, thinnest, thickest).placed(random_pose(random, 0.5));
        result = random.uniform() < 0.6 ? result | next : result - next;
    }
    return result;
}

} // namespace hsdm::support
