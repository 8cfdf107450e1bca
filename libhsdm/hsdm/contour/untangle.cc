#include "hsdm/contour/untangle.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/collapse_edges.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>
#include <tuple>
#include <utility>

namespace hsdm {
namespace {

bool overlap(const Box& a, const Box& b, double margin) {
    for (unsigned k = 0; k < 3; ++k)
        if (a.lo[k] > b.hi[k] + margin || b.lo[k] > a.hi[k] + margin) return false;
    return true;
}

/// The intersecting facets and those around them, as a mesh of its own. Facets outside cannot meet what moves
/// inside, because vertices move towards their neighbours and so stay within the neighbourhood's box.
class Neighbourhood {
public:
    Neighbourhood(const PolygonMesh& mesh, const std::vector<std::array<Index, 2>>& pairs, double nearby) {
        std::vector<Box> trouble;
        for (const auto& pair : pairs)
            for (Index f : pair) trouble.push_back(box_of(mesh, f));
        std::sort(trouble.begin(), trouble.end(),
                  [](const Box& a, const Box& b) { return a.lo[0] < b.lo[0]; });
        double widest = 0;
        for (const Box& box : trouble) widest = std::max(widest, box.hi[0] - box.lo[0]);
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const Box box = box_of(mesh, f);
            const auto first = std::lower_bound(trouble.begin(), trouble.end(), box.lo[0] - nearby - widest,
                                                [](const Box& b, double x) { return b.lo[0] < x; });
            for (auto t = first; t != trouble.end() && t->lo[0] <= box.hi[0] + nearby; ++t)
                if (overlap(*t, box, nearby)) {
                    facets_.push_back(static_cast<Index>(f));
                    break;
                }
        }
        part = part_of(mesh, facets_, &of_vertex_);
        // A vertex that has facets outside must stay: not all of its neighbours are known here.
        inner_.assign(part.vertex_count(), 1);
        std::size_t next = 0;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            if (next < facets_.size() && facets_[next] == f) {
                ++next;
                continue;
            }
            for (Index v : mesh.facet(f))
                if (of_vertex_[v] != no_index) inner_[of_vertex_[v]] = 0;
        }
    }

    PolygonMesh part;

    /// Per vertex of the part: may it move?
    bool inner(Index v) const { return inner_[v] != 0; }

    void write_back(PolygonMesh& mesh) const {
        for (std::size_t v = 0; v < of_vertex_.size(); ++v)
            if (of_vertex_[v] != no_index) mesh.positions[v] = part.positions[of_vertex_[v]];
    }

    /// The same where the part's facets have changed too: they follow the mesh's others.
    void replace_facets(PolygonMesh& mesh) const {
        write_back(mesh);
        std::size_t next = 0;
        remove_facets(mesh, [&](std::size_t f) {
            const bool out = next < facets_.size() && facets_[next] == f;
            next += out;
            return out;
        });
        std::vector<Index> of_part(part.vertex_count());
        for (std::size_t v = 0; v < of_vertex_.size(); ++v)
            if (of_vertex_[v] != no_index) of_part[of_vertex_[v]] = static_cast<Index>(v);
        std::vector<Index> corners;
        for (std::size_t f = 0; f < part.facet_count(); ++f) {
            corners.clear();
            for (Index v : part.facet(f)) corners.push_back(of_part[v]);
            mesh.add_facet(corners);
        }
    }

private:
    std::vector<Index> facets_;    // of the part, in the mesh
    std::vector<Index> of_vertex_; // per vertex of the mesh, that of the part or no_index
    std::vector<std::uint8_t> inner_;
};

/// Mean of the vertices joined to v by an edge, for every vertex.
std::vector<Vec3> neighbour_means(const PolygonMesh& mesh) {
    std::vector<Vec3> sums(mesh.vertex_count(), Vec3(0, 0, 0));
    std::vector<double> counts(mesh.vertex_count(), 0);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            sums[a] += mesh.positions[b];
            sums[b] += mesh.positions[a];
            ++counts[a];
            ++counts[b];
        }
    }
    for (std::size_t v = 0; v < sums.size(); ++v)
        sums[v] = counts[v] > 0 ? sums[v] / counts[v] : mesh.positions[v];
    return sums;
}

