#include "hsdm/quality/topology.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/hash.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/mesh/edge_table.hh"
#include "hsdm/mesh/triangulate.hh"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace hsdm {
namespace {

/// The facets as loops without immediate repeats of a vertex; a loop left with fewer than three corners has
/// collapsed and is no part of the surface. Corner c is also the half-edge from its vertex to the next one.
struct Loops {
    std::vector<Index> vertex, next, facet; ///< per corner
    std::size_t count = 0;                  ///< loops that have not collapsed
};

Loops clean_loops(const PolygonMesh& mesh) {
    Loops loops;
    for (std::vector<Index>* values : {&loops.vertex, &loops.next, &loops.facet})
        reserve_large(*values, mesh.corners.size());
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const std::size_t begin = loops.vertex.size();
        for (Index v : mesh.facet(f))
            if (loops.vertex.size() == begin || loops.vertex.back() != v) loops.vertex.push_back(v);
        while (loops.vertex.size() > begin + 1 && loops.vertex.back() == loops.vertex[begin])
            loops.vertex.pop_back();
        if (loops.vertex.size() < begin + 3) {
            loops.vertex.resize(begin);
            return;
        }
        ++loops.count;
        for (std::size_t c = begin; c < loops.vertex.size(); ++c) {
            loops.next.push_back(static_cast<Index>(c + 1));
            loops.facet.push_back(static_cast<Index>(f));
        }
        loops.next.back() = static_cast<Index>(begin);
    });
    return loops;
}

/// Corners joined where they follow each other round a vertex (fans), facets across edges (components), and
/// what edges show.
struct Fans {
    DisjointSets corners, facets;
    std::vector<Index> fans;             ///< per vertex
    std::vector<unsigned char> branches; ///< per vertex: an edge with three or more facets ends there
};

EdgeTable edges_of(const Loops& loops, std::size_t vertices) {
    return EdgeTable(vertices, [&](const auto& visit) {
        for_each_index(loops.vertex.size(), chunks::quick,
                       [&](Index c) { visit(loops.vertex[c], loops.vertex[loops.next[c]], c); });
    });
}

/// Joins what an edge joins; returns whether its two facets run along it the same way.
bool join_at_edge(const Loops& loops, std::span<const EdgeSide> edge, Fans& fans) {
    const Index h = edge.front().side;
    bool misoriented = false;
    for (const EdgeSide& beside : edge.subspan(1)) {
        const Index other = beside.side;
        const bool same_way = loops.vertex[other] == loops.vertex[h];
        misoriented |= edge.size() == 2 && same_way;
        fans.corners.join(h, same_way ? other : loops.next[other]);
        fans.corners.join(loops.next[h], same_way ? loops.next[other] : other);
        fans.facets.join(loops.facet[h], loops.facet[other]);
    }
    return misoriented;
}

/// Counts edges into `topology`; returns the half-edges on the boundary, by their edges.
std::vector<Index> measure_edges(const Loops& loops, std::size_t vertices, Fans& fans, Topology& topology) {
    const EdgeTable table = edges_of(loops, vertices);
    struct EdgeSums {
        std::size_t edges = 0, misoriented = 0, branching = 0;
    };
    std::vector<EdgeSums> sums(table.chunks());
    std::vector<std::vector<Index>> boundary(table.chunks());
    table.for_edges([&](Index lower, std::span<const EdgeSide> edge, std::size_t c) {
        ++sums[c].edges;
        sums[c].misoriented += join_at_edge(loops, edge, fans);
        if (edge.size() == 1) boundary[c].push_back(edge[0].side);
        if (edge.size() < 3) return;
        ++sums[c].branching;
        for (Index v : {lower, edge[0].upper}) // edges of other chunks may end there
            std::atomic_ref(fans.branches[v]).store(1, std::memory_order_relaxed);
    });
    for (const EdgeSums& sum : sums) {
        topology.edges += sum.edges;
        topology.misoriented_edges += sum.misoriented;
        topology.nonmanifold_edges += sum.branching;
    }
    for_each_in_order(loops.vertex.size(), [&](std::size_t c) {
        fans.fans[loops.vertex[c]] += fans.corners.find(static_cast<Index>(c)) == c;
    });
    return joined(boundary);
}

/// Counts boundary loops: the two boundary edges of one fan follow each other along a loop.
std::size_t count_boundary_loops(const Loops& loops, const std::vector<Index>& boundary, Fans& fans) {
    std::vector<Index> seen =
        large_vector<Index>(loops.vertex.size(), no_index); // by fan: the boundary edge met first
    DisjointSets chains(boundary.size());
    std::size_t count = boundary.size();
    for (Index i = 0; i < boundary.size(); ++i)
        for (Index end : {boundary[i], loops.next[boundary[i]]}) {
            Index& first = seen[fans.corners.find(end)];
            if (first == no_index)
                first = i;
            else
                count -= chains.join(first, i);
        }
    return count;
}

