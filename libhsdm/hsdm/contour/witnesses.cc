#include "hsdm/contour/witnesses.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/surrounding.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {

/// The tube that a ring of vertices makes along an axis.
class Witnesses::Tube {
public:
    /// About the ring's own axis, unless another is given.
    Tube(const PolygonMesh& mesh, std::span<const Index> ring, double reach, const Vec3& axis = Vec3(0, 0, 0))
        : reach_(reach) {
        std::vector<Vec3> corners;
        for (const Index v : ring) corners.push_back(mesh.positions[v]);
        for (const Vec3& p : corners) centre_ += p;
        centre_ /= static_cast<double>(ring.size());
        axis_ = unit(axis.sqrnorm() > 0 ? axis : area_vector(corners));
        const Vec3 out = corners[0] - centre_;
        across_[0] = unit(out - (out | axis_) * axis_);
        across_[1] = axis_ % across_[0];
        for (const Vec3& p : corners) outline_.push_back(on_disc(p));
    }

    double reach() const { return reach_; }
    /// Of the ring, seen along the axis.
    double length() const {
        double sum = 0;
        for (std::size_t i = 0; i < outline_.size(); ++i) {
            const auto &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
            sum += std::hypot(a[0] - b[0], a[1] - b[1]);
        }
        return sum;
    }
    const Vec3& axis() const { return axis_; }
    const Vec3& centre() const { return centre_; }
    double along(const Vec3& p) const { return (p - centre_) | axis_; }
    double angle_of(const Vec3& p) const { return turn_of(p - centre_); }
    double turn_of(const Vec3& d) const { return std::atan2(d | across_[1], d | across_[0]); }
    /// Across the axis, from it to a point.
    Vec3 out_to(const Vec3& p) const { return p - centre_ - along(p) * axis_; }
    /// The largest distance of the ring from the axis.
    double width() const {
        double widest = 0;
        for (const auto& [x, y] : outline_) widest = std::max(widest, std::hypot(x, y));
        return widest;
    }

    bool holds(const Vec3& p) const {
        if (std::abs(along(p)) > reach_) return false;
        const auto [x, y] = on_disc(p);
        bool inside = false; // a ray from there crosses the outline an odd number of times
        for (std::size_t i = 0; i < outline_.size(); ++i) {
            const auto& a = outline_[i];
            const auto& b = outline_[(i + 1) % outline_.size()];
            if ((a[1] > y) != (b[1] > y) && x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]))
                inside = !inside;
        }
        return inside;
    }

private:
    std::array<double, 2> on_disc(const Vec3& p) const {
        return {(p - centre_) | across_[0], (p - centre_) | across_[1]};
    }

    double reach_;
    Vec3 centre_{0, 0, 0}, axis_{0, 0, 0};
    std::array<Vec3, 2> across_;
    std::vector<std::array<double, 2>> outline_; ///< of the ring, about its centre
};

bool Witnesses::speak_for(Index f) const {
    const auto facet = mesh_.facet(f);
    const Vec3 normal = unit(area_vector(mesh_, facet));
    const Vec3 centre = centroid(mesh_, facet);
    std::vector<std::pair<double, Index>> near; // squared distances and points
    const auto gather = [&](Index v) {
        for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p)
            if (!octree_.is_completed(p)) near.emplace_back((octree_.positions[p] - centre).sqrnorm(), p);
    };
    const Index own = voxel_of(facet[0]);
    gather(own);
    for_neighbors(level_, own, gather);
    const std::size_t count = std::min(near.size(), handles::witnesses);
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    const double gap = handles::speaking_gap * level_.voxel_size;
    std::size_t agree = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const Index p = near[k].second;
        agree += (octree_.normals[p] | normal) > angles::facing
                 && std::abs(octree_.normals[p] | (octree_.positions[p] - centre)) < gap;
    }
    return agree >= two_agree;
}

std::vector<Index> Witnesses::voxels_at(std::span<const Index> ring) const {
    std::vector<Index> all;
    for (const Index v : ring) {
        all.push_back(voxel_of(v));
        for_neighbors(level_, voxel_of(v), [&](Index w) { all.push_back(w); });
    }
    sort_unique(all);
    return all;
}

Vec3 Witnesses::axis_across(const Tube& tube, std::span<const Index> voxels) const {
    Vec3 sum(0, 0, 0);
    std::size_t count = 0;
    for_points(voxels, [&](Index p) {
        const Vec3& normal = octree_.normals[p];
        const double cosine = normal | tube.axis();
        if (std::abs(cosine) < angles::halfway || !tube.holds(octree_.positions[p])) return;
        sum += cosine > 0 ? normal : -normal;
        ++count;
    });
    return count >= two_agree ? sum : Vec3(0, 0, 0);
}

bool Witnesses::face_away(const Tube& tube, std::span<const Index> facets) const {
    double away = 0;
    for (const Index f : facets)
        away += area_vector(mesh_, mesh_.facet(f)) | tube.out_to(centroid(mesh_, mesh_.facet(f)));
    return away > 0;
}

