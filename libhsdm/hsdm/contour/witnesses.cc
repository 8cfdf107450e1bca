#include "hsdm/contour/witnesses.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/surrounding.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/spatial/point_triangle.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hsdm {
namespace {

/// The tube round the axis of a ring of vertices, narrower than the ring itself.
class Tube {
public:
    Tube(const PolygonMesh& mesh, std::span<const Index> ring, double reach) : reach_(reach) {
        std::vector<Vec3> corners;
        for (const Index v : ring) corners.push_back(mesh.positions[v]);
        for (const Vec3& p : corners) centre_ += p;
        centre_ /= static_cast<double>(ring.size());
        axis_ = unit(area_vector(corners));
        const Vec3 out = corners[0] - centre_;
        across_[0] = unit(out - (out | axis_) * axis_);
        across_[1] = axis_ % across_[0];
        for (const Vec3& p : corners) outline_.push_back(on_disc(p));
    }

    const Vec3& axis() const { return axis_; }
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
        const double u = x / handles::share_of_ring, v = y / handles::share_of_ring;
        bool inside = false; // a ray from there crosses the outline an odd number of times
        for (std::size_t i = 0; i < outline_.size(); ++i) {
            const auto& a = outline_[i];
            const auto& b = outline_[(i + 1) % outline_.size()];
            if ((a[1] > v) != (b[1] > v) && u < a[0] + (b[0] - a[0]) * (v - a[1]) / (b[1] - a[1]))
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

/// Squared distance of a point to a facet, as a fan of triangles.
double squared_distance(const PolygonMesh& mesh, std::span<const Index> facet, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
        const PreparedTriangle triangle(mesh.positions[facet[0]], mesh.positions[facet[i]],
                                        mesh.positions[facet[i + 1]]);
        least = std::min(least, triangle.nearest(p).squared_distance);
    }
    return least;
}

} // namespace

bool Witnesses::speak_for(Index f) {
    const auto facet = mesh_.facet(f);
    const Vec3 normal = unit(area_vector(mesh_, facet));
    const Vec3 centre = centroid(mesh_, facet);
    near_.clear();
    const Index own = voxel_of(facet[0]);
    gather(own, centre);
    for_neighbors(level_, own, [&](Index v) { gather(v, centre); });
    const std::size_t count = std::min(near_.size(), nearest_asked);
    std::partial_sort(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(count), near_.end());
    std::size_t agree = 0;
    for (std::size_t k = 0; k < count; ++k)
        agree += (octree_.normals[near_[k].second] | normal) > angles::facing;
    return agree >= two_agree;
}

void Witnesses::gather(Index v, const Vec3& centre) {
    for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p)
        if (octree_.source[p] != no_index) near_.emplace_back((octree_.positions[p] - centre).sqrnorm(), p);
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

bool Witnesses::span(std::span<const Index> ring) {
    const Tube tube(mesh_, ring, surrounding::reach_along * level_.voxel_size);
    std::array<std::vector<Index>, 2> facing; // away from the ring's disc, towards it
    std::size_t aside = 0;
    for (const Index v : voxels_at(ring))
        for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p) {
            const Vec3& at = octree_.positions[p];
            if (octree_.source[p] == no_index || !tube.holds(at)) continue;
            const double cosine = octree_.normals[p] | tube.axis();
            if (std::abs(cosine) < angles::halfway)
                ++aside;
            else
                facing[(cosine > 0) != (tube.along(at) > 0)].push_back(p);
        }
    const std::vector<Index>& most = facing[facing[0].size() < facing[1].size()];
    const std::size_t others = aside + std::min(facing[0].size(), facing[1].size());
    if (most.size() < points_of_plane || handles::across_per_other * others > most.size()) return false;
    const auto unserved = std::ranges::count_if(most, [&](Index p) { return !is_served(p); });
    return 2 * static_cast<std::size_t>(unserved) >= most.size();
}

bool Witnesses::surround(std::span<const Index> ring) const {
    const Tube tube(mesh_, ring, surrounding::reach_along * level_.voxel_size);
    const double farthest = tube.width() + handles::served_within * level_.voxel_size;
    std::array<std::vector<double>, 2> places, normals; // of those that face the axis, that face away from it
    for (const Index v : voxels_at(ring))
        for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p) {
            const Vec3 out = tube.out_to(octree_.positions[p]);
            const double length = out.norm();
            if (octree_.source[p] == no_index || !(length > 0) || length > farthest
                || std::abs(tube.along(octree_.positions[p])) > surrounding::reach_along * level_.voxel_size)
                continue;
            const double cosine = (octree_.normals[p] | out) / length;
            if (std::abs(cosine) < angles::halfway) continue;
            places[cosine > 0].push_back(tube.angle_of(octree_.positions[p]));
            normals[cosine > 0].push_back(tube.turn_of(octree_.normals[p]));
        }
    const std::size_t most = places[0].size() < places[1].size();
    return places[most].size() >= 2 * points_of_plane && wide_gaps(places[most]) == 0
           && wide_gaps(normals[most]) < 2; // else the two sides of a wall or gap
}

bool Witnesses::is_narrow(std::span<const Index> ring) const {
    const double width = Tube(mesh_, ring, 0).width();
    if (width >= level_.voxel_size) return false; // no voxel around is empty
    std::size_t points = 0;
    const std::vector<Index> voxels = voxels_at(ring);
    for (const Index v : voxels) points += level_.first_point[v + 1] - level_.first_point[v];
    return width < spacing(points, voxels.size());
}

double Witnesses::spacing_at(Index vertex) const {
    const Index v = voxel_of(vertex);
    return spacing(level_.first_point[v + 1] - level_.first_point[v], 1);
}

double Witnesses::spacing(std::size_t points, std::size_t voxels) const {
    return level_.voxel_size * std::sqrt(static_cast<double>(voxels) / static_cast<double>(points));
}

bool Witnesses::is_served(Index point) {
    if (!corners_of_voxel_) {
        std::vector<Index> voxels = large_vector<Index>(mesh_.corners.size());
        for (std::size_t c = 0; c < voxels.size(); ++c) voxels[c] = voxel_of(mesh_.corners[c]);
        corners_of_voxel_.emplace(voxels, level_.size());
    }
    const Vec3 &at = octree_.positions[point], &normal = octree_.normals[point];
    const double farthest = handles::served_within * level_.voxel_size;
    const auto serves = [&](Index corner) {
        const auto next = std::upper_bound(mesh_.first.begin(), mesh_.first.end(), corner);
        const auto facet = mesh_.facet(static_cast<std::size_t>(next - mesh_.first.begin()) - 1);
        const Vec3 area = area_vector(mesh_, facet);
        return (area | normal) > angles::facing * area.norm()
               && squared_distance(mesh_, facet, at) < farthest * farthest;
    };
    bool served = false;
    const auto look = [&](Index v) {
        for (const Index c : corners_of_voxel_->of(v)) served = served || serves(c);
    };
    const auto after = std::upper_bound(level_.first_point.begin(), level_.first_point.end(), point);
    const auto own = static_cast<Index>(after - level_.first_point.begin() - 1);
    look(own);
    for_neighbors(level_, own, look);
    return served;
}

} // namespace hsdm
