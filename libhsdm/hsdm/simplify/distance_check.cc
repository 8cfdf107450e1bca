#include "hsdm/simplify/distance_check.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/hash.hh"
#include "hsdm/mesh/triangulate.hh"
#include "hsdm/simplify/border_vertices.hh"
#include "hsdm/simplify/constants.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

// share of the bound kept free for rounding, in case someone measures from the same origin in another way
constexpr double rounding = 1e-9;
constexpr std::size_t places_per_chunk = 2048;
constexpr std::size_t far_per_chunk = 64; // distances of far places take long to measure
constexpr std::size_t keys_per_chunk = 512, triangles_per_chunk = 1024;

std::array<Vec3, 3> corners_of(const PolygonMesh& mesh, const Triangle& t) {
    return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
}

/// The sides of a triangle whose places are sampled with it, not with the triangle beyond; by keys (`names`),
/// so that vertex numbers do not matter. Sides between border vertices are sampled with both.
std::array<bool, 3> sides_of(const Triangle& t, const std::vector<std::uint8_t>& border,
                             std::span<const Key> names) {
    const auto takes = [&](Index v, Index w) { return names[v] < names[w] || (border[v] && border[w]); };
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

/// The items for which is_far() is true, not testing those with keys in `near`; then sets `near` to the keys
/// of all the other items. The index of an item is its position in `keys`.
template <class IsFar>
std::vector<Index> far_of(std::vector<Key> keys, KeySet& near, const IsFar& is_far) {
    std::vector<std::vector<Index>> parts(chunk_count(keys.size(), keys_per_chunk));
    for_chunks(keys.size(), keys_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
        Index hint = no_index;
        std::vector<Vec3> scratch;
        for (auto i = static_cast<Index>(begin); i < end; ++i)
            if (!near.contains(keys[i]) && is_far(i, hint, scratch)) parts[c].push_back(i);
    });
    const std::vector<Index> far = joined(parts);
    for (Index i : far) keys[i] = no_key;
    near = KeySet(keys);
    return far;
}

} // namespace

DistanceCheck::DistanceCheck(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points,
                             double bound, double spacing)
    : fine_(fine),
      points_(points),
      bound_((1 - rounding) * bound),
      spacing_(spacing),
      cut_(triangulate(fine)),
      to_fine_(cells && cells->usable() ? SurfaceWalk(fine, cut_, *cells) : SurfaceWalk(fine, cut_)) {
    const std::vector<Key> names = place_keys(fine.positions);
    fine_vertex_keys_ = KeySet(names);
    fine_triangle_keys_ = KeySet(triangle_keys(cut_, names));
}

FarPlaces DistanceCheck::find_far(const PolygonMesh& mesh) {
    cut_ = triangulate(mesh);
    vertex_keys_ = place_keys(mesh.positions);
    const std::vector<Key> keys_before = std::exchange(triangle_keys_, triangle_keys(cut_, vertex_keys_));
    const std::optional<SurfaceWalk> before = std::move(to_mesh_);
    to_mesh_.emplace(mesh, cut_, TriangleTree::Order::given);
    if (before) follow_triangles(*before, keys_before);
    FarPlaces far{
        far_from(fine_.positions, bounds::vertex_share * bound_, near_vertex_), far_vertices(mesh), {}, {}};
    find_far_facets(mesh, far);
    return far;
}

void DistanceCheck::follow_triangles(const SurfaceWalk& before, std::span<const Key> keys_before) {
    const KeyIndex present(triangle_keys_);
    followed_.resize(keys_before.size());
    for_chunks(followed_.size(), triangles_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        Index hint = no_index;
        for (std::size_t t = begin; t < end; ++t) {
            Followed& now = followed_[t];
            now.same = present.find(keys_before[t]);
            if (now.same == no_index)
                to_mesh_->triangle_within(before.middle(static_cast<Index>(t)), bound_, hint);
            else
                hint = now.same;
            now.near = hint;
        }
    });
}