/// Changes the part at one place after the other, as long as each change leaves fewer intersections.
class Mender {
public:
    explicit Mender(Neighbourhood& around) : around_(around), found_(find_self_intersections(around.part)) {}

    std::size_t run() {
        std::size_t changes = 0, before = 0;
        do {
            before = changes;
            while (collapse_an_edge()) ++changes;
            while (cut_a_quad()) ++changes;
        } while (changes > before && found_.triangle_pairs > 0);
        return changes;
    }

    const SelfIntersections& found() const { return found_; }

private:
    /// Takes the changed part if fewer facets meet in it.
    bool take(PolygonMesh&& changed) {
        SelfIntersections left = find_self_intersections(changed);
        if (left.triangle_pairs >= found_.triangle_pairs) return false;
        around_.part = std::move(changed);
        found_ = std::move(left);
        return true;
    }

    std::vector<Index> tangled_facets() const {
        std::vector<Index> facets;
        for (const auto& pair : found_.facet_pairs) facets.insert(facets.end(), pair.begin(), pair.end());
        sort_unique(facets);
        return facets;
    }

    std::vector<Index> tangled_vertices() const {
        std::vector<Index> vertices;
        for (const Index f : tangled_facets())
            for (const Index v : around_.part.facet(f)) vertices.push_back(v);
        sort_unique(vertices);
        return vertices;
    }

    /// Cuts a quad that meets others in two, one way or the other.
    bool cut_a_quad() {
        for (const Index f : tangled_facets()) {
            const auto quad = around_.part.facet(f);
            if (quad.size() != 4) continue;
            for (std::size_t from : {0u, 1u}) {
                if (!may_join(quad[from], quad[from + 2])) continue;
                const std::array<Index, 3> one{quad[from], quad[from + 1], quad[from + 2]},
                    other{quad[from], quad[from + 2], quad[(from + 3) % 4]};
                if (!has_area(quad, one) || !has_area(quad, other)) continue;
                PolygonMesh changed = around_.part;
                remove_facets(changed, [&](std::size_t g) { return g == f; });
                changed.add_facet(one);
                changed.add_facet(other);
                if (take(std::move(changed))) return true;
            }
        }
        return false;
    }

    /// Has a half of a quad an area? It may be turned over: a fold is less harm than what passes through.
    bool has_area(std::span<const Index> quad, std::span<const Index> half) const {
        return area_vector(around_.part, half).norm() > 1e-6 * area_vector(around_.part, quad).norm();
    }

    /// Would an edge between two vertices be a new one?
    bool may_join(Index a, Index b) const {
        if (!around_.inner(a) && !around_.inner(b)) return false; // there may be one outside
        for (std::size_t f = 0; f < around_.part.facet_count(); ++f) {
            const auto ring = around_.part.facet(f);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Index c = ring[i], d = ring[(i + 1) % ring.size()];
                if ((a == c && b == d) || (a == d && b == c)) return false;
            }
        }
        return true;
    }

    /// Collapses an edge that ends at facets that meet others, the shortest first.
    bool collapse_an_edge() {
        for (const EdgeCollapse& edge : tangled_edges()) {
            PolygonMesh changed = around_.part;
            if (collapse_edges(changed, {{edge}})[0] && take(std::move(changed))) return true;
        }
        return false;
    }

    /// Either way round, if both ends may move.
    std::vector<EdgeCollapse> tangled_edges() const {
        const PolygonMesh& mesh = around_.part;
        std::vector<std::uint8_t> tangled(mesh.vertex_count(), 0);
        for (const Index v : tangled_vertices()) tangled[v] = 1;
        std::vector<std::tuple<double, Index, Index>> edges;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto ring = mesh.facet(f);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Index a = ring[i], b = ring[(i + 1) % ring.size()];
                if (!(tangled[a] || tangled[b]) || !around_.inner(a) || !around_.inner(b)) continue;
                const double length = (mesh.positions[a] - mesh.positions[b]).sqrnorm();
                edges.emplace_back(length, a, b);
                edges.emplace_back(length, b, a);
            }
        }
        sort_unique(edges);
        std::vector<EdgeCollapse> collapses;
        collapses.reserve(edges.size());
        for (const auto& [length, from, to] : edges) collapses.push_back({from, to, mesh.positions[to]});
        return collapses;
    }

    Neighbourhood& around_;
    SelfIntersections found_;
};

