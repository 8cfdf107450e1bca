#include "hsdm/simplify/quadric.hh"

#include "hsdm/simplify/constants.hh"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

void Quadric::add_shared(const Plane& plane, double weight) {
    const bool is_known = std::find(shared().begin(), shared().end(), &plane) != shared().end();
    if (!is_known && shared_count_ == most_shared) {
        add_plane(plane.normal, plane.normal * plane.offset, weight);
        return;
    }
    if (!is_known) shared_[shared_count_++] = &plane;
    shared_weight_ += weight;
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
    for (const Plane* plane : other.shared())
        add_shared(*plane, other.shared_weight_ / static_cast<double>(other.shared_count_));
    return *this;
}

Vec3 Quadric::minimum() const {
    const double least_share = is_all_shared() ? quadrics::least_shared_angle : quadrics::least_angle;
    const Vec3 mean = points_ > 0 ? sum_ / points_ : Vec3(0, 0, 0);
    Eigen::Matrix3d a;
    a << a_[0], a_[1], a_[2], a_[1], a_[3], a_[4], a_[2], a_[4], a_[5];
    const Eigen::Vector3d m(mean[0], mean[1], mean[2]);
    Eigen::Vector3d b = Eigen::Vector3d(b_[0], b_[1], b_[2]) - a * m;
    if (shared_count_ > 0) {
        a /= weight_ + shared_weight_;
        b /= weight_ + shared_weight_;
    }
    for (const Plane* plane : shared()) {
        const Eigen::Vector3d n(plane->normal[0], plane->normal[1], plane->normal[2]);
        a += n * n.transpose();
        b -= n * plane->height(mean);
    }
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
    double most = 0;
    for (const Plane* plane : shared()) most = std::max(most, std::abs(plane->height(x)));
    if (!(weight_ > 0)) return most;
    const double xax = a_[0] * x[0] * x[0] + a_[3] * x[1] * x[1] + a_[5] * x[2] * x[2]
                       + 2 * (a_[1] * x[0] * x[1] + a_[2] * x[0] * x[2] + a_[4] * x[1] * x[2]);
    const double sum = std::max(0.0, xax - 2 * (b_ | x) + c_);
    return std::max(most, std::sqrt(sum / (weight_ + shared_weight_)));
}

/// The error of the shared planes without one of them (or null) at the point where they meet best, near x.
double Quadric::missed_without(const Plane* left_out, const Vec3& x) const {
    Quadric others;
    others.add_point(x);
    for (const Plane* plane : shared())
        if (plane != left_out) others.add_shared(*plane, 1);
    return others.rms(others.minimum());
}

void Quadric::drop_shared(const Vec3& x, double tolerance) {
    while (shared_count_ > 2 && missed_without(nullptr, x) > tolerance) {
        // Prefer planes without which the others meet within the tolerance, and of these the farthest.
        std::size_t worst = 0;
        std::pair<double, double> best{std::numeric_limits<double>::infinity(), 0};
        for (std::size_t k = 0; k < shared_count_; ++k) {
            const std::pair<double, double> order{std::max(tolerance, missed_without(shared_[k], x)),
                                                  -std::abs(shared_[k]->height(x))};
            if (order < best) {
                best = order;
                worst = k;
            }
        }
        std::copy(shared_.begin() + worst + 1, shared_.begin() + shared_count_, shared_.begin() + worst);
        shared_weight_ *= 1 - 1.0 / static_cast<double>(shared_count_);
        --shared_count_;
    }
}

bool Quadric::is_all_shared() const {
    return shared_count_ > 0 && weight_ <= quadrics::next_to_nothing * shared_weight_;
}

std::span<const Vec3> Quadric::shared_normals(std::array<Vec3, most_shared>& normals) const {
    if (!is_all_shared()) return {};
    const auto end = std::transform(shared().begin(), shared().end(), normals.begin(),
                                    [](const Plane* plane) { return plane->normal; });
    return {normals.data(), static_cast<std::size_t>(end - normals.begin())};
}

} // namespace hsdm