/// Indices of the places farther than `bound` from the mesh. A place that was near a triangle of the mesh
/// before is still near it if this mesh has the same triangle.
std::vector<Index> DistanceCheck::far_from(std::span<const Vec3> places, double bound,
                                           std::vector<Index>& near) const {
    near.resize(places.size(), no_index);
    std::vector<std::vector<Index>> parts(chunk_count(places.size(), places_per_chunk));
    for_chunks(places.size(), places_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
        Index hint = no_index;
        for (std::size_t i = begin; i < end; ++i) {
            if (near[i] != no_index) {
                const Followed& now = followed_[near[i]];
                near[i] = now.same;
                if (now.same != no_index) continue;
                hint = now.near;
            }
            near[i] = to_mesh_->triangle_within(places[i], bound, hint);
            if (near[i] == no_index) parts[c].push_back(static_cast<Index>(i));
        }
    });
    return joined(parts);
}

/// Vertices of the mesh farther than the bound from the fine mesh; its own vertices are on it and need no
/// test.
std::vector<Index> DistanceCheck::far_vertices(const PolygonMesh& mesh) {
    return far_of(vertex_keys_, near_vertex_keys_, [&](Index v, Index& hint, std::vector<Vec3>&) {
        return !fine_vertex_keys_.contains(vertex_keys_[v])
               && to_fine_.is_beyond(mesh.positions[v], bound_, hint);
    });
}

void DistanceCheck::find_far_facets(const PolygonMesh& mesh, FarPlaces& far) {
    const std::vector<std::uint8_t> border = border_vertices(mesh);
    std::vector<Key> keys = triangle_keys_; // which sides are sampled depends on borders too
    for (std::size_t t = 0; t < keys.size(); ++t) {
        Key at_border = 0;
        for (Index v : cut_.triangles[t]) at_border = 2 * at_border + border[v];
        if (at_border != 0) keys[t] = hash_index(keys[t] ^ at_border);
    }
    const auto far_place = [&](Index t, Index& hint, std::vector<Vec3>& places) {
        places.clear();
        add_places(corners_of(mesh, cut_.triangles[t]), sides_of(cut_.triangles[t], border, vertex_keys_),
                   spacing_, places);
        const auto far_one = std::find_if(places.begin(), places.end(), [&](const Vec3& place) {
            return to_fine_.is_beyond(place, bound_, hint);
        });
        return far_one == places.end() ? nullptr : &*far_one;
    };
    const std::vector<Index> triangles =
        far_of(std::move(keys), near_triangle_keys_, [&](Index t, Index& hint, std::vector<Vec3>& places) {
            return !fine_triangle_keys_.contains(triangle_keys_[t]) && far_place(t, hint, places);
        });
    std::vector<Vec3> places;
    for (Index t : triangles) {
        const Index facet = to_mesh_->tree().facet_of(t);
        if (!far.facets.empty() && far.facets.back() == facet) continue;
        Index hint = no_index;
        const Vec3* place = far_place(t, hint, places);
        far.facets.push_back(facet);
        far.on_facets.push_back(place ? *place : to_mesh_->middle(t));
    }
}

FarPoints DistanceCheck::find_far_points() {
    FarPoints found;
    const std::vector<Index> far = far_from(points_, bound_, near_point_);
    measure_to_fine(far);
    std::vector<Index> missed; // points that the fine mesh misses by more than the bound
    double farthest = 0;
    for (Index p : far) {
        if (const double off = off_fine_[p]; off > bound_) {
            missed.push_back(p);
            farthest = std::max(farthest, off);
        } else {
            found.points.push_back(p);
        }
    }
    found.beyond = far.size();
    found.unreachable = missed.size();
    // If the fine mesh misses points by more than the bound, such a point counts only if the mesh is farther
    // from it than the fine mesh is from any.
    std::vector<double> off(missed.size());
    for_chunks(missed.size(), far_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) off[i] = to_mesh_->tree()(points_[missed[i]]);
    });
    for (std::size_t i = 0; i < missed.size(); ++i)
        if (off[i] > farthest) found.points.push_back(missed[i]);
    return found;
}

/// Measures the distances of points from the fine mesh that no round before has measured.
void DistanceCheck::measure_to_fine(const std::vector<Index>& far) {
    if (!far.empty()) off_fine_.resize(points_.size(), -1);
    for_chunks(far.size(), far_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        Index hint = no_index;
        for (std::size_t i = begin; i < end; ++i)
            if (double& off = off_fine_[far[i]]; off < 0) off = to_fine_.distance(points_[far[i]], hint);
    });
}

} // namespace hsdm
