#include "hsdm/normals/estimate_normals.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/eight_fits.hh"
#include "hsdm/normals/neighborhood.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/normals/plane_fit.hh"
#include "hsdm/normals/plane_support.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

using EightPoints = std::array<Index, EightOffsets::lanes>;

/// The first eight of some points; where there are fewer, the last one several times.
EightPoints eight_of(const Index* first, std::size_t count) {
    EightPoints points;
    for (std::size_t lane = 0; lane < points.size(); ++lane) points[lane] = first[std::min(lane, count - 1)];
    return points;
}

void gather(const Octree& octree, const Neighbors& neighbors, const EightPoints& points,
            EightOffsets& offsets) {
    offsets.count = neighbors.count;
    for (std::size_t lane = 0; lane < points.size(); ++lane) {
        const Vec3 at = octree.positions[points[lane]];
        const auto around = neighbors.of(points[lane]);
        for (std::size_t k = 0; k < around.size(); ++k)
            offsets.set(k, lane, octree.positions[around[k]] - at);
    }
}

/// Computes new normals from old ones, whose signs do not matter.
class Renewal {
public:
    /// The normals in `estimate` are not used.
    Renewal(const Octree& octree, const Neighbors& neighbors, const EstimatedNormals& estimate,
            const std::vector<Vec3>& normals)
        : octree_(octree), neighbors_(neighbors), estimate_(estimate), normals_(normals) {}

    bool differs(Index i, double cosine) const {
        const auto around = neighbors_.of(i);
        return std::any_of(around.begin(), around.end(),
                           [&](Index j) { return std::abs(normals_[i] | normals_[j]) < cosine; });
    }

    /// The mean over the neighbours whose planes pass through the point; flat ones count most.
    Vec3 averaged(Index i) const {
        const Vec3& own = normals_[i];
        const Neighborhood around(octree_, neighbors_, i);
        const double inverse = 1 / estimate_.tolerance[i];
        Vec3 sum = estimation::own_weight * own;
        for (std::size_t k = 0; k < around.size(); ++k) {
            const Vec3& other = normals_[around.point(k)];
            const double cosine = own | other;
            const double weight = agreement(cosine) * closeness(other | around.offset(k), inverse)
                                  * closeness(estimate_.spread[around.point(k)], inverse);
            sum += other * (cosine < 0 ? -weight : weight);
        }
        return sum.sqrnorm() > 0 ? sum.normalized() : own;
    }

    /// For points away from creases that are not too flat, the results of curve().
    std::vector<Vec3> all_curved() const {
        std::vector<Vec3> renewed = unwritten_vector<Vec3>(octree_.size());
        for_chunks(octree_.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::array<Index, chunks::slow> bent;
            std::size_t count = 0;
            for (std::size_t i = begin; i < end; ++i) {
                renewed[i] = normals_[i];
                if (may_be_curved(static_cast<Index>(i))) bent[count++] = static_cast<Index>(i);
            }
            for (std::size_t b = 0; b < count; b += EightOffsets::lanes)
                curve(eight_of(bent.data() + b, count - b), renewed);
        });
        return renewed;
    }

    /// normal_of(point) of all points.
    template <class NormalOf>
    std::vector<Vec3> all(const NormalOf& normal_of) const {
        std::vector<Vec3> renewed = unwritten_vector<Vec3>(octree_.size());
        for_each_index(octree_.size(), chunks::slow, [&](Index i) { renewed[i] = normal_of(i); });
        return renewed;
    }

