#pragma once
// Sums of squared distances to planes: where a vertex that stands for many lies, and how far off it is.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// sum w (n . x - d)^2 over planes, and the mean of some points to hold on to where the planes leave open.
class Quadric {
public:
    void add_plane(const Vec3& normal, const Vec3& point, double weight);
    void add_point(const Vec3& point);
    Quadric& operator+=(const Quadric& other);

    /// Where the sum is least, the least change from the mean of the points in directions that the planes do
    /// not determine (eigenvalues below a fiftieth of the largest: normals spread by less fix no position).
    Vec3 minimum() const;
    /// Root of the weighted mean of the squared distances at x; 0 without planes.
    double rms(const Vec3& x) const;

private:
    double a_[6] = {0, 0, 0, 0, 0, 0}; // xx, xy, xz, yy, yz, zz
    Vec3 b_{0, 0, 0};
    double c_ = 0, weight_ = 0;
    Vec3 sum_{0, 0, 0};
    double points_ = 0;
};

/// Per vertex the planes of its facets, each by its share of their area, and the vertex itself.
std::vector<Quadric> vertex_planes(const PolygonMesh& mesh);

} // namespace hsdm
