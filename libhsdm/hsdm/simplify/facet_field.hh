#pragma once
// How a surface bends around each of its facets.

#include "hsdm/polygon_mesh.hh"

#include <array>

namespace hsdm {

/// How directions vary: root mean squares along three perpendicular axes, ascending.
struct Variation {
    std::array<double, 3> deviation;
    std::array<Vec3, 3> direction; ///< unit
};

/// Weighted normals: their mean and how they vary.
class NormalSum {
public:
    void add(const Vec3& normal, double weight);
    NormalSum& operator+=(const NormalSum& other);

    /// Zero if no normal has weight, as are all other results then.
    Vec3 mean() const { return weight_ > 0 ? sum_ / weight_ : Vec3(0, 0, 0); }
    Variation about_zero() const { return about({0, 0, 0}, true); }
    Variation about_mean() const { return about(mean(), true); }
    std::array<double, 3> deviation() const { return about(mean(), false).deviation; } ///< about the mean

private:
    Variation about(const Vec3& centre, bool with_directions) const;

    Vec3 sum_{0, 0, 0};
    double squares_[6] = {0, 0, 0, 0, 0, 0}; // xx, xy, xz, yy, yz, zz
    double weight_ = 0;
};

/// Properties of each facet (`beside`: of each side). The neighbourhood of a facet is all facets up to three
/// sides away, near ones counting most, that no sharp edge (26 degrees) separates from it.
struct FacetField {
    std::span<const Index> first;  ///< the mesh's
    std::vector<Index> beside;     ///< per side: the facet beyond it, unless the edge is sharp or a border
    std::vector<Vec3> area;        ///< vectors along the normals, as long as twice the area
    std::vector<Vec3> centre;      ///< mean of the corners
    std::vector<Vec3> normal;      ///< unit
    std::vector<Vec3> mean_normal; ///< of the neighbourhood, unit
    std::vector<NormalSum> around; ///< normals of the neighbourhood
    /// Standard deviations of those normals in the direction in which they vary most, and in the next: the
    /// ratio next_spread / spread is small where the surface bends one way only.
    std::vector<double> spread, next_spread;
    std::vector<std::uint8_t> convex; ///< do normals of the neighbourhood diverge?

    std::size_t size() const { return area.size(); }
    template <class Act>
    void for_beside(Index facet, const Act& act) const {
        for (Index side = first[facet]; side < first[facet + 1]; ++side)
            if (beside[side] != no_index) act(beside[side]);
    }
};

/// O(n), parallel, the same bits for any number of threads. The mesh, a 2-manifold, must outlive it.
FacetField facet_field(const PolygonMesh& mesh);

} // namespace hsdm
