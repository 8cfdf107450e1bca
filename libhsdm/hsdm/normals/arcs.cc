#include "hsdm/normals/arcs.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/arc_support.hh"
#include "hsdm/normals/constants.hh"

#include <algorithm>
#include <array>

namespace hsdm {
namespace {

/// A point's neighbours, and how many of them planes and arcs through it explain.
class Arcs {
public:
    Arcs(const Octree& octree, const Neighbors& neighbors, const EstimatedNormals& estimate, Index i)
        : points_(neighbors.of(i)) {
        around_.count = points_.size();
        around_.inverse_tolerance = 1 / estimate.tolerance[i];
        for (std::size_t k = 0; k < around_.count; ++k) {
            around_.normals[k] = estimate.normals[points_[k]];
            around_.offsets[k] = octree.positions[points_[k]] - octree.positions[i];
            around_.rises[k] = around_.normals[k] | around_.offsets[k];
        }
    }

    /// Turns the point's normal if arcs explain clearly more neighbours than planes; returns whether they do.
    bool settle(Vec3& own) const {
        ArcCandidates candidates;
        candidates.add(own);
        for (std::size_t k = 0; k < around_.count; ++k) candidates.add(carried_over(k));
        ArcSupport support;
        support_by_arcs(around_, candidates, support);
        double plane = 0, arc = 0;
        std::size_t best = 0;
        for (std::size_t k = 0; k < candidates.count; ++k) {
            plane = std::max(plane, support.plane[k]);
            if (support.arc[k] > arc) arc = support.arc[k], best = k;
        }
        if (!(arc > arcs::clear_gain * plane)) return false;
        own = halfway(candidates[best]);
        return true;
    }

    /// Are most of the neighbours that arcs explain on arcs themselves?
    bool is_backed(const Vec3& own, const std::vector<std::uint8_t>& is_arc) const {
        double backing = 0, all = 0;
        for (std::size_t k = 0; k < around_.count; ++k) {
            const double weight = weight_of(own, k);
            all += weight;
            if (is_arc[points_[k]]) backing += weight;
        }
        return backing > 0.5 * all;
    }

private:
    /// The mirror image of a neighbour's normal in the plane halfway: on an arc it is that at the point.
    Vec3 carried_over(std::size_t k) const {
        const Vec3& d = around_.offsets[k];
        const double square = d.sqrnorm();
        return square > 0 ? around_.normals[k] - d * (2 * around_.rises[k] / square) : around_.normals[k];
    }

    /// What a neighbour adds to the support of an arc.
    double weight_of(const Vec3& normal, std::size_t k) const {
        const double cosine = std::max(0.0, normal | around_.normals[k]);
        const double u = around_.inverse_tolerance * ((normal | around_.offsets[k]) + around_.rises[k]);
        const double near = std::max(0.0, 1 - u * u / (2 + 2 * cosine));
        return cosine * near * near;
    }

    /// Half of the way to the normal by which the neighbours lie on arcs best: neighbours that all lean alike
    /// would swing for ever on the whole of it.
    Vec3 halfway(const Vec3& normal) const {
        const Vec3 u = normal.cross(std::abs(normal[0]) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)).normalized();
        const Vec3 v = normal.cross(u);
        double uu = 0, uv = 0, vv = 0, ur = 0, vr = 0;
        for (std::size_t k = 0; k < around_.count; ++k) {
            const Vec3& d = around_.offsets[k];
            const double w = weight_of(normal, k) / (2 + 2 * std::max(0.0, normal | around_.normals[k]));
            const double x = u | d, y = v | d, rise = (normal | d) + around_.rises[k];
            uu += w * x * x, uv += w * x * y, vv += w * y * y, ur += w * x * rise, vr += w * y * rise;
        }
        const double det = uu * vv - uv * uv;
        if (!(det > 1e-3 * uu * vv)) return normal; // all in a line: they say nothing of the turn round it
        return (normal - (u * (vv * ur - uv * vr) + v * (uu * vr - uv * ur)) * (0.5 / det)).normalized();
    }

    std::span<const Index> points_; // the neighbours
    ArcNeighbors around_;
};

class Bending {
public:
    Bending(const Octree& octree, const Neighbors& neighbors, EstimatedNormals& estimate)
        : octree_(octree), neighbors_(neighbors), estimate_(estimate) {}

    void run() {
        const std::vector<Index> candidates = creased();
        std::vector<Vec3> planes(candidates.size());
        for_each_index(candidates.size(), chunks::light,
                       [&](Index c) { planes[c] = estimate_.normals[candidates[c]]; });
        is_arc_ = large_vector<std::uint8_t>(octree_.size(), 0);
        is_turned_ = large_vector<std::uint8_t>(octree_.size(), 1);
        std::vector<Index> active = candidates;
        for (int round = 0; round < arcs::rounds && !active.empty(); ++round) {
            settle(active);
            active = beside_turned(candidates);
        }
        restore_unbacked(candidates, planes);
    }

private:
    /// Bent points beside a crease, or on what is as round.
    std::vector<Index> creased() const {
        return chosen(estimate_.bent, [&](Index i, Index j) {
            return (estimate_.normals[i] | estimate_.normals[j]) < angles::smooth;
        });
    }
    std::vector<Index> beside_turned(const std::vector<Index>& points) const {
        return chosen(points, [&](Index i, Index j) { return is_turned_[i] != 0 || is_turned_[j] != 0; });
    }
    /// The points with a neighbour of which that is true.
    template <class Chooses>
    std::vector<Index> chosen(const std::vector<Index>& points, const Chooses& chooses) const {
        return collected<Index>(
            points.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::vector<Index>& part) {
                for (std::size_t p = begin; p < end; ++p)
                    if (std::ranges::any_of(neighbors_.of(points[p]),
                                            [&](Index j) { return chooses(points[p], j); }))
                        part.push_back(points[p]);
            });
    }

    void settle(const std::vector<Index>& active) {
        std::vector<Vec3> settled(active.size());
        for_each_index(active.size(), chunks::heavy, [&](Index a) {
            settled[a] = estimate_.normals[active[a]];
            is_arc_[active[a]] = Arcs(octree_, neighbors_, estimate_, active[a]).settle(settled[a]);
        });
        std::ranges::fill(is_turned_, 0);
        for_each_index(active.size(), chunks::light, [&](Index a) {
            Vec3& normal = estimate_.normals[active[a]];
            is_turned_[active[a]] = (normal | settled[a]) < arcs::still;
            normal = settled[a];
        });
    }

    void restore_unbacked(const std::vector<Index>& candidates, const std::vector<Vec3>& planes) {
        std::vector<std::uint8_t> is_lone(candidates.size());
        for_each_index(candidates.size(), chunks::heavy, [&](Index c) {
            const Index i = candidates[c];
            is_lone[c] = is_arc_[i] != 0
                         && !Arcs(octree_, neighbors_, estimate_, i).is_backed(estimate_.normals[i], is_arc_);
        });
        for (std::size_t c = 0; c < candidates.size(); ++c)
            if (is_lone[c]) estimate_.normals[candidates[c]] = planes[c];
    }

    const Octree& octree_;
    const Neighbors& neighbors_;
    EstimatedNormals& estimate_;
    std::vector<std::uint8_t> is_arc_, is_turned_; // per point
};

} // namespace

void bend_to_arcs(const Octree& octree, const Neighbors& neighbors, EstimatedNormals& estimate) {
    if (!(estimate.noise > estimation::rough)) Bending(octree, neighbors, estimate).run();
}

} // namespace hsdm
