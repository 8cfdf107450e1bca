#include "hsdm/simplify/planar_patches.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/developable_regions.hh"
#include "hsdm/simplify/facet_field.hh"
#include "hsdm/simplify/strips.hh"

#include <algorithm>
#include <cmath>
#include <queue>

namespace hsdm {
namespace {

/// The plane fitted to facets, updated with each one added.
class GrowingPlane {
public:
    void add(const Vec3& area, const Vec3& centre) {
        const double weight = area.norm();
        area_ += area;
        moment_ += centre * weight;
        weight_ += weight;
        plane_.normal = unit(area_);
        plane_.offset = weight_ > 0 ? (plane_.normal | moment_) / weight_ : 0;
    }
    const Plane& plane() const { return plane_; }

private:
    Vec3 area_{0, 0, 0}, moment_{0, 0, 0};
    double weight_ = 0;
    Plane plane_;
};

class Patching {
public:
    Patching(const PolygonMesh& mesh, double tolerance)
        : field_(facet_field(mesh)),
          tolerance_(tolerance),
          margin_(large_vector<std::uint8_t>(mesh.facet_count())) {
        assign_large(patches_.patch, mesh.facet_count(), no_index);
    }

    PlanarPatches run() {
        find_flat_ground();
        for (const DevelopableRegion& region : find_developable_regions(field_, patches_.patch))
            add_strips(region);
        release_margins();
        return std::move(patches_);
    }

private:
    /// Grows patches of flat ground, from the flattest facets first.
    void find_flat_ground() {
        using Seed = std::pair<double, Index>;
        const auto add_flat = [&](std::size_t begin, std::size_t end, std::vector<Seed>& part) {
            for (auto f = static_cast<Index>(begin); f < end; ++f)
                if (field_.spread[f] <= flat_ground::flat_spread) part.emplace_back(field_.spread[f], f);
        };
        std::vector<Seed> seeds = collected<Seed>(field_.size(), chunks::light, add_flat);
        parallel_sort(seeds);
        // facets of cores that turned out not to be flat
        std::vector<std::uint8_t> seen = large_vector<std::uint8_t>(field_.size());
        std::vector<Index> facets;
        for_each_in_order(seeds.size(), [&](std::size_t s) {
            const Index seed = seeds[s].second;
            if (patches_.patch[seed] != no_index || seen[seed]) return;
            facets.clear();
            const Plane plane = grow_core(seed, facets);
            const std::size_t core = facets.size();
            if (core >= flat_ground::least_facets && add_margin(facets, plane)) {
                patches_.planes.push_back(plane);
                return;
            }
            for (std::size_t i = 0; i < facets.size(); ++i) {
                patches_.patch[facets[i]] = no_index;
                if (i < core)
                    seen[facets[i]] = 1;
                else
                    margin_[facets[i]] = 0;
            }
        });
    }

    /// A facet in the queue for a plane, ordered by distance, nearest first.
    struct Waiting {
        double height;
        Index facet;
        bool operator<(const Waiting& other) const {
            return height != other.height ? height > other.height : facet > other.facet;
        }
    };
    /// Keeps its memory from one plane to the next: most are small.
    struct Queue : std::priority_queue<Waiting> {
        void clear() { c.clear(); }
    };

    /// Grows the core of a patch: facets with flat surroundings that face as the plane does, so that bent
    /// margins do not tilt it.
    Plane grow_core(Index seed, std::vector<Index>& facets) {
        GrowingPlane growing;
        waiting_.clear();
        waiting_.push({0, seed});
        for (std::size_t looked_at = 0; !waiting_.empty(); ++looked_at) {
            if (looked_at % chunks::quick == 0) Interruption::poll();
            const auto [before, f] = waiting_.top();
            waiting_.pop();
            if (patches_.patch[f] != no_index) continue;
            const double height = f == seed ? 0 : std::abs(growing.plane().height(field_.centre[f]));
            if (height > flat_ground::core_share * tolerance_) continue;
            if (height > flat_ground::stale * before
                             + collapses::straight_share * flat_ground::core_share * tolerance_) {
                waiting_.push({height, f});
                continue;
            }
            patches_.patch[f] = static_cast<Index>(patches_.planes.size());
            facets.push_back(f);
            growing.add(field_.area[f], field_.centre[f]);
            field_.for_beside(f, [&](Index g) {
                if (patches_.patch[g] == no_index && field_.spread[g] <= flat_ground::flat_spread
                    && (field_.mean_normal[g] - growing.plane().normal).norm() <= flat_ground::flat_spread)
                    waiting_.push({std::abs(growing.plane().height(field_.centre[g])), g});
            });
        }
        return growing.plane();
    }

