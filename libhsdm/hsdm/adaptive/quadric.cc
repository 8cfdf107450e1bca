#include "hsdm/adaptive/quadric.hh"

#include "hsdm/facets/area_vector.hh"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace hsdm {

void Quadric::add_plane(const Vec3& normal, const Vec3& point, double weight) {
    const double d = normal | point;
    std::size_t k = 0;
    for (unsigned i = 0; i < 3; ++i)
        for (unsigned j = i; j < 3; ++j) a_[k++] += weight * normal[i] * normal[j];
    b_ += normal * (weight * d);
    c_ += weight * d * d;
    weight_ += weight;
}

void Quadric::add_point(const Vec3& point) {
    sum_ += point;
    points_ += 1;
}

Quadric& Quadric::operator+=(const Quadric& other) {
    for (std::size_t k = 0; k < 6; ++k) a_[k] += other.a_[k];
    b_ += other.b_;
    c_ += other.c_;
    weight_ += other.weight_;
    sum_ += other.sum_;
    points_ += other.points_;
    return *this;
}

Vec3 Quadric::minimum() const {
    constexpr double least_share = 0.02;
    const Vec3 mean = points_ > 0 ? sum_ / points_ : Vec3(0, 0, 0);
    Eigen::Matrix3d a;
    a << a_[0], a_[1], a_[2], a_[1], a_[3], a_[4], a_[2], a_[4], a_[5];
    const Eigen::Vector3d m(mean[0], mean[1], mean[2]);
    const Eigen::Vector3d b = Eigen::Vector3d(b_[0], b_[1], b_[2]) - a * m;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(a);
    const Eigen::Vector3d values = eigen.eigenvalues(); // ascending
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int k = 2; k >= 0 && values[k] > 0 && values[k] >= least_share * values[2]; --k) {
        const Eigen::Vector3d v = eigen.eigenvectors().col(k);
        x += v * (v.dot(b) / values[k]);
    }
    return mean + Vec3(x[0], x[1], x[2]);
}

double Quadric::rms(const Vec3& x) const {
    if (!(weight_ > 0)) return 0;
    const double xax = a_[0] * x[0] * x[0] + a_[3] * x[1] * x[1] + a_[5] * x[2] * x[2]
                       + 2 * (a_[1] * x[0] * x[1] + a_[2] * x[0] * x[2] + a_[4] * x[1] * x[2]);
    return std::sqrt(std::max(0.0, xax - 2 * (b_ | x) + c_) / weight_);
}

std::vector<Quadric> vertex_planes(const PolygonMesh& mesh) {
    std::vector<Quadric> planes(mesh.vertex_count());
    for (std::size_t v = 0; v < planes.size(); ++v) planes[v].add_point(mesh.positions[v]);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        const Vec3 area = area_vector(mesh, ring);
        const double length = area.norm();
        if (!(length > 0)) continue;
        Vec3 centre(0, 0, 0);
        for (Index v : ring) centre += mesh.positions[v];
        centre /= static_cast<double>(ring.size());
        for (Index v : ring)
            planes[v].add_plane(area / length, centre, length / static_cast<double>(ring.size()));
    }
    return planes;
}

} // namespace hsdm
