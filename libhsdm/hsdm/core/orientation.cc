#include "hsdm/core/orientation.hh"

#include <cmath>
#include <cstddef>

namespace hsdm {
namespace {

template <class Real>
int sign(Real x) {
    return (x > 0) - (x < 0);
}

/// A sum of doubles that do not overlap, least first: an exact number. Capacity for a 3 x 3 determinant of
/// differences (Shewchuk 1997, section 2: GROW-EXPANSION, TWO-SUM, TWO-PRODUCT).
class Expansion {
public:
    Expansion() = default;
    static Expansion difference(double a, double b) {
        Expansion result;
        result.add(a);
        result.add(-b);
        return result;
    }

    void add(double x) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const double sum = x + terms_[i], virtual_term = sum - x;
            const double error = (x - (sum - virtual_term)) + (terms_[i] - virtual_term);
            if (error != 0) terms_[kept++] = error;
            x = sum;
        }
        if (x != 0) terms_[kept++] = x;
        size_ = kept;
    }
    void add(const Expansion& other, double factor = 1) {
        for (std::size_t i = 0; i < other.size_; ++i) add(factor * other.terms_[i]); // factor is 1 or -1
    }
    friend Expansion operator*(const Expansion& a, const Expansion& b) {
        Expansion result;
        for (std::size_t i = 0; i < a.size_; ++i)
            for (std::size_t j = 0; j < b.size_; ++j) {
                const double product = a.terms_[i] * b.terms_[j];
                result.add(std::fma(a.terms_[i], b.terms_[j], -product));
                result.add(product);
            }
        return result;
    }
    int sign() const { return size_ == 0 ? 0 : hsdm::sign(terms_[size_ - 1]); }

private:
    std::array<double, 192> terms_; // 3 * (2 + 2 factors of 2 terms: 2 * 8 = 16, times 2 and doubled: 64)
    std::size_t size_ = 0;
};

/// a * b - c * d
Expansion cross(const Expansion& a, const Expansion& b, const Expansion& c, const Expansion& d) {
    Expansion result = a * b;
    result.add(c * d, -1);
    return result;
}

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    std::array<Expansion, 3> u, v, w;
    for (unsigned k = 0; k < 3; ++k) {
        u[k] = Expansion::difference(b[k], a[k]);
        v[k] = Expansion::difference(c[k], a[k]);
        w[k] = Expansion::difference(d[k], a[k]);
    }
    Expansion determinant = cross(u[0], v[1], u[1], v[0]) * w[2];
    determinant.add(cross(u[1], v[2], u[2], v[1]) * w[0]);
    determinant.add(cross(u[2], v[0], u[0], v[2]) * w[1]);
    return determinant.sign();
}

/// The sign if arithmetic in Real can tell it, else 2. The bound is that of Shewchuk's orient3d.
template <class Real>
int filtered_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    std::array<Real, 3> u, v, w;
    for (unsigned k = 0; k < 3; ++k) {
        u[k] = static_cast<Real>(b[k]) - static_cast<Real>(a[k]);
        v[k] = static_cast<Real>(c[k]) - static_cast<Real>(a[k]);
        w[k] = static_cast<Real>(d[k]) - static_cast<Real>(a[k]);
    }
    const Real xy = u[0] * v[1], yx = u[1] * v[0], yz = u[1] * v[2], zy = u[2] * v[1], zx = u[2] * v[0],
               xz = u[0] * v[2];
    const Real determinant = (xy - yx) * w[2] + (yz - zy) * w[0] + (zx - xz) * w[1];
    const Real permanent = (std::abs(xy) + std::abs(yx)) * std::abs(w[2])
                           + (std::abs(yz) + std::abs(zy)) * std::abs(w[0])
                           + (std::abs(zx) + std::abs(xz)) * std::abs(w[1]);
    constexpr Real epsilon = std::numeric_limits<Real>::epsilon() / 2;
    if (std::abs(determinant) > (7 + 56 * epsilon) * epsilon * permanent) return sign(determinant);
    return permanent == 0 ? 0 : 2; // a difference is zero only if it is so exactly
}

} // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    int side = filtered_orientation<double>(a, b, c, d);
    if (side == 2) side = filtered_orientation<long double>(a, b, c, d);
    return side == 2 ? exact_orientation(a, b, c, d) : side;
}

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    constexpr double epsilon = std::numeric_limits<double>::epsilon() / 2;
    const double determinant = left - right, permanent = std::abs(left) + std::abs(right);
    if (std::abs(determinant) > (3 + 16 * epsilon) * epsilon * permanent) return sign(determinant);
    if (permanent == 0) return 0;
    return cross(Expansion::difference(a[0], c[0]), Expansion::difference(b[1], c[1]),
                 Expansion::difference(a[1], c[1]), Expansion::difference(b[0], c[0]))
        .sign();
}

} // namespace hsdm
