#pragma once
// Solids with known surfaces: primitives in any pose, and constructive trees of them.

#include "support/pose.hh"

#include <bitset>
#include <memory>
#include <vector>

namespace hsdm::support {

/// A point of a surface and the outward unit normal there.
struct SurfacePoint {
    Vec3 position, normal;
};

/// A primitive about the origin. Distances are exact and negative inside.
class Primitive {
public:
    virtual ~Primitive() = default;
    virtual double distance(const Vec3& p) const = 0;
    virtual double area() const = 0;
    /// A point even over the surface's area, with its exact normal.
    virtual SurfacePoint sample(Random& random) const = 0;
};

/// A tree of unions, intersections and differences over placed primitives; a value, cheap to copy.
class Solid {
public:
    Solid(std::shared_ptr<const Primitive> primitive, const Pose& pose = {});

    /// The same solid turned and shifted as a whole.
    Solid placed(const Pose& pose) const;

    /// Negative inside. Exact for a single primitive; for a tree the sign is exact everywhere and the
    /// magnitude never more than the true distance (and exact where one primitive alone is near).
    double distance(const Vec3& p) const;
    bool contains(const Vec3& p) const { return distance(p) < 0; }

    /// Sum over the primitives, which bounds the area of the boundary from above.
    double primitive_area() const;

    /// One candidate, even over the area of all primitives: false if it is not on the tree's boundary. What
    /// is kept is therefore even over the boundary. Faces of two primitives that coincide are not resolved.
    bool sample(Random& random, SurfacePoint& point) const;

    friend Solid operator|(const Solid& a, const Solid& b) { return combine(Operation::join, a, b); }
    friend Solid operator&(const Solid& a, const Solid& b) { return combine(Operation::meet, a, b); }
    friend Solid operator-(const Solid& a, const Solid& b) { return combine(Operation::subtract, a, b); }

private:
    static constexpr std::size_t most_leaves = 32;
    enum class Operation { leaf, join, meet, subtract };
    struct Leaf {
        std::shared_ptr<const Primitive> primitive;
        Pose pose;
    };
    /// Postfix: a leaf pushes its value, an operation pops two and pushes one.
    struct Step {
        Operation operation = Operation::leaf;
        std::size_t leaf = 0;
    };

    Solid() = default;
    static Solid combine(Operation operation, const Solid& a, const Solid& b);
    bool contains_if(const std::bitset<most_leaves>& inside_leaf) const;

    std::vector<Leaf> leaves_;
    std::vector<Step> steps_;
};

/// Turned so that none of its directions is an axis.
Solid in_general_pose(const Solid& solid);

Solid sphere(double radius);
/// About the z axis; `ring` from the axis to the tube's centre, `tube` < `ring`.
Solid torus(double ring, double tube);
/// Full edge lengths. A plate is a thin box.
Solid box(const Vec3& size);
/// About the z axis, full height.
Solid cylinder(double radius, double height);
/// A prism along z whose cross-section is the triangle with an edge of length `length` along x from the
/// origin, opening by `angle` radians (below pi / 2), its far side upright; full height.
Solid wedge(double angle, double length, double height);
/// Along z, regular, of an even number of `sides` (6 to 32), two opposite ones `across` apart: edges that
/// turn by 360 degrees / sides.
Solid prism(int sides, double across, double height);
/// A block of 2 x 1 x 1 whose edge along x at positive y and z is rounded, `radius` below 1.
Solid rounded_block(double radius);
/// A block of 2 x 1 x 1 without a square of `step` along that edge, hollow with `radius` < step between the
/// step's sides.
Solid hollow_step(double radius, double step);
/// The shell between two concentric spheres.
Solid nested_spheres(double outer, double inner);

/// A part like the paper's Figure 3: two shafts on a block with two crossing drilled holes; genus 3. About 3
/// units long, sharp edges all over, in general pose if `pose` says so.
Solid mechanical_part(const Pose& pose = {});

/// A random tree of 2 to 5 boxes, cylinders, spheres, tubes and plates in random pose, unions and
/// differences, about 2 units across. The walls of its plates and tubes are `thinnest` to `thickest`; nothing
/// keeps what remains between two primitives from being thinner, nor the whole in one piece.
Solid random_solid(std::uint64_t seed, double thinnest = 0.05, double thickest = 0.24);

} // namespace hsdm::support
