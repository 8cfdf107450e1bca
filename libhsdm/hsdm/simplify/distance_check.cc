#include "hsdm/simplify/distance_check.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/hash.hh"
#include "hsdm/mesh/triangulate.hh"
#include "hsdm/simplify/border_vertices.hh"
#include "hsdm/simplify/constants.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

// share of the bound kept free for rounding, in case someone measures from the same origin in another way
constexpr double rounding = 1e-9;
constexpr std::size_t far_per_chunk = 64; // distances of far places take long to measure

std::array<Vec3, 3> corners_of(const PolygonMesh& mesh, const Triangle& t) {
    return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
}

std::uint64_t hash_of(const Vec3& place) {
    std::uint64_t hash = 1;
    for (unsigned k = 0; k < 3; ++k) hash = hash_index(hash ^ std::bit_cast<std::uint64_t>(place[k]));
    return hash;
}

/// The sides of a triangle whose places are sampled with it, not with the triangle beyond, whatever the
/// vertices' numbers. Sides between border vertices are sampled with both.
std::array<bool, 3> sides_of(const Triangle& t, const PolygonMesh& mesh,
                             const std::vector<std::uint8_t>& border) {
    const auto takes = [&](Index v, Index w) {
        return hash_of(mesh.positions[v]) < hash_of(mesh.positions[w]) || (border[v] && border[w]);
    };
    return {takes(t[0], t[1]), takes(t[1], t[2]), takes(t[2], t[0])};
}

/// Adds sample places on a triangle in rows along its longest side, neither rows nor places farther apart
/// than `spacing`; at least the middles of the sides and one inside. On the sides only where `takes_side` is
/// true.
void add_places(const std::array<Vec3, 3>& corners, const std::array<bool, 3>& takes_side, double spacing,
                std::vector<Vec3>& places) {
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if ((corners[(k + 1) % 3] - corners[k]).sqrnorm()
            > (corners[(longest + 1) % 3] - corners[longest]).sqrnorm())
            longest = k;
    const Vec3 &a = corners[longest], &b = corners[(longest + 1) % 3], &c = corners[(longest + 2) % 3];
    const bool takes_ab = takes_side[longest], takes_bc = takes_side[(longest + 1) % 3],
               takes_ca = takes_side[(longest + 2) % 3];
    // An even number, so that middles of sides are places: those are farthest from an arc.
    const auto steps = [&](double length) {
        return 2 * std::max(1, static_cast<int>(std::ceil(length / (2 * spacing))));
    };
    const double length = (b - a).norm();
    const int rows = steps(std::max((c - a).norm(), (c - b).norm()));
    for (int r = 0; r < rows; ++r) {
        const double up = static_cast<double>(r) / rows;
        const Vec3 left = a + (c - a) * up, right = b + (c - b) * up;
        const int columns = steps(length * (1 - up));
        for (int i = 0; i <= columns; ++i) {
            // to and fro, so that each place lies beside the one before
            const int k = r % 2 == 0 ? i : columns - i;
            const bool on_left = k == 0, on_right = k == columns;
            if (r == 0 && (on_left || on_right || !takes_ab)) continue;
            if ((on_left && !takes_ca) || (on_right && !takes_bc)) continue;
            places.push_back(left + (right - left) * (static_cast<double>(k) / columns));
        }
    }
}

} // namespace

DistanceCheck::DistanceCheck(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points,
                             double bound, double spacing)
    : fine_(fine),
      points_(points),
      bound_((1 - rounding) * bound),
      spacing_(spacing),
      cut_(triangulate(fine)),
      to_fine_(cells && cells->usable() ? SurfaceWalk(fine, cut_, *cells) : SurfaceWalk(fine, cut_)) {}

void DistanceCheck::set_mesh(const PolygonMesh& mesh, const Unchanged& same) {
    const Triangulation cut_before = std::exchange(cut_, triangulate(mesh));
    const std::optional<SurfaceWalk> before = std::move(to_mesh_);
    to_mesh_.emplace(mesh, cut_, TriangleTree::Order::given);
    if (before) follow_triangles(*before, cut_before, same);
}

FarPlaces DistanceCheck::find_far(const PolygonMesh& mesh, const Unchanged& same) {
    set_mesh(mesh, same);
    FarPlaces far{far_from(fine_.positions, bounds::vertex_share * bound_, near_vertex_),
                  far_vertices(mesh, same),
                  {},
                  {}};
    find_far_facets(mesh, same, far);
    return far;
}

void DistanceCheck::follow_triangles(const SurfaceWalk& before, const Triangulation& cut_before,
                                     const Unchanged& same) {
    resize_large(followed_, cut_before.size());
    for_chunks(same.facet_now.size(), chunks::slow, [&](std::size_t f, std::size_t end, std::size_t) {
        Index hint = no_index;
        for (; f < end; ++f)
            for (Index t = cut_before.first[f]; t < cut_before.first[f + 1]; ++t) {
                Followed& now = followed_[t];
                now.same = no_index;
                if (const Index facet = same.facet_now[f]; facet != no_index)
                    now.same = hint = cut_.first[facet] + t - cut_before.first[f];
                else
                    to_mesh_->triangle_within(before.middle(t), bound_, hint);
                now.near = hint;
            }
    });
}