void validate(const UntangleOptions& options) {
    check_option(options.rounds >= 0, "rounds", options.rounds, "be 0 or more");
    check_option(options.step > 0 && options.step <= 1, "step", options.step, "lie in (0, 1]");
    check_option(options.nearby > 0, "nearby", options.nearby, "be positive");
    check_option(!(options.reach < 0), "reach", options.reach, "be 0 or more");
}

} // namespace

UntangleCounts untangle(PolygonMesh& mesh, const UntangleOptions& options, const FacetCells* cells) {
    validate(options);
    SelfIntersections found = cells ? find_self_intersections(mesh, *cells) : find_self_intersections(mesh);
    UntangleCounts counts;
    counts.before = counts.after = found.triangle_pairs;
    if (found.triangle_pairs == 0) return counts;
    Index first = mesh.facet(found.facet_pairs[0][0])[0];
    counts.first = mesh.positions[first];
    if (options.rounds == 0) return counts;

    Neighbourhood around(mesh, found.facet_pairs, options.nearby);
    const std::vector<Vec3> start = around.part.positions;
    found = find_self_intersections(around.part);
    std::vector<Vec3> best = start;
    std::size_t fewest = found.triangle_pairs;
    if (fewest > 0) first = around.part.facet(found.facet_pairs[0][0])[0];
    for (int round = 0; round < options.rounds && found.triangle_pairs > 0; ++round) {
        const std::vector<Vec3> means = neighbour_means(around.part);
        std::vector<std::uint8_t> due(around.part.vertex_count(), 0);
        for (const auto& pair : found.facet_pairs)
            for (Index f : pair)
                for (Index v : around.part.facet(f)) due[v] = around.inner(v);
        for (Index v = 0; v < due.size(); ++v) {
            if (!due[v]) continue;
            Vec3& p = around.part.positions[v];
            p += (means[v] - p) * options.step;
            const Vec3 way = p - start[v];
            if (options.reach > 0 && way.norm() > options.reach)
                p = start[v] + way * (options.reach / way.norm());
        }
        found = find_self_intersections(around.part);
        if (found.triangle_pairs >= fewest) continue;
        fewest = found.triangle_pairs;
        best = around.part.positions;
        if (fewest > 0) first = around.part.facet(found.facet_pairs[0][0])[0];
    }
    around.part.positions = best;
    for (std::size_t v = 0; v < best.size(); ++v) counts.moved += best[v] != start[v];
    around.write_back(mesh);
    counts.after = fewest;
    if (fewest > 0) counts.first = best[first];
    return counts;
}

UntangleCounts mend_tangles(PolygonMesh& mesh, double nearby, std::size_t most_pairs) {
    check_option(nearby > 0, "nearby", nearby, "be positive");
    SelfIntersections found = find_self_intersections(mesh);
    UntangleCounts counts;
    counts.before = counts.after = found.triangle_pairs;
    if (found.triangle_pairs == 0) return counts;
    counts.first = mesh.positions[mesh.facet(found.facet_pairs[0][0])[0]];
    if (found.facet_pairs.size() > most_pairs) return counts;
    Neighbourhood around(mesh, found.facet_pairs, nearby);
    Mender mender(around);
    counts.moved = mender.run();
    if (counts.moved > 0) around.replace_facets(mesh);
    counts.after = mender.found().triangle_pairs;
    if (counts.after > 0)
        counts.first = around.part.positions[around.part.facet(mender.found().facet_pairs[0][0])[0]];
    return counts;
}

} // namespace hsdm
