#include "hsdm/simplify/strips.hh"

#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/simplify/constants.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hsdm {
namespace {

// half the height that a parabola spans, over its root mean square about its mean: sqrt(45) / 4
constexpr double half_of_rms = 1.677;
constexpr double rise_of_mean = 1.0 / 3; // distance of its mean height from the middle one, in such halves

/// Sums over the facets of a strip: for their plane and its error.
struct StripSum {
    Vec3 area{0, 0, 0}, moment{0, 0, 0};
    double squares[6] = {0, 0, 0, 0, 0, 0}; // xx, xy, xz, yy, yz, zz
    double weight = 0;

    void add(const Vec3& facet_area, const Vec3& at) {
        const double w = facet_area.norm();
        area += facet_area;
        moment += at * w;
        weight += w;
        std::size_t k = 0;
        for (unsigned i = 0; i < 3; ++i)
            for (unsigned j = i; j < 3; ++j) squares[k++] += w * at[i] * at[j];
    }

    /// Root mean square distance from a plane through the mean.
    double rms(const Plane& plane) const {
        const Vec3& n = plane.normal;
        const double square =
            squares[0] * n[0] * n[0] + squares[3] * n[1] * n[1] + squares[5] * n[2] * n[2]
            + 2 * (squares[1] * n[0] * n[1] + squares[2] * n[0] * n[2] + squares[4] * n[1] * n[2]);
        return std::sqrt(std::max(0.0, square / weight - plane.offset * plane.offset));
    }
};

class Cutting {
public:
    Cutting(const FacetField& field, const DevelopableRegion& region)
        : field_(field), region_(region), share_(region.facets.size()) {
        double lo = std::numeric_limits<double>::max(), hi = -lo;
        for (Index f : region.facets) {
            sum_ += field.area[f];
            all_area_ += field.area[f].norm();
            origin_ += field.centre[f];
            lo = std::min(lo, region.axis.direction | field.centre[f]);
            hi = std::max(hi, region.axis.direction | field.centre[f]);
        }
        const auto count = static_cast<double>(share_.size());
        origin_ /= count;
        facets_along_ = (hi - lo) / std::sqrt(0.5 * all_area_ / count);
        find_shares();
    }

    std::optional<Strips> run(double tolerance) {
        std::size_t m = 1;
        // Numbers of strips that are tried: each is larger than the one before.
        for (int tries = 0; tries < enough_rounds && resolves(m); ++tries) {
            const double missed = cut(m);
            if (missed <= tolerance) return std::move(strips_);
            // The height that an arc spans grows with the square of its length.
            const double growth =
                std::min(strips::growth * std::sqrt(missed / tolerance), most_growth(missed));
            m = std::max(m + 1, static_cast<std::size_t>(growth * static_cast<double>(m)));
        }
        return std::nullopt;
    }

private:
    /// Per facet, its position round the axis, 0 to 1, by the direction of its normal, weighted so that
    /// strips of equal shares span equal heights. An arc of angle a and radius r spans r a^2 / 8, so shares
    /// grow with the square root of r, the length per angle.
    void find_shares() {
        const Vec3& axis = region_.axis.direction;
        Vec3 x = sum_ - axis * (axis | sum_);
        if (x.norm() < strips::least_lean * all_area_) { // normals all round: start anywhere
            Vec3 other(0, 0, 0);
            other[least_component(axis)] = 1;
            x = axis % other;
        }
        x = unit(x);
        const Vec3 y = axis % x;
        for (std::size_t i = 0; i < share_.size(); ++i) {
            const Vec3& normal = field_.mean_normal[region_.facets[i]];
            share_[i] = std::atan2(normal | y, normal | x) / strips::bin_width;
        }
        const auto [least, most] = std::minmax_element(share_.begin(), share_.end());
        const double first = *least;
        std::vector<double> until(2 + static_cast<std::size_t>(*most - first), 0);
        for (std::size_t i = 0; i < share_.size(); ++i)
            until[1 + static_cast<std::size_t>(share_[i] - first)] += field_.area[region_.facets[i]].norm();
        for (std::size_t k = 1; k < until.size(); ++k) until[k] = until[k - 1] + std::sqrt(until[k]);
        for (double& share : share_) {
            const auto k = static_cast<std::size_t>(share - first);
            const double in_bin = share - first - static_cast<double>(k);
            share = (until[k] + (until[k + 1] - until[k]) * in_bin) / until.back();
        }
    }

