#pragma once
// Places all over a surface that facets stand for.

#include "hsdm/polygon_mesh.hh"

#include <functional>
#include <vector>

namespace hsdm {

/// Facets that are bent as the normals at their corners tell: halfway from where they are flat to the mean of
/// the corners' planes, which is exact for a quadratic (Phong tessellation: Boubekeur, Alexa 2008).
class BentFacets {
public:
    /// The mesh must outlive it. O(corners), parallel.
    BentFacets(const PolygonMesh& mesh, double voxel_size);

    /// Calls put(place, normal) for places all over a facet, as dense as completed points are in such voxels.
    using Put = std::function<void(const Vec3& place, const Vec3& normal)>;
    void for_places(std::size_t facet, const Put& put) const;

private:
    const PolygonMesh& mesh_;
    std::vector<Vec3> normals_; ///< per corner, of the surface on the facet's side of creases
    double voxel_size_;
};

} // namespace hsdm