private:
    bool may_be_curved(Index i) const {
        return !(estimate_.spread[i] < estimation::flat_spread * neighbors_.reach[i]
                 || normals_[i].sqrnorm() == 0 || differs(i, angles::smooth));
    }

    /// A plane has the normal of the neighbours' centroid, not of the point, where the surface is curved.
    /// Away from creases it is turned towards that of a quadratic surface: not at all up to where the tilt
    /// between the two is such that their expected errors are equal (twice what noise makes of it), as at the
    /// border of rough points, almost all of it where that is far exceeded.
    void curve(const EightPoints& points, std::vector<Vec3>& renewed) const {
        std::array<Vec3, EightOffsets::lanes> u, v;
        EightFrames frames;
        for (std::size_t lane = 0; lane < points.size(); ++lane) {
            const Vec3& own = normals_[points[lane]];
            u[lane] = own.cross(std::abs(own[0]) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)).normalized();
            v[lane] = own.cross(u[lane]);
            const double reach = neighbors_.reach[points[lane]];
            frames.set(lane, {u[lane] / reach, v[lane] / reach, own / reach});
        }
        EightOffsets offsets;
        gather(octree_, neighbors_, points, offsets);
        EightTilts tilts;
        fit_lanes().front().tilts(offsets, frames, tilts);
        for (std::size_t lane = 0; lane < points.size(); ++lane)
            renewed[points[lane]] =
                turned(normals_[points[lane]], u[lane] * tilts.tilt[0][lane] + v[lane] * tilts.tilt[1][lane],
                       tilts.variance[lane]);
    }
    static Vec3 turned(const Vec3& own, const Vec3& tilt, double variance) {
        const double square = tilt.sqrnorm();
        if (square <= 2 * variance || variance > estimation::most_variance
            || square > estimation::most_square)
            return own;
        return (own - tilt * (1 - 2 * variance / square)).normalized();
    }

    const Octree& octree_;
    const Neighbors& neighbors_;
    const EstimatedNormals& estimate_;
    const std::vector<Vec3>& normals_;
};

class Estimation {
public:
    Estimation(const Octree& octree, const Neighbors& neighbors, EstimatedNormals& result)
        : octree_(octree),
          neighbors_(neighbors),
          result_(result),
          renewal_(octree, neighbors, result, result.normals) {}

    void run(const EstimateOptions& options) {
        resize_unwritten(result_.normals, octree_.size());
        resize_unwritten(result_.tolerance, octree_.size());
        resize_unwritten(result_.spread, octree_.size());
        fit_all();
        result_.noise = options.noise ? *options.noise : estimate_noise(octree_, neighbors_);
        choose_tolerance(options);
        find_bent();
        renew(options.rounds, [this](Index i) { return best_plane(i); });
        renew(options.rounds, [this](Index i) {
            return renewal_.differs(i, angles::smooth) ? renewal_.averaged(i) : result_.normals[i];
        });
    }

private:
    void fit_all() {
        for_chunks(octree_.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
            EightOffsets offsets;
            EightPlanes planes;
            for (std::size_t i = begin; i < end; i += EightOffsets::lanes) {
                EightPoints points;
                for (std::size_t lane = 0; lane < points.size(); ++lane)
                    points[lane] = static_cast<Index>(std::min(i + lane, end - 1));
                gather(octree_, neighbors_, points, offsets);
                fit_lanes().front().planes(offsets, planes);
                for (std::size_t lane = 0; lane < points.size(); ++lane) {
                    const PlaneFit fit = planes.of(lane);
                    result_.normals[points[lane]] = fit.normal;
                    result_.spread[points[lane]] = std::sqrt(fit.variance);
                }
            }
        });
    }

    /// Chooses the tolerances; not below the spread of the flattest neighbour, because a neighbourhood that
    /// is rough throughout is no crease, and half a neighbourhood's radius at most: beyond, every plane holds
    /// all neighbours.
    void choose_tolerance(const EstimateOptions& options) {
        const double relative =
            std::clamp(options.noise_tolerance * result_.noise, options.least_tolerance, 0.5);
        for_each_index(octree_.size(), chunks::slow, [&](Index i) {
            double least = result_.spread[i];
            for (Index j : neighbors_.of(i)) least = std::min(least, result_.spread[j]);
            const double base = relative * neighbors_.reach[i];
            result_.tolerance[i] = std::clamp(least, base, estimation::most_widening * base);
        });
    }

    void find_bent() {
        result_.bent = indices_where(octree_.size(), chunks::slow, [&](Index i) {
            return result_.spread[i] > estimation::bent_spread * result_.tolerance[i];
        });
    }

    /// New normals for the bent points, in each round all from the old ones. Where neither the point's nor a
    /// neighbour's has changed in the round before, nothing does in this one.
    template <class NormalOf>
    void renew(int rounds, const NormalOf& normal_of) {
        const std::vector<Index>& bent = result_.bent;
        std::vector<Vec3> renewed = unwritten_vector<Vec3>(bent.size());
        std::vector<std::uint8_t> changed = large_vector<std::uint8_t>(octree_.size(), 0);
        const auto is_due = [&](Index i) {
            return changed[i] != 0
                   || std::ranges::any_of(neighbors_.of(i), [&](Index j) { return changed[j] != 0; });
        };
        for (int round = 0; round < rounds; ++round) {
            for_each_index(bent.size(), chunks::heavy, [&](Index b) {
                renewed[b] = round == 0 || is_due(bent[b]) ? normal_of(bent[b]) : result_.normals[bent[b]];
            });
            for_each_index(bent.size(), chunks::light, [&](Index b) {
                Vec3& normal = result_.normals[bent[b]];
                changed[bent[b]] = normal != renewed[b];
                normal = renewed[b];
            });
        }
    }

    /// How many neighbours lie on the plane with that normal through the point, or on the parallel one
    /// through the centroid, on which a bent sheet lies better: the more of the two.
    static double support(const Neighborhood& around, const Vec3& normal, double inverse) {
        std::array<double, Planes::most> rises;
        double mean = 0, through = 0;
        for (std::size_t k = 0; k < around.size(); ++k) {
            rises[k] = normal | around.offset(k);
            mean += rises[k];
            through += closeness(rises[k], inverse);
        }
        mean /= static_cast<double>(around.size() + 1);
        double centred = closeness(mean, inverse) - 1;
        for (std::size_t k = 0; k < around.size(); ++k) centred += closeness(rises[k] - mean, inverse);
        return std::max(through, centred);
    }

    Vec3 best_plane(Index i) const {
        const Vec3& own = result_.normals[i];
        if (!renewal_.differs(i, estimation::differing_cosine)) return own;
        const Neighborhood around(octree_, neighbors_, i);
        const double inverse = 1 / result_.tolerance[i];
        double most = estimation::clear_gain * support(around, own, inverse);
        Planes planes;
        planes.inverse_tolerance = inverse;
        for (std::size_t k = 0; k < around.size(); ++k)
            planes.add(result_.normals[around.point(k)], around.offset(k));
        Support found;
        near_planes(planes, found);
        const Vec3* best = &own;
        for (std::size_t k = 0; k < around.size(); ++k)
            if (found[k] > most) most = found[k], best = &result_.normals[around.point(k)];
        return best == &own ? own : refitted(around, *best, inverse);
    }

    /// Fits a plane to the neighbours that it holds, twice.
    static Vec3 refitted(const Neighborhood& around, Vec3 normal, double inverse) {
        for (int step = 0; step < repeats::twice; ++step) {
            PlaneSums sums;
            sums.add(Vec3(0, 0, 0), 1);
            for (std::size_t k = 0; k < around.size(); ++k)
                sums.add(around.offset(k), closeness(normal | around.offset(k), inverse));
            if (sums.weight < estimation::fewest) return normal;
            const PlaneFit fit = fit_plane(sums);
            if (fit.normal.sqrnorm() == 0) return normal;
            normal = fit.normal;
        }
        return normal;
    }

    const Octree& octree_;
    const Neighbors& neighbors_;
    EstimatedNormals& result_;
    Renewal renewal_;
};

