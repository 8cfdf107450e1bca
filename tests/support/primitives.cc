#include "support/solid.hh"

#include <algorithm>

namespace hsdm::support {
namespace {

constexpr double pi = std::numbers::pi;

class Sphere : public Primitive {
public:
    explicit Sphere(double radius) : radius_(radius) {}
    double distance(const Vec3& p) const override { return p.norm() - radius_; }
    double area() const override { return 4 * pi * radius_ * radius_; }
    SurfacePoint sample(Random& random) const override {
        const Vec3 n = random.direction();
        return {n * radius_, n};
    }

private:
    double radius_;
};

class Torus : public Primitive {
public:
    Torus(double ring, double tube) : ring_(ring), tube_(tube) {}
    double distance(const Vec3& p) const override {
        return std::hypot(std::hypot(p[0], p[1]) - ring_, p[2]) - tube_;
    }
    double area() const override { return 4 * pi * pi * ring_ * tube_; }
    SurfacePoint sample(Random& random) const override {
        // The area of a strip of the tube grows with its distance from the axis.
        double tube_angle = 0;
        do {
            tube_angle = random.uniform(0, 2 * pi);
        } while (random.uniform() * (ring_ + tube_) > ring_ + tube_ * std::cos(tube_angle));
        const double ring_angle = random.uniform(0, 2 * pi);
        const Vec3 out(std::cos(ring_angle), std::sin(ring_angle), 0);
        const Vec3 n = out * std::cos(tube_angle) + Vec3(0, 0, std::sin(tube_angle));
        return {out * ring_ + n * tube_, n};
    }

private:
    double ring_, tube_;
};

/// Distance to the product of a plane figure and a segment, from the distances to each.
double extrude(double figure, double along) {
    return std::min(std::max(figure, along), 0.0) + std::hypot(std::max(figure, 0.0), std::max(along, 0.0));
}

class Box : public Primitive {
public:
    explicit Box(const Vec3& size) : half_(size * 0.5) {}
    double distance(const Vec3& p) const override {
        const Vec3 q(std::abs(p[0]) - half_[0], std::abs(p[1]) - half_[1], std::abs(p[2]) - half_[2]);
        const Vec3 outside(std::max(q[0], 0.0), std::max(q[1], 0.0), std::max(q[2], 0.0));
        return outside.norm() + std::min(q.max(), 0.0);
    }
    double area() const override { return 2 * (face(0) + face(1) + face(2)); }
    SurfacePoint sample(Random& random) const override {
        double pick = random.uniform() * (face(0) + face(1) + face(2));
        unsigned axis = 0;
        while (axis < 2 && pick >= face(axis)) pick -= face(axis++);
        const double side = random.uniform() < 0.5 ? -1 : 1;
        Vec3 p, n(0, 0, 0);
        for (unsigned k = 0; k < 3; ++k) p[k] = random.uniform(-half_[k], half_[k]);
        p[axis] = side * half_[axis];
        n[axis] = side;
        return {p, n};
    }

private:
    double face(unsigned axis) const { return 4 * half_[(axis + 1) % 3] * half_[(axis + 2) % 3]; }
    Vec3 half_;
};

class Cylinder : public Primitive {
public:
    Cylinder(double radius, double height) : radius_(radius), half_(height / 2) {}
    double distance(const Vec3& p) const override {
        return extrude(std::hypot(p[0], p[1]) - radius_, std::abs(p[2]) - half_);
    }
    double area() const override { return 2 * pi * radius_ * (2 * half_ + radius_); }
    SurfacePoint sample(Random& random) const override {
        const double angle = random.uniform(0, 2 * pi);
        const Vec3 out(std::cos(angle), std::sin(angle), 0);
        if (random.uniform() * (2 * half_ + radius_) < 2 * half_)
            return {out * radius_ + Vec3(0, 0, random.uniform(-half_, half_)), out};
        const double side = random.uniform() < 0.5 ? -1 : 1;
        return {out * (radius_ * std::sqrt(random.uniform())) + Vec3(0, 0, side * half_), Vec3(0, 0, side)};
    }

private:
    double radius_, half_;
};

/// A triangle in the xy plane, counter-clockwise, extruded along z.
class TriangularPrism : public Primitive {
public:
    TriangularPrism(const std::array<Vec3, 3>& corners, double height)
        : corner_(corners), half_(height / 2) {}
    double distance(const Vec3& p) const override {
        const Vec3 q(p[0], p[1], 0);
        double nearest = std::numeric_limits<double>::infinity(), outermost = -nearest;
        for (unsigned k = 0; k < 3; ++k) {
            const Vec3 along = side(k), from = q - corner_[k];
            const double t = std::clamp((from | along) / along.sqrnorm(), 0.0, 1.0);
            nearest = std::min(nearest, (from - along * t).norm());
            outermost = std::max(outermost, from | normal(k));
        }
        return extrude(outermost < 0 ? -nearest : nearest, std::abs(p[2]) - half_);
    }
    double area() const override {
        double sum = 2 * cap();
        for (unsigned k = 0; k < 3; ++k) sum += 2 * half_ * side(k).norm();
        return sum;
    }
    SurfacePoint sample(Random& random) const override {
        double pick = random.uniform() * area();
        for (unsigned k = 0; k < 3; ++k) {
            const double strip = 2 * half_ * side(k).norm();
            if (pick < strip)
                return {corner_[k] + side(k) * random.uniform() + Vec3(0, 0, random.uniform(-half_, half_)),
                        normal(k)};
            pick -= strip;
        }
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const double end = random.uniform() < 0.5 ? -1 : 1;
        const Vec3 p = corner_[0] + (corner_[1] - corner_[0]) * u + (corner_[2] - corner_[0]) * v;
        return {p + Vec3(0, 0, end * half_), Vec3(0, 0, end)};
    }

private:
    Vec3 side(unsigned k) const { return corner_[(k + 1) % 3] - corner_[k]; }
    Vec3 normal(unsigned k) const { return Vec3(side(k)[1], -side(k)[0], 0).normalized(); }
    double cap() const { return ((corner_[1] - corner_[0]) % (corner_[2] - corner_[0])).norm() / 2; }
    std::array<Vec3, 3> corner_;
    double half_;
};

} // namespace

Solid sphere(double radius) {
    return Solid(std::make_shared<Sphere>(radius));
}
Solid torus(double ring, double tube) {
    return Solid(std::make_shared<Torus>(ring, tube));
}
Solid box(const Vec3& size) {
    return Solid(std::make_shared<Box>(size));
}
Solid cylinder(double radius, double height) {
    return Solid(std::make_shared<Cylinder>(radius, height));
}
Solid wedge(double angle, double length, double height) {
    const std::array<Vec3, 3> corners{Vec3(0, 0, 0), Vec3(length, 0, 0),
                                      Vec3(length, length * std::tan(angle), 0)};
    return Solid(std::make_shared<TriangularPrism>(corners, height));
}

Solid prism(int sides, double across, double height) {
    Solid result = box({2 * across, 2 * across, height});
    for (int i = 0; 2 * i < sides; ++i)
        result = result
                 & box({across, 2 * across, 2 * height})
                       .placed(turned({0, 0, 1}, 2 * std::numbers::pi * i / sides));
    return result;
}

} // namespace hsdm::support