    /// Adds margins that bend away to a core, as far as its plane fits them. False if these have more than
    /// half as many facets as the core: then it is part of something round. There the margin would have three
    /// quarters of it at least, because it may be four times as far off the plane and the distance from a
    /// tangent grows with the square of the way along it.
    bool add_margin(std::vector<Index>& facets, const Plane& plane) {
        const std::size_t most = facets.size() + facets.size() / 2;
        for (std::size_t next = 0; next < facets.size() && facets.size() <= most; ++next) {
            if (next % chunks::quick == 0) Interruption::poll();
            field_.for_beside(facets[next], [&](Index g) {
                if (patches_.patch[g] != no_index || (field_.normal[g] | plane.normal) <= angles::smooth
                    || std::abs(plane.height(field_.centre[g])) > tolerance_)
                    return;
                patches_.patch[g] = static_cast<Index>(patches_.planes.size());
                margin_[g] = 1;
                facets.push_back(g);
            });
        }
        return facets.size() <= most;
    }

    void add_strips(const DevelopableRegion& region) {
        const std::optional<Strips> strips = cut_to_strips(field_, region, tolerance_);
        if (!strips) return;
        std::vector<Index> counts(strips->planes.size(), 0);
        for (Index k : strips->of) ++counts[k];
        for (std::size_t i = 0; i < region.facets.size(); ++i) {
            const Index f = region.facets[i], k = strips->of[i];
            if (counts[k] >= strips::least_facets
                && std::abs(strips->planes[k].height(field_.centre[f])) < strips::most_height * tolerance_)
                patches_.patch[f] = static_cast<Index>(patches_.planes.size()) + k;
        }
        patches_.planes.insert(patches_.planes.end(), strips->planes.begin(), strips->planes.end());
    }

    /// Takes margin facets close to facets without a patch out of theirs: vertices there need freedom.
    void release_margins() {
        std::vector<Index> released = indices_where(field_.size(), chunks::light,
                                                    [&](Index f) { return patches_.patch[f] == no_index; });
        for (int away = 0; away < surroundings::most_sides_away; ++away) {
            std::vector<Index> next;
            for_each_in_order(released.size(), [&](std::size_t i) {
                field_.for_beside(released[i], [&](Index g) {
                    if (!margin_[g] || patches_.patch[g] == no_index) return;
                    patches_.patch[g] = no_index;
                    next.push_back(g);
                });
            });
            released.swap(next);
        }
    }

    FacetField field_;
    double tolerance_;
    PlanarPatches patches_;
    Queue waiting_;
    std::vector<std::uint8_t> margin_; // per facet, was it added to a patch by add_margin()?
};

} // namespace

PlanarPatches find_planar_patches(const PolygonMesh& mesh, double tolerance) {
    return Patching(mesh, tolerance).run();
}

std::vector<Quadric> vertex_planes(const PolygonMesh& mesh) {
    const PlanarPatches none{std::vector<Index>(mesh.facet_count(), no_index), {}};
    return vertex_planes(mesh, none, 0);
}

std::vector<Quadric> vertex_planes(const PolygonMesh& mesh, const PlanarPatches& patches, double tolerance) {
    std::vector<Quadric> planes = large_vector<Quadric>(mesh.vertex_count());
    for_each_index(planes.size(), chunks::light, [&](Index v) { planes[v].add_point(mesh.positions[v]); });
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const auto ring = mesh.facet(f);
        const Vec3 area = area_vector(mesh, ring);
        const double length = area.norm(), share = length / static_cast<double>(ring.size());
        if (!(length > 0)) return;
        if (const Index p = patches.patch[f]; p != no_index) {
            for (Index v : ring) planes[v].add_shared(patches.planes[p], share);
            return;
        }
        const Vec3 centre = centroid(mesh, ring);
        for (Index v : ring) planes[v].add_plane(area / length, centre, share);
    });
    for_each_index(planes.size(), chunks::slow,
                   [&](Index v) { planes[v].drop_shared(mesh.positions[v], tolerance); });
    return planes;
}

} // namespace hsdm