void validate(const EstimateOptions& options) {
    check_option(options.least_tolerance > 0 && options.least_tolerance < 0.5, "least_tolerance",
                 options.least_tolerance, "lie in (0, 0.5)");
    check_option(options.noise_tolerance > 0, "noise_tolerance", options.noise_tolerance, "be above 0");
    check_option(options.rounds >= 0, "rounds", options.rounds, "be 0 or more");
}

} // namespace

EstimatedNormals estimate_normals(const Octree& octree, const Neighbors& neighbors,
                                  const EstimateOptions& options) {
    validate(options);
    EstimatedNormals result;
    Estimation(octree, neighbors, result).run(options);
    return result;
}

std::vector<Vec3> refined_normals(const Octree& octree, const Neighbors& neighbors,
                                  const EstimatedNormals& estimate) {
    const Renewal from_planes(octree, neighbors, estimate, estimate.normals);
    std::vector<Vec3> curved = from_planes.all_curved();
    if (!(estimate.noise > estimation::rough)) return curved;
    const Renewal from_curved(octree, neighbors, estimate, curved);
    return from_curved.all([&](Index i) { return from_curved.averaged(i); });
}

void turn_along(const std::vector<Vec3>& given, std::vector<Vec3>& normals) {
    for_each_index(normals.size(), chunks::light, [&](Index i) {
        if ((normals[i] | given[i]) < 0) normals[i] = -normals[i];
    });
}

} // namespace hsdm
