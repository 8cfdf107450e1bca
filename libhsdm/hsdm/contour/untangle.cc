#include "hsdm/contour/untangle.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>

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

} // namespace hsdm