bool Witnesses::deny(std::span<const Index> ring, std::span<const Index> beside) const {
    const double reach = surrounding::reach_along * level_.voxel_size;
    const std::vector<Index> voxels = voxels_at(ring);
    const Vec3 axis = axis_across(Tube(mesh_, ring, reach), voxels); // the ring may stand askew
    if (!(axis.sqrnorm() > 0) || has_completed(voxels)) return false;
    const Tube tube(mesh_, ring, reach, axis);
    const double farthest = tube.width() + handles::beside_ring * level_.voxel_size;
    double below = -reach, above = reach;      // the stretch
    std::array<std::vector<double>, 2> across; // by the way they face
    for_points(voxels, [&](Index p) {
        const Vec3& at = octree_.positions[p];
        const double along = tube.along(at);
        const double cosine = octree_.normals[p] | tube.axis();
        if (std::abs(cosine) >= angles::halfway) {
            if (tube.holds(at)) across[cosine > 0].push_back(along);
        } else if (tube.out_to(at).norm() < farthest) {
            (along < 0 ? below : above) = along < 0 ? std::max(below, along) : std::min(above, along);
        }
    });
    const bool facing = face_away(tube, beside);
    double first = above, last = below; // of the sides of a gap, or of a wall
    for (const double t : across[facing])
        if (t > below) first = std::min(first, t);
    for (const double t : across[!facing])
        if (t < above) last = std::max(last, t);
    const double near = handles::beside_ring * level_.voxel_size; // the ring may lie at one end
    const double h = spacing(points_in(voxels), voxels.size());
    return first < last && first < near && last > -near && above - below > h
           && tube.length() * (above - below) > handles::least_missing * h * h;
}

bool Witnesses::surround(std::span<const Index> ring) const {
    const Tube tube(mesh_, ring, surrounding::reach_along * level_.voxel_size);
    const double farthest = tube.width() + handles::beside_ring * level_.voxel_size;
    std::array<std::vector<double>, 2> places, normals; // of those that face the axis, that face away from it
    for_points(voxels_at(ring), [&](Index p) {
        const Vec3 out = tube.out_to(octree_.positions[p]);
        const double length = out.norm();
        if (!(length > 0) || length > farthest || std::abs(tube.along(octree_.positions[p])) > tube.reach())
            return;
        const double cosine = (octree_.normals[p] | out) / length;
        if (std::abs(cosine) < angles::halfway) return;
        places[cosine > 0].push_back(tube.angle_of(octree_.positions[p]));
        normals[cosine > 0].push_back(tube.turn_of(octree_.normals[p]));
    });
    const std::size_t most = places[0].size() < places[1].size();
    return stand_round(places[most]) && wide_gaps(normals[most]) < 2; // else the two sides of a wall or gap
}

auto Witnesses::sheets_across(const Tube& tube, std::span<const Index> voxels, bool facing) const
    -> std::vector<Across> {
    std::vector<Across> result;
    for_points(voxels, [&](Index p) {
        const double cosine = octree_.normals[p] | tube.axis();
        if (std::abs(cosine) >= angles::halfway)
            result.push_back({octree_.positions[p], (cosine > 0) == facing});
    });
    return result;
}

bool Witnesses::has_sheets(const Tube& tube, std::span<const Across> across, const Vec3& place,
                           double beside) {
    double first = tube.reach(), last = -tube.reach(); // along the axis
    for (const auto& [at, is_first] : across) {
        const Vec3 off = at - place;
        const double along = off | tube.axis();
        if (std::abs(along) > tube.reach() || !((off - along * tube.axis()).norm() < beside)) continue;
        if (is_first)
            first = std::min(first, along);
        else
            last = std::max(last, along);
    }
    return first < last;
}

bool Witnesses::are_missing_across(std::span<const Index> ring, std::span<const Index> beside) const {
    const std::vector<Index> voxels = voxels_at(ring);
    if (has_completed(voxels)) return false;
    // The ring may lie at one end of what it goes round.
    const Tube tube(mesh_, ring, 2 * surrounding::reach_along * level_.voxel_size);
    const std::vector<Across> across = sheets_across(tube, voxels, face_away(tube, beside));
    const double h = spacing(points_in(voxels), voxels.size());
    double bare = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) { // triangles from the middle to the ring's edges
        const Vec3 &a = mesh_.positions[ring[i]], &b = mesh_.positions[ring[(i + 1) % ring.size()]];
        const Vec3 place = (a + b + tube.centre()) / 3;
        if (!has_sheets(tube, across, place, handles::beside_place * h))
            bare += ((a - tube.centre()) % (b - tube.centre())).norm(); // of both discs
    }
    return bare > handles::least_missing * h * h;
}

bool Witnesses::is_narrow(std::span<const Index> ring) const {
    const double width = Tube(mesh_, ring, 0).width();
    if (width >= level_.voxel_size) return false; // no voxel around is empty
    const std::vector<Index> voxels = voxels_at(ring);
    return width < spacing(points_in(voxels), voxels.size());
}

bool Witnesses::has_completed(std::span<const Index> voxels) const {
    return std::ranges::any_of(voxels, [&](Index v) {
        for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p)
            if (octree_.is_completed(p)) return true;
        return false;
    });
}

std::size_t Witnesses::points_in(std::span<const Index> voxels) const {
    std::size_t points = 0;
    for (const Index v : voxels) points += level_.first_point[v + 1] - level_.first_point[v];
    return points;
}

double Witnesses::spacing_at(Index vertex) const {
    const Index v = voxel_of(vertex);
    return spacing(level_.first_point[v + 1] - level_.first_point[v], 1);
}

double Witnesses::spacing(std::size_t points, std::size_t voxels) const {
    return level_.voxel_size * std::sqrt(static_cast<double>(voxels) / static_cast<double>(points));
}

} // namespace hsdm
