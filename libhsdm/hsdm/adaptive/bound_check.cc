#include "hsdm/adaptive/bound_check.hh"

#include "hsdm/chunks.hh"
#include "hsdm/facets/triangulate.hh"
#include "hsdm/quality/mix.hh"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace hsdm {
namespace {

constexpr std::size_t places_per_chunk = 2048;
constexpr std::size_t far_per_chunk = 64; // distances of places that are far take long
constexpr std::uint64_t no_key = 0;

/// Numbers that are the same for the same places.
std::vector<std::uint64_t> names_of(std::span<const Vec3> places) {
    std::vector<std::uint64_t> names(places.size());
    for_chunks(names.size(), places_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            names[i] = 1;
            for (unsigned k = 0; k < 3; ++k)
                names[i] = mix(names[i] ^ std::bit_cast<std::uint64_t>(places[i][k]));
        }
    });
    return names;
}

/// Facets are the same if their vertices are, in the same order.
std::vector<std::uint64_t> facet_keys(const PolygonMesh& mesh, std::span<const std::uint64_t> names) {
    std::vector<std::uint64_t> keys(mesh.facet_count());
    for_chunks(keys.size(), places_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t f = begin; f < end; ++f) {
            const auto ring = mesh.facet(f);
            std::size_t least = 0;
            for (std::size_t i = 1; i < ring.size(); ++i)
                if (names[ring[i]] < names[ring[least]]) least = i;
            std::uint64_t key = ring.size();
            for (std::size_t i = 0; i < ring.size(); ++i)
                key = mix(key ^ names[ring[(least + i) % ring.size()]]);
            keys[f] = key;
        }
    });
    return keys;
}

void index_keys(std::vector<std::uint64_t> keys, MortonIndex& index) {
    tbb::parallel_sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    if (!keys.empty() && keys.front() == no_key) keys.erase(keys.begin());
    index.build(keys);
}

/// Vertices at a border: each vertex of a whole fan is as often behind the one in the middle as before it.
std::vector<std::uint8_t> border_vertices(const PolygonMesh& mesh) {
    std::vector<std::int64_t> balance(mesh.vertex_count(), 0);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        Index before = ring.back();
        for (std::size_t i = 0; i < ring.size(); before = ring[i++])
            balance[ring[i]] += std::int64_t{ring[(i + 1) % ring.size()]} - std::int64_t{before};
    }
    std::vector<std::uint8_t> border(balance.size());
    std::transform(balance.begin(), balance.end(), border.begin(), [](std::int64_t b) { return b != 0; });
    return border;
}

/// Places on facets, and the facet of each.
struct FacetPlaces {
    std::vector<Vec3> at;
    std::vector<Index> facet;
};

/// A grid on a triangle, its lines no farther apart than `spacing` and in thirds at least; of its sides only
/// those are taken that the other triangle there leaves.
void add_places(const PolygonMesh& mesh, const Triangle& t, const std::vector<std::uint8_t>& border,
                double spacing, std::vector<Vec3>& places) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int n = std::max(3, static_cast<int>(std::ceil(longest / spacing)));
    const auto takes = [&](Index v, Index w) { return v < w || (border[v] && border[w]); };
    const std::array<bool, 3> takes_side{takes(t[0], t[1]), takes(t[1], t[2]), takes(t[2], t[0])};
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const int k = n - i - j;                          // weights of b, c and a
            if ((i == 0) + (j == 0) + (k == 0) > 1) continue; // a corner
            if ((j == 0 && !takes_side[0]) || (k == 0 && !takes_side[1]) || (i == 0 && !takes_side[2]))
                continue;
            places.push_back((k * a + i * b + j * c) / static_cast<double>(n));
        }
}

} // namespace

BoundCheck::BoundCheck(const PolygonMesh& fine, std::span<const Vec3> points, double bound, double spacing)
    : fine_(fine), points_(points), bound_(bound), spacing_(spacing), to_fine_(fine) {
    const std::vector<std::uint64_t> names = names_of(fine.positions);
    index_keys(names, fine_names_);
    index_keys(facet_keys(fine, names), fine_keys_);
}

