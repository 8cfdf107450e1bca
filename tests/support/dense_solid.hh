#pragma once
// What kind of solid a function describes, found from the function alone by evaluating it densely.

#include "hsdm/point_cloud.hh"
#include "support/solid.hh"

namespace hsdm::support {

/// The points of a grid that lie inside a solid.
class DenseSolid {
public:
    /// Over `bounds`, which must hold the solid with two steps to spare. Whole blocks are decided by one
    /// value where the distance allows it.
    DenseSolid(const Solid& solid, const Box& bounds, double step);

    /// Euler characteristic of the solid's surface: twice that of the solid, which is counted on Kuhn's
    /// triangulation of the grid (six tetrahedra a cell, 14 neighbours a point) over the simplices whose
    /// corners are all inside. Inside and outside are connected alike there, so no cell is ambiguous.
    long surface_euler() const;

    /// The points within `reach` of the solid; with a negative reach those farther than that from its
    /// outside. The bounds must have room for it.
    DenseSolid grown(double reach) const;

    std::size_t inside_count() const;

private:
    std::size_t at(std::size_t x, std::size_t y, std::size_t z) const {
        return (z * size_[1] + y) * size_[0] + x;
    }
    bool on_surface(std::size_t point) const;

    double step_;
    std::array<std::size_t, 3> size_{};
    std::vector<std::uint8_t> inside_;
};

/// The least distance, up to `limit`, at which two pieces of the surface face each other, through the solid
/// or through its outside: along the normal of a point of the surface to a place whose normal is within
/// `angle` (radians) of the opposite one. So the two sides of an edge do not face each other unless it is
/// sharper than that. Measured at the cloud's points, to a hundredth of the limit.
double least_facing_distance(const Solid& solid, const PointCloud& surface, double limit, double angle);

} // namespace hsdm::support
