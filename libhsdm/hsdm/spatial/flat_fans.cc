#include "hsdm/spatial/flat_fans.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/hash.hh"
#include "hsdm/core/large_vector.hh"

#include <atomic>

namespace hsdm {
namespace {

/// Least area of a triangle seen from a corner, over the square of its longest arm: far above rounding, far
/// below shapes in use.
constexpr double least_area = 1e-6;

/// Sums over the facets round a vertex, in any order: they are added to by several threads.
struct Fan {
    // hash of the sides that leave the vertex less that of those that come back: 0 for closed fans
    std::uint64_t ends = 0;
    std::uint32_t turns = 0; // how often the fan turns past the side of its first facet
};

/// The direction from which a fan is seen: the normal of its first facet at the vertex; and that facet's
/// side, which leaves the vertex.
struct Sight {
    Vec3 side{0, 0, 0}, direction{0, 0, 0};
};

/// Per vertex its first facet, no_index if it has none.
std::vector<Index> first_facets(const PolygonMesh& mesh, const std::vector<Index>& vertex) {
    std::vector<Index> first = large_vector<Index>(mesh.vertex_count(), no_index);
    for_each_index(mesh.facet_count(), chunks::usual, [&](Index f) {
        for (Index v : mesh.facet(f)) {
            const std::atomic_ref least(first[vertex[v]]);
            Index seen = least.load(std::memory_order_relaxed);
            while (f < seen && !least.compare_exchange_weak(seen, f, std::memory_order_relaxed)) {
            }
        }
    });
    return first;
}

std::vector<Sight> find_sights(const PolygonMesh& mesh, const std::vector<Index>& vertex) {
    const std::vector<Index> first = first_facets(mesh, vertex);
    std::vector<Sight> sights = large_vector<Sight>(first.size());
    for_each_index(first.size(), 2 * chunks::usual, [&](Index v) {
        if (first[v] == no_index) return;
        const auto facet = mesh.facet(first[v]);
        std::size_t k = 0;
        while (vertex[facet[k]] != v) ++k;
        const Vec3& at = mesh.positions[facet[k]];
        sights[v].side = mesh.positions[facet[(k + 1) % facet.size()]] - at;
        sights[v].direction =
            sights[v].side % (mesh.positions[facet[(k + facet.size() - 1) % facet.size()]] - at);
    });
    return sights;
}

/// How often a facet, seen from its corner k, passes the sight's side; 2 if it does not keep to a sector,
/// narrower than half a turn, in which its corners follow each other to the left.
std::uint32_t turns_at(const PolygonMesh& mesh, std::span<const Index> facet, std::size_t k,
                       const Sight& sight) {
    const std::size_t n = facet.size();
    if (n < 3) return 2;
    const auto arm = [&](std::size_t i) {
        const std::size_t at = k + i < n ? k + i : k + i - n;
        return mesh.positions[facet[at]] - mesh.positions[facet[k]];
    };
    const auto area = [&](const Vec3& a, const Vec3& b) { return (a % b) | sight.direction; };
    const Vec3 first = arm(1);
    Vec3 last = first;
    double sum = 0, least = std::numeric_limits<double>::infinity(), longest = first.sqrnorm();
    double across = 0; // from the first arm to the last one
    for (std::size_t i = 2; i < n; ++i) {
        const Vec3 next = arm(i);
        const double part = area(last, next);
        sum += part;
        // each step is checked as well as the sum, which could come round
        across = i == 2 ? part : area(first, next);
        least = std::min({least, part, across});
        longest = std::max(longest, next.sqrnorm());
        last = next;
    }
    if (n == 4)
        least = std::min(least, sum - across); // a cut beside this corner must not leave a folded rest
    const bool left =
        least > 0 && least * least > least_area * least_area * longest * longest * sight.direction.sqrnorm();
    return !left ? 2 : (first | sight.side) < 0 && (last | sight.side) >= 0;
}

} // namespace

/// A fan whose facets, seen along the normal of one corner, keep to their sectors and that comes round once
/// covers nothing twice. It comes round where it passes from the right of that corner's side, across it, to
/// the left.
std::vector<std::uint8_t> flat_fans(const PolygonMesh& mesh, const std::vector<Index>& vertex) {
    const std::vector<Sight> sights = find_sights(mesh, vertex);
    std::vector<Fan> fans = large_vector<Fan>(mesh.vertex_count());
    for_each_index(mesh.facet_count(), chunks::usual, [&](Index f) {
        const auto facet = mesh.facet(f);
        const std::size_t n = facet.size();
        if (n == 0) return;
        std::uint64_t last = hash_index(vertex[facet[n - 1]]), here = hash_index(vertex[facet[0]]);
        for (std::size_t k = 0; k < n; ++k) {
            const Index v = vertex[facet[k]];
            const std::uint64_t next = hash_index(vertex[facet[k + 1 < n ? k + 1 : 0]]);
            std::atomic_ref(fans[v].ends).fetch_add(next - last, std::memory_order_relaxed);
            last = here;
            here = next;
            const std::uint32_t turns = turns_at(mesh, facet, k, sights[v]);
            if (turns > 0) std::atomic_ref(fans[v].turns).fetch_add(turns, std::memory_order_relaxed);
        }
    });
    std::vector<std::uint8_t> flat = unwritten_vector<std::uint8_t>(fans.size());
    for_each_index(flat.size(), chunks::light,
                   [&](Index v) { flat[v] = fans[v].turns == 1 && fans[v].ends == 0; });
    return flat;
}

} // namespace hsdm
