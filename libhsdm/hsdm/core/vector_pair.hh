#pragma once
// Two vectors at once.

#include "hsdm/core/lanes.hh"
#include "hsdm/types.hh"

#include <array>

namespace hsdm {

/// Two vectors side by side, one in each lane; every operation applies to both at once. Operators are those
/// of Vec3: `|` the scalar product, `%` the cross product.
class VectorPair {
public:
    VectorPair() = default;
    VectorPair(Double2 x, Double2 y, Double2 z) : lanes_{x, y, z} {}
    VectorPair(const Vec3& a, const Vec3& b) : lanes_{{{a[0], b[0]}, {a[1], b[1]}, {a[2], b[2]}}} {}

    Double2 operator[](std::size_t axis) const { return lanes_[axis]; }
    Double2 operator|(const Vec3& v) const { return lanes_[0] * v[0] + lanes_[1] * v[1] + lanes_[2] * v[2]; }
    Double2 operator|(const VectorPair& v) const {
        return lanes_[0] * v[0] + lanes_[1] * v[1] + lanes_[2] * v[2];
    }
    VectorPair operator%(const VectorPair& v) const {
        return {lanes_[1] * v[2] - lanes_[2] * v[1], lanes_[2] * v[0] - lanes_[0] * v[2],
                lanes_[0] * v[1] - lanes_[1] * v[0]};
    }
    VectorPair operator+(const VectorPair& v) const {
        return {lanes_[0] + v[0], lanes_[1] + v[1], lanes_[2] + v[2]};
    }
    VectorPair operator-(const VectorPair& v) const {
        return {lanes_[0] - v[0], lanes_[1] - v[1], lanes_[2] - v[2]};
    }
    VectorPair operator*(Double2 factor) const {
        return {lanes_[0] * factor, lanes_[1] * factor, lanes_[2] * factor};
    }

private:
    std::array<Double2, 3> lanes_;
};

} // namespace hsdm
