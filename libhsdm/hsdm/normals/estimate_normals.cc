#include "hsdm/normals/estimate_normals.hh"

#include "hsdm/chunks.hh"
#include "hsdm/errors.hh"
#include "hsdm/normals/plane_fit.hh"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace hsdm {
namespace {

constexpr std::size_t points_per_chunk = 1024;

/// Biweight: 1 on the plane, 0 from the tolerance on.
double closeness(double residual, double inverse_tolerance) {
    const double t = residual * inverse_tolerance, u = std::max(0.0, 1 - t * t);
    return u * u;
}

class Estimation {
public:
    Estimation(const Octree& octree, const Neighbors& neighbors, const EstimateOptions& options)
        : octree_(octree), neighbors_(neighbors), options_(options), thickness_(octree.size()) {
        result_.normals.resize(octree.size());
        result_.tolerance.resize(octree.size());
    }

    EstimatedNormals run() {
        fit_all();
        measure_noise();
        find_bent();
        choose_planes();
        for (int round = 0; round < options_.rounds; ++round) refit();
        return std::move(result_);
    }

private:
    void fit_all() {
        for_chunks(octree_.size(), points_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) {
                PlaneSums sums;
                sums.add(Vec3(0, 0, 0), 1);
                for (Index j : neighbors_.of(i)) sums.add(octree_.positions[j] - octree_.positions[i], 1);
                const PlaneFit fit = fit_plane(sums);
                result_.normals[i] = fit.normal;
                thickness_[i] = std::sqrt(fit.variance);
            }
        });
    }

    void measure_noise() {
        constexpr std::size_t samples = 1 << 14;
        std::vector<double> ratios;
        const std::size_t stride = octree_.size() / samples + 1;
        for (std::size_t i = 0; i < octree_.size(); i += stride)
            if (neighbors_.reach[i] > 0) ratios.push_back(thickness_[i] / neighbors_.reach[i]);
        if (!ratios.empty()) {
            const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 3);
            std::nth_element(ratios.begin(), middle, ratios.end());
            result_.noise = *middle;
        }
        const double relative = std::clamp(options_.noise_tolerance * result_.noise, options_.least_tolerance, 0.5);
        static const double lf = getenv("LF") ? atof(getenv("LF")) : 1;
        for_chunks(octree_.size(), points_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) {
                double least = thickness_[i];
                for (Index j : neighbors_.of(i)) least = std::min(least, thickness_[j]);
                result_.tolerance[i] = std::max(relative * neighbors_.reach[i], lf * least);
            }
        });
    }

    /// The points whose neighbours are not all of the plane through them.
    void find_bent() {
        static const double bt = getenv("BT") ? atof(getenv("BT")) : 0.45;
        std::vector<std::vector<Index>> found(chunk_count(octree_.size(), points_per_chunk));
        for_chunks(octree_.size(), points_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
            for (std::size_t i = begin; i < end; ++i)
                if (thickness_[i] > bt * result_.tolerance[i]) found[chunk].push_back(static_cast<Index>(i));
        });
        bent_ = joined(found);
        result_.refitted = bent_.size();
    }

    /// How many neighbours are of the plane with this normal through point i.
    double support(const Vec3* offsets, std::size_t count, const Vec3& normal, double inverse) const {
        double sum = 0;
        for (std::size_t k = 0; k < count; ++k) sum += closeness(normal | offsets[k], inverse);
        return sum;
    }

    template <class NormalOf>
    void for_bent(const NormalOf& normal_of) {
        std::vector<Vec3> chosen(bent_.size());
        for_chunks(bent_.size(), points_per_chunk / 4, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t b = begin; b < end; ++b) chosen[b] = normal_of(bent_[b]);
        });
        for_chunks(bent_.size(), points_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t b = begin; b < end; ++b) result_.normals[bent_[b]] = chosen[b];
        });
    }

    void choose_planes() {
        for_bent([&](Index i) {
            std::array<Vec3, 64> offsets;
            const auto around = neighbors_.of(i);
            for (std::size_t k = 0; k < around.size(); ++k)
                offsets[k] = octree_.positions[around[k]] - octree_.positions[i];
            const double inverse = 1 / result_.tolerance[i];
            Vec3 best = result_.normals[i];
            static const double gain = getenv("GAIN") ? atof(getenv("GAIN")) : 1.3;
            double own = support(offsets.data(), around.size(), best, inverse);
            double mean = 0;
            for (std::size_t k = 0; k < around.size(); ++k) mean += best | offsets[k];
            mean /= static_cast<double>(around.size() + 1);
            double moved = closeness(mean, inverse) - 1;
            for (std::size_t k = 0; k < around.size(); ++k) moved += closeness((best | offsets[k]) - mean, inverse);
            double most = gain * std::max(own, moved);
            if (most > 0.9 * static_cast<double>(around.size())) return best;
            bool switched = false;
            for (Index j : around) {
                const Vec3& candidate = result_.normals[j];
                const double s = support(offsets.data(), around.size(), candidate, inverse);
                if (s > most) most = s, best = candidate, switched = true;
            }
            return switched ? reweighted(i, best, false) : best;
        });
    }

    void refit() {
        static const double away = getenv("AWAY") ? atof(getenv("AWAY")) : 0.9;
        for_bent([&](Index i) {
            const Vec3& own = result_.normals[i];
            const auto around = neighbors_.of(i);
            const bool crease = std::any_of(around.begin(), around.end(), [&](Index j) {
                return std::abs(own | result_.normals[j]) < away;
            });
            return crease ? reweighted(i, own, true) : own;
        });
    }

    Vec3 reweighted(Index i, Vec3 normal, bool by_normals) const {
        const double inverse = 1 / result_.tolerance[i];
        for (int step = 0; step < 2; ++step) {
            PlaneSums sums;
            sums.add(Vec3(0, 0, 0), 1);
            for (Index j : neighbors_.of(i)) {
                const Vec3 d = octree_.positions[j] - octree_.positions[i];
                double w = closeness(normal | d, inverse);
                if (by_normals && w > 0) {
                    const double c = normal | result_.normals[j];
                    w *= std::max(0.0, (c * c - 0.7) / 0.3);
                }
                sums.add(d, w);
            }
            if (sums.weight < 3.5) return normal;
            const PlaneFit fit = fit_plane(sums);
            if (fit.normal.sqrnorm() < 0.5) return normal;
            normal = fit.normal;
        }
        return normal;
    }

    const Octree& octree_;
    const Neighbors& neighbors_;
    const EstimateOptions& options_;
    std::vector<double> thickness_;
    std::vector<Index> bent_;
    EstimatedNormals result_;
};

} // namespace

EstimatedNormals estimate_normals(const Octree& octree, const Neighbors& neighbors, const EstimateOptions& options) {
    return Estimation(octree, neighbors, options).run();
}

} // namespace hsdm