    static unsigned least_component(const Vec3& v) {
        unsigned least = 0;
        for (unsigned k = 1; k < 3; ++k)
            if (std::abs(v[k]) < std::abs(v[least])) least = k;
        return least;
    }

    /// Largest growth of the number of strips in one try; small if the last strips turned too far, which says
    /// nothing about the number needed.
    static double most_growth(double missed) { return std::isfinite(missed) ? 1000 : strips::blind_growth; }

    bool resolves(std::size_t m) const {
        // vertices cannot follow lines closer than the fine mesh's own
        return facets_along_ * static_cast<double>(m) <= static_cast<double>(share_.size());
    }

    /// Cuts into m strips; returns half of the height that the worst strip spans across its plane.
    double cut(std::size_t m) {
        strips_ = {std::vector<Index>(share_.size()), std::vector<Plane>(m)};
        for (std::size_t i = 0; i < share_.size(); ++i)
            strips_.of[i] = static_cast<Index>(
                std::min(m - 1, static_cast<std::size_t>(share_[i] * static_cast<double>(m))));
        for (int round = 0; round < strips::rounds; ++round) {
            fit_planes();
            take_over();
        }
        return fit_planes();
    }

    double fit_planes() {
        std::vector<StripSum> sums(strips_.planes.size());
        for (std::size_t i = 0; i < share_.size(); ++i) {
            const Index f = region_.facets[i];
            sums[strips_.of[i]].add(field_.area[f], field_.centre[f] - origin_);
        }
        const auto& [axis, cosine, deviation] = region_.axis;
        double missed = 0;
        for (std::size_t k = 0; k < sums.size(); ++k) {
            if (!(sums[k].weight > 0)) continue;
            Plane& plane = strips_.planes[k];
            const Vec3& area = sums[k].area;
            if (area.norm() < angles::halfway * sums[k].weight)
                missed = std::numeric_limits<double>::infinity();
            const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
            plane.normal = axis * cosine + unit(area - axis * (axis | area)) * sine;
            plane.offset = (plane.normal | sums[k].moment) / sums[k].weight;
            const double half = half_of_rms * sums[k].rms(plane);
            missed = std::max(missed, half);
            plane.offset += (plane.normal | origin_) - outward() * half * rise_of_mean;
        }
        return missed;
    }

    double outward() const { return region_.convex ? 1 : -1; }

    /// Moves each facet to that of its strip's plane and the two beside it that it is farthest outside of
    /// (inside of, if the region is concave), so that strips meet where their planes do.
    void take_over() {
        const std::size_t m = strips_.planes.size();
        for (std::size_t i = 0; i < share_.size(); ++i) {
            const Index f = region_.facets[i];
            const std::size_t was = strips_.of[i];
            double highest = std::numeric_limits<double>::lowest();
            for (const std::size_t k : {(was + m - 1) % m, was, (was + 1) % m}) {
                const Plane& plane = strips_.planes[k];
                if ((plane.normal | field_.mean_normal[f]) < angles::halfway) continue;
                const double height = outward() * plane.height(field_.centre[f]);
                if (height > highest) {
                    highest = height;
                    strips_.of[i] = static_cast<Index>(k);
                }
            }
        }
    }

    const FacetField& field_;
    const DevelopableRegion& region_;
    std::vector<double> share_;           // per facet, its position round the region
    Vec3 sum_{0, 0, 0}, origin_{0, 0, 0}; // sum of area vectors; mean of the facets' centres
    double all_area_ = 0;                 // sum of the area vectors' lengths
    double facets_along_ = 0;             // length of the region along the axis, in facets
    Strips strips_;
};

} // namespace

std::optional<Strips> cut_to_strips(const FacetField& field, const DevelopableRegion& region,
                                    double tolerance) {
    return Cutting(field, region).run(tolerance);
}

} // namespace hsdm