FarPlaces BoundCheck::find_far(const PolygonMesh& mesh) {
    to_mesh_.emplace(mesh);
    names_ = names_of(mesh.positions);
    keys_ = facet_keys(mesh, names_);
    index_keys(keys_, present_);
    return {far_from(fine_.positions, near_vertex_), far_vertices(mesh), far_facets(mesh)};
}

/// A place that was near a facet still is if the facet has stayed: `near` keeps its key.
std::vector<Index> BoundCheck::far_from(std::span<const Vec3> places,
                                        std::vector<std::uint64_t>& near) const {
    near.resize(places.size(), no_key);
    std::vector<std::vector<Index>> parts(chunk_count(places.size(), places_per_chunk));
    for_chunks(places.size(), places_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
        for (std::size_t i = begin; i < end; ++i)
            if (present_.find(near[i]) == no_index) parts[c].push_back(static_cast<Index>(i));
    });
    const std::vector<Index> doubtful = joined(parts);
    std::vector<Vec3> at(doubtful.size());
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = places[doubtful[i]];
    const std::vector<Index> facets = to_mesh_->facets_within(at, bound_);
    std::vector<Index> far;
    for (std::size_t i = 0; i < at.size(); ++i) {
        near[doubtful[i]] = facets[i] == no_index ? no_key : keys_[facets[i]];
        if (facets[i] == no_index) far.push_back(doubtful[i]);
    }
    return far;
}

/// The fine mesh's own vertices need no look.
std::vector<Index> BoundCheck::far_vertices(const PolygonMesh& mesh) const {
    std::vector<Index> moved;
    std::vector<Vec3> at;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        if (fine_names_.find(names_[v]) != no_index) continue;
        moved.push_back(v);
        at.push_back(mesh.positions[v]);
    }
    const std::vector<Index> near = to_fine_.facets_within(at, bound_);
    std::vector<Index> far;
    for (std::size_t i = 0; i < moved.size(); ++i)
        if (near[i] == no_index) far.push_back(moved[i]);
    return far;
}

std::vector<Index> BoundCheck::far_facets(const PolygonMesh& mesh) {
    const std::vector<std::uint8_t> border = border_vertices(mesh);
    const Triangulation cut = triangulate(mesh);
    FacetPlaces places;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        if (passed_.find(keys_[f]) != no_index || fine_keys_.find(keys_[f]) != no_index) continue;
        for (Index t = cut.first[f]; t < cut.first[f + 1]; ++t)
            add_places(mesh, cut.triangles[t], border, spacing_, places.at);
        places.facet.resize(places.at.size(), static_cast<Index>(f));
    }
    const std::vector<Index> near = to_fine_.facets_within(places.at, bound_);
    std::vector<Index> far;
    std::vector<std::uint64_t> passed = keys_;
    for (std::size_t i = 0; i < near.size(); ++i) {
        if (near[i] != no_index) continue;
        if (passed[places.facet[i]] != no_key) far.push_back(places.facet[i]);
        passed[places.facet[i]] = no_key;
    }
    index_keys(passed, passed_);
    return far;
}

FarPoints BoundCheck::find_far_points() {
    FarPoints found;
    const std::vector<Index> far = far_from(points_, near_point_);
    measure_to_fine(far);
    std::vector<Index> missed; // by the fine mesh already
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
    // The largest distance of all is the fine mesh's, if that is beyond the bound.
    std::vector<double> off(missed.size());
    for_chunks(missed.size(), far_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) off[i] = (*to_mesh_)(points_[missed[i]]);
    });
    for (std::size_t i = 0; i < missed.size(); ++i)
        if (off[i] > farthest) found.points.push_back(missed[i]);
    return found;
}

/// Of points that were not measured in a round before.
void BoundCheck::measure_to_fine(const std::vector<Index>& far) {
    if (!far.empty()) off_fine_.resize(points_.size(), -1);
    for_chunks(far.size(), far_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (double& off = off_fine_[far[i]]; off < 0) off = to_fine_(points_[far[i]]);
    });
}

} // namespace hsdm