std::vector<Index> sorted_set(std::span<const Index> facet) {
    std::vector<Index> sorted(facet.begin(), facet.end());
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

/// Whether a vertex comes twice; without a copy for the facets that there are many of.
bool repeats_vertex(std::span<const Index> f) {
    if (f.size() == 3) return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
    if (f.size() == 4)
        return f[0] == f[1] || f[0] == f[2] || f[0] == f[3] || f[1] == f[2] || f[1] == f[3] || f[2] == f[3];
    const std::vector<Index> sorted = sorted_set(f);
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

bool is_degenerate(const PolygonMesh& mesh, std::span<const Index> facet, std::vector<Vec3>& ring) {
    ring.clear();
    for (Index v : facet) ring.push_back(mesh.positions[v]);
    return has_no_area(ring) || repeats_vertex(facet);
}

std::size_t count_degenerate(const PolygonMesh& mesh) {
    std::vector<unsigned char> degenerate = large_vector<unsigned char>(mesh.facet_count());
    for_chunks(degenerate.size(), chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<Vec3> ring;
        for (std::size_t f = begin; f != end; ++f) degenerate[f] = is_degenerate(mesh, mesh.facet(f), ring);
    });
    return static_cast<std::size_t>(std::count(degenerate.begin(), degenerate.end(), 1));
}

std::size_t count_duplicates(const PolygonMesh& mesh) {
    struct Key {
        std::uint64_t set;
        Index facet;
        auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys = large_vector<Key>(mesh.facet_count());
    for_each_index(keys.size(), chunks::quick, [&](Index f) {
        keys[f] = {mesh.facet(f).size(), f};
        for (Index v : mesh.facet(f)) keys[f].set += hash_index(v);
    });
    parallel_sort(keys);
    std::size_t count = 0;
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (keys[i].set != keys[i - 1].set) continue;
        const auto a = mesh.facet(keys[i - 1].facet), b = mesh.facet(keys[i].facet);
        count += !a.empty() && sorted_set(a) == sorted_set(b);
    }
    return count;
}

Box box_of_corners(const PolygonMesh& mesh) {
    std::vector<Box> boxes(chunk_count(mesh.corners.size(), chunks::light));
    for_chunks(mesh.corners.size(), chunks::light,
               [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                   for (std::size_t c = begin; c < end; ++c)
                       boxes[chunk].add(mesh.positions[mesh.corners[c]]);
               });
    Box all;
    for (const Box& box : boxes) all.add(box);
    return all;
}

/// Sum of term(i) over 0 .. n - 1, the same bits for any number of threads.
template <class Term>
double chunked_sum(std::size_t n, Term term) {
    std::vector<double> sums(chunk_count(n, chunks::quick), 0.0);
    for_chunks(n, chunks::quick, [&](std::size_t i, std::size_t end, std::size_t c) {
        double sum = 0;
        for (; i < end; ++i) sum += term(i);
        sums[c] = sum;
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

} // namespace

bool has_no_area(std::span<const Vec3> ring) {
    constexpr double negligible = 1e-12; // area over the longest side squared
    if (ring.size() < 3) return true;
    double size = 0;
    for (const Vec3& p : ring) {
        if (!std::isfinite(p[0] + p[1] + p[2])) return true;
        size = std::max(size, (p - ring[0]).max_abs());
    }
    if (!(size > 0) || !std::isfinite(size)) return true;
    const bool is_usual = size > 1e-50 && size < 1e50;
    // Nearly always a triangle tells: a side is at most sqrt(12) times `size` long.
    const double ample = 100 * negligible * size * size;
    for (std::size_t i = 2; is_usual && i < ring.size(); ++i)
        if (((ring[i - 1] - ring[0]) % (ring[i] - ring[0])).sqrnorm() > ample * ample) return false;
    // Scaled by a power of two, unless the size is a usual one, so that neither overflow nor rounding depends
    // on it. In two steps: for the smallest sizes the factor itself is no number.
    const int exponent = is_usual ? 0 : -std::ilogb(size);
    const double half = std::ldexp(1.0, exponent / 2), rest = std::ldexp(1.0, exponent - exponent / 2);
    double longest = 0, twice = 0;
    Vec3 p(0, 0, 0); // the corner before, from the first
    const auto go_to = [&](const Vec3& q) {
        longest = std::max(longest, (q - p).sqrnorm());
        twice += (p % q).norm();
        p = q;
    };
    for (std::size_t i = 1; i < ring.size(); ++i) go_to((ring[i] - ring[0]) * half * rest);
    go_to({0, 0, 0});
    return !(twice / 2 > negligible * longest);
}

/// About the centre of the box, so that a mesh far from the origin loses no digits.
double signed_volume(const PolygonMesh& mesh) {
    const Box box = box_of_corners(mesh);
    const Vec3 centre = box.empty() ? Vec3(0, 0, 0) : box.lo + box.size() / 2;
    const Triangulation cut = triangulate(mesh);
    return chunked_sum(cut.size(), [&](std::size_t t) {
        const auto& [a, b, c] = cut.triangles[t];
        return (mesh.positions[a] - centre)
               | ((mesh.positions[b] - centre) % (mesh.positions[c] - centre)) / 6;
    });
}

namespace {

Topology count_facets(const PolygonMesh& mesh) {
    Topology topology;
    topology.faces = mesh.facet_count();
    for_each_in_order(topology.faces, [&](std::size_t f) {
        const std::size_t corners = mesh.facet(f).size();
        topology.triangles += corners == 3;
        topology.quads += corners == 4;
        topology.larger += corners > 4;
    });
    return topology;
}

} // namespace

Topology measure_connectivity(const PolygonMesh& mesh) {
    Topology topology = count_facets(mesh);
    const std::size_t vertices = mesh.vertex_count();
    std::vector<unsigned char> used = large_vector<unsigned char>(vertices, 0);
    for_each_in_order(mesh.corners.size(), [&](std::size_t c) { used[mesh.corners[c]] = 1; });
    topology.vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
    topology.isolated_vertices = vertices - topology.vertices;

    const Loops loops = clean_loops(mesh);
    Fans fans{DisjointSets(loops.vertex.size()), DisjointSets(topology.faces),
              large_vector<Index>(vertices, 0), large_vector<unsigned char>(vertices, 0)};
    const std::vector<Index> boundary = measure_edges(loops, vertices, fans, topology);
    topology.boundary_edges = boundary.size();
    std::size_t on_surface = 0;
    for_each_in_order(vertices, [&](std::size_t v) {
        on_surface += fans.fans[v] > 0;
        topology.nonmanifold_vertices += fans.fans[v] > 1 || fans.branches[v] != 0;
    });
    for_each_in_order(loops.vertex.size(), [&](std::size_t c) {
        const bool begins_facet = c == 0 || loops.facet[c] != loops.facet[c - 1];
        topology.components += begins_facet && fans.facets.find(loops.facet[c]) == loops.facet[c];
    });
    topology.boundary_loops = count_boundary_loops(loops, boundary, fans);
    topology.euler =
        static_cast<long>(on_surface) - static_cast<long>(topology.edges) + static_cast<long>(loops.count);
    return topology;
}

namespace {

/// Rows of sides without a twin that follow each other.
std::size_t count_boundary_loops(const PolygonMesh& mesh, const FacetLinks& links) {
    std::vector<bool> seen(mesh.corners.size());
    std::size_t count = 0;
    for_each_in_order(mesh.corners.size(), [&](std::size_t begin) {
        if (links.twin[begin] != no_index || seen[begin]) return;
        ++count;
        for (auto c = static_cast<Index>(begin); !seen[c]; c = links.open_in[links.vertex[c]]) seen[c] = true;
    });
    return count;
}

} // namespace

Topology measure_connectivity(const PolygonMesh& mesh, const FacetLinks& links) {
    Topology topology = count_facets(mesh);
    topology.vertices = links.source.size() - links.split_vertices;
    topology.isolated_vertices = mesh.vertex_count() - topology.vertices;
    std::vector<Index> split(links.source.begin() + static_cast<std::ptrdiff_t>(topology.vertices),
                             links.source.end());
    std::ranges::sort(split);
    topology.nonmanifold_vertices =
        static_cast<std::size_t>(std::unique(split.begin(), split.end()) - split.begin());
    DisjointSets components(topology.faces);
    topology.components = topology.faces;
    for_each_in_order(topology.faces, [&](std::size_t f) {
        for (Index c = mesh.first[f]; c < mesh.first[f + 1]; ++c) {
            const Index twin = links.twin[c];
            topology.boundary_edges += twin == no_index;
            if (twin != no_index && twin < c) continue;
            ++topology.edges;
            if (twin != no_index)
                topology.components -= components.join(static_cast<Index>(f), links.facet[twin]);
        }
    });
    topology.boundary_loops = count_boundary_loops(mesh, links);
    topology.euler = static_cast<long>(topology.vertices) - static_cast<long>(topology.edges)
                     + static_cast<long>(topology.faces);
    return topology;
}

Topology measure_topology(const PolygonMesh& mesh) {
    Topology topology = measure_connectivity(mesh);
    topology.degenerate_facets = count_degenerate(mesh);
    topology.duplicate_facets = count_duplicates(mesh);
    topology.signed_volume = signed_volume(mesh);
    return topology;
}

} // namespace hsdm