/// Indices of the places farther than `bound` from the mesh. A place that was near a triangle of the mesh
/// before is still near it if this mesh has the same triangle.
std::vector<Index> DistanceCheck::far_from(std::span<const Vec3> places, double bound,
                                           std::vector<Index>& near) const {
    resize_large(near, places.size(), no_index);
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Index>& far) {
        Index hint = no_index;
        for (std::size_t i = begin; i < end; ++i) {
            if (near[i] != no_index) {
                const Followed& now = followed_[near[i]];
                near[i] = now.same;
                if (now.same != no_index) continue;
                hint = now.near;
            }
            near[i] = to_mesh_->triangle_within(places[i], bound, hint);
            if (near[i] == no_index) far.push_back(static_cast<Index>(i));
        }
    };
    return collected<Index>(places.size(), chunks::usual, find);
}

/// Vertices of the mesh farther than the bound from the fine mesh; its own vertices are on it and need no
/// test.
std::vector<Index> DistanceCheck::far_vertices(const PolygonMesh& mesh, const Unchanged& same) {
    const auto is_own = [&](Index v) {
        return !mesh.origin.empty() && mesh.positions[v] == fine_.positions[mesh.origin[v]];
    };
    std::vector<std::uint8_t> near = large_vector<std::uint8_t>(mesh.vertex_count());
    for_each_index(near.size(), chunks::light, [&](Index v) {
        near[v] = is_own(v) || (same.vertex[v] != no_index && vertex_is_near_[same.vertex[v]]);
    });
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Index>& far) {
        Index hint = no_index;
        for (auto v = static_cast<Index>(begin); v < end; ++v) {
            if (near[v]) continue;
            near[v] = !to_fine_.is_beyond(mesh.positions[v], bound_, hint);
            if (!near[v]) far.push_back(v);
        }
    };
    std::vector<Index> far = collected<Index>(near.size(), chunks::heavy, find);
    vertex_is_near_ = std::move(near);
    return far;
}

void DistanceCheck::find_far_facets(const PolygonMesh& mesh, const Unchanged& same, FarPlaces& far) {
    const std::vector<std::uint8_t> border_before = std::exchange(border_, border_vertices(mesh));
    std::vector<std::uint8_t> near = large_vector<std::uint8_t>(mesh.facet_count());
    for_each_index(near.size(), chunks::light,
                   [&](Index f) { // which sides are sampled depends on borders too
                       near[f] = same.facet[f] != no_index && facet_is_near_[same.facet[f]]
                                 && std::ranges::all_of(mesh.facet(f), [&](Index v) {
                                        return border_[v] == border_before[same.vertex[v]];
                                    });
                   });
    const auto far_place = [&](Index f, Index& hint, std::vector<Vec3>& places) -> const Vec3* {
        for (Index t = cut_.first[f]; t < cut_.first[f + 1]; ++t) {
            const Triangle& triangle = cut_.triangles[t];
            places.clear();
            add_places(corners_of(mesh, triangle), sides_of(triangle, mesh, border_), spacing_, places);
            for (const Vec3& place : places)
                if (to_fine_.is_beyond(place, bound_, hint)) return &place;
        }
        return nullptr;
    };
    using OnFacet = std::pair<Index, Vec3>;
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<OnFacet>& found) {
        Index hint = no_index;
        std::vector<Vec3> places;
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
            if (near[f]) continue;
            const Vec3* const place = far_place(f, hint, places);
            near[f] = !place;
            if (place) found.emplace_back(f, *place);
        }
    };
    for (const auto& [f, place] : collected<OnFacet>(near.size(), chunks::heavy, find)) {
        far.facets.push_back(f);
        far.on_facets.push_back(place);
    }
    facet_is_near_ = std::move(near);
}

FarPoints DistanceCheck::find_far_points() {
    FarPoints found;
    const std::vector<Index> far = far_from(points_, bound_, near_point_);
    measure_to_fine(far);
    std::vector<Index> missed; // points that the fine mesh misses by more than the bound
    double farthest = 0;
    for_each_in_order(far.size(), [&](std::size_t i) {
        const Index p = far[i];
        if (const double off = off_fine_[p]; off > bound_) {
            missed.push_back(p);
            farthest = std::max(farthest, off);
        } else {
            found.points.push_back(p);
        }
    });
    found.beyond = far.size();
    found.unreachable = missed.size();
    if (!missed.empty()) found.first_unreachable = missed.front();
    // If the fine mesh misses points by more than the bound, such a point counts only if the mesh is farther
    // from it than the fine mesh is from any.
    // Nearly all are sooner seen to be nearer than measured.
    std::vector<std::uint8_t> farther(missed.size());
    for_chunks(missed.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t) {
        Index hint = no_index;
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3& place = points_[missed[i]];
            farther[i] = to_mesh_->is_beyond(place, (1 - rounding) * farthest, hint)
                         && to_mesh_->tree()(place) > farthest;
        }
    });
    for (std::size_t i = 0; i < missed.size(); ++i)
        if (farther[i]) found.points.push_back(missed[i]);
    return found;
}

/// Measures the distances of points from the fine mesh that no round before has measured.
void DistanceCheck::measure_to_fine(const std::vector<Index>& far) {
    if (!far.empty()) resize_large(off_fine_, points_.size(), -1);
    for_chunks(far.size(), far_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        Index hint = no_index;
        for (std::size_t i = begin; i < end; ++i)
            if (double& off = off_fine_[far[i]]; off < 0) off = to_fine_.distance(points_[far[i]], hint);
    });
}

} // namespace hsdm
