#include "hsdm/facets/turn_outward.hh"

#include "hsdm/chunks.hh"
#include "hsdm/disjoint_sets.hh"
#include "hsdm/facets/triangulate.hh"
#include "hsdm/quality/orientation.hh"

#include <algorithm>
#include <atomic>

namespace hsdm {
namespace {

constexpr std::size_t facets_per_chunk = 1 << 12;

/// By the vertex that stands for the component.
struct Components {
    std::vector<Index> of_facet;
    std::vector<std::uint8_t> open; ///< has a border
    std::vector<double> volume;     ///< six times the signed one, if closed
};

Components find_components(const PolygonMesh& mesh, const FacetLinks& links) {
    DisjointSets sets(mesh.vertex_count());
    for_chunks(mesh.facet_count(), facets_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t f = begin; f < end; ++f)
            for (Index v : mesh.facet(f)) sets.join(mesh.facet(f)[0], v);
    });
    Components result;
    result.of_facet.resize(mesh.facet_count());
    result.open.assign(mesh.vertex_count(), 0);
    for_chunks(mesh.facet_count(), facets_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t f = begin; f < end; ++f) {
            const Index c = result.of_facet[f] = sets.find(mesh.facet(f)[0]);
            for (Index side = mesh.first[f]; side < mesh.first[f + 1]; ++side)
                if (links.twin[side] == no_index)
                    std::atomic_ref(result.open[c]).store(1, std::memory_order_relaxed);
        }
    });
    return result;
}

/// About each component's own first vertex, so that small ones far away lose no digits.
void measure_volumes(const PolygonMesh& mesh, const Triangulation& cut, Components& components) {
    std::vector<double> of_facet(mesh.facet_count());
    for_chunks(mesh.facet_count(), facets_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t f = begin; f < end; ++f) {
            const Vec3& centre = mesh.positions[components.of_facet[f]];
            double sum = 0;
            for (Index t = cut.first[f]; t < cut.first[f + 1]; ++t) {
                const auto& [a, b, c] = cut.triangles[t];
                sum += (mesh.positions[a] - centre)
                       | ((mesh.positions[b] - centre) % (mesh.positions[c] - centre));
            }
            of_facet[f] = sum;
        }
    });
    components.volume.assign(mesh.vertex_count(), 0);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        components.volume[components.of_facet[f]] += of_facet[f];
}

/// How often closed components other than a point's own wind round it: the crossings of a ray along x,
/// counted by the side they are seen from. Points are components by their first vertices.
class Windings {
public:
    Windings(const PolygonMesh& mesh, std::vector<Index> points) : mesh_(mesh), points_(std::move(points)) {
        std::sort(points_.begin(), points_.end(), [&](Index a, Index b) { return at(a, 1) < at(b, 1); });
        count_.assign(points_.size(), 0);
    }

    void add(const Triangle& triangle, Index component) {
        double lo[3], hi[3];
        for (unsigned k = 0; k < 3; ++k) {
            const auto [least, most] =
                std::minmax({at(triangle[0], k), at(triangle[1], k), at(triangle[2], k)});
            lo[k] = least, hi[k] = most;
        }
        auto i =
            static_cast<std::size_t>(std::lower_bound(points_.begin(), points_.end(), lo[1],
                                                      [&](Index point, double y) { return at(point, 1) < y; })
                                     - points_.begin());
        for (; i < points_.size() && at(points_[i], 1) <= hi[1]; ++i) {
            const Index p = points_[i];
            if (p == component || at(p, 2) < lo[2] || at(p, 2) > hi[2] || at(p, 0) > hi[0]) continue;
            std::atomic_ref(count_[i]).fetch_add(crossing(triangle, p), std::memory_order_relaxed);
        }
    }

    /// The points that nothing winds round.
    std::vector<Index> outside() const {
        std::vector<Index> result;
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (count_[i] == 0) result.push_back(points_[i]);
        return result;
    }

private:
    double at(Index vertex, unsigned axis) const { return mesh_.positions[vertex][axis]; }

    /// Does the ray from below the side a-b's line, in y, meet it, and from which side? A vertex at the ray's
    /// height counts as above, so that every crossing of a closed loop is counted once.
    int crossing_of_side(Index p, Index a, Index b) const {
        const bool a_above = at(a, 1) >= at(p, 1), b_above = at(b, 1) >= at(p, 1);
        if (a_above == b_above) return 0;
        const int side =
            orientation(Vec2{at(a, 1), at(a, 2)}, Vec2{at(b, 1), at(b, 2)}, Vec2{at(p, 1), at(p, 2)});
        return b_above ? side > 0 : -(side < 0);
    }

    int crossing(const Triangle& t, Index p) const {
        const int turns = crossing_of_side(p, t[0], t[1]) + crossing_of_side(p, t[1], t[2])
                          + crossing_of_side(p, t[2], t[0]);
        if (turns == 0) return 0;
        // Beyond the point along x? Seen from there the triangle runs as its turns say.
        const Vec3& from = mesh_.positions[p];
        const int side =
            orientation(mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]], from);
        return side * turns < 0 ? turns : 0;
    }

    const PolygonMesh& mesh_;
    std::vector<Index> points_; // by y
    std::vector<int> count_;
};

void turn(PolygonMesh& mesh, std::size_t f, FeatureHints& hints) {
    const auto first = static_cast<std::ptrdiff_t>(mesh.first[f]);
    const auto last = static_cast<std::ptrdiff_t>(mesh.first[f + 1]);
    std::reverse(mesh.corners.begin() + first, mesh.corners.begin() + last);
    if (hints.sides.empty()) return; // the last side stays the last: between the first and the last corner
    std::reverse(hints.sides.begin() + first, hints.sides.begin() + last - 1);
}

} // namespace

std::size_t turn_outward(PolygonMesh& mesh, FacetLinks& links, FeatureHints& hints) {
    Components components = find_components(mesh, links);
    const Triangulation cut = triangulate(mesh);
    measure_volumes(mesh, cut, components);
    std::vector<Index> inward;
    for (Index c = 0; c < components.volume.size(); ++c)
        if (!components.open[c] && components.volume[c] < 0) inward.push_back(c);
    if (inward.empty()) return 0;
    Windings windings(mesh, std::move(inward));
    for_chunks(mesh.facet_count(), facets_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t f = begin; f < end; ++f)
            if (const Index c = components.of_facet[f]; !components.open[c])
                for (Index t = cut.first[f]; t < cut.first[f + 1]; ++t) windings.add(cut.triangles[t], c);
    });
    std::vector<std::uint8_t> turns(mesh.vertex_count(), 0);
    for (Index c : windings.outside()) turns[c] = 1;
    std::size_t turned = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (turns[components.of_facet[f]]) turn(mesh, f, hints), ++turned;
    if (turned > 0) links = link_facets(mesh);
    return turned;
}

} // namespace hsdm
