#include "hsdm/mesh/turn_outward.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/orientation.hh"
#include "hsdm/mesh/triangulate.hh"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <span>

namespace hsdm {
namespace {

/// Properties of components, indexed by the vertex that represents each.
struct ComponentVolumes {
    std::vector<Index> of_facet;
    std::vector<std::uint8_t> open; ///< has a border
    std::vector<double> volume;     ///< six times the signed one, if closed
};

ComponentVolumes find_components(const PolygonMesh& mesh, const FacetLinks& links) {
    DisjointSets sets(mesh.vertex_count());
    for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
        for (Index v : mesh.facet(f)) sets.join(mesh.facet(f)[0], v);
    });
    ComponentVolumes result;
    resize_large(result.of_facet, mesh.facet_count());
    assign_large(result.open, mesh.vertex_count(), 0);
    for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
        const Index c = result.of_facet[f] = sets.find(mesh.facet(f)[0]);
        for (Index side = mesh.first[f]; side < mesh.first[f + 1]; ++side)
            if (links.twin[side] == no_index)
                std::atomic_ref(result.open[c]).store(1, std::memory_order_relaxed);
    });
    return result;
}

/// Sums volumes about each component's own first vertex, so that small components far away lose no digits.
void measure_volumes(const PolygonMesh& mesh, const Triangulation& cut, ComponentVolumes& components) {
    std::vector<double> of_facet = large_vector<double>(mesh.facet_count());
    for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
        const Vec3& centre = mesh.positions[components.of_facet[f]];
        double sum = 0;
        for (Index t = cut.first[f]; t < cut.first[f + 1]; ++t) {
            const auto& [a, b, c] = cut.triangles[t];
            sum +=
                (mesh.positions[a] - centre) | ((mesh.positions[b] - centre) % (mesh.positions[c] - centre));
        }
        of_facet[f] = sum;
    });
    assign_large(components.volume, mesh.vertex_count(), 0);
    for_each_in_order(mesh.facet_count(),
                      [&](std::size_t f) { components.volume[components.of_facet[f]] += of_facet[f]; });
}

/// Counts the closed components that enclose given points: the crossings of a ray along x from each point,
/// signed by the side they are seen from. The points are the first vertices of components, kept in a grid
/// over y and z.
class Surroundings {
public:
    Surroundings(const PolygonMesh& mesh, std::span<const Index> points)
        : mesh_(mesh), count_(points.size(), 0) {
        Box box;
        for (Index p : points) box.add(mesh.positions[p]);
        while (side_ * side_ < points.size() && side_ < most_cells) side_ *= 2;
        for (unsigned k = 0; k < 2; ++k) {
            lo_[k] = box.lo[k + 1];
            const double size = box.hi[k + 1] - box.lo[k + 1];
            scale_[k] = size > 0 ? static_cast<double>(side_) / size : 0;
        }
        std::vector<std::pair<std::size_t, Index>> places; // cell, and which of the points
        for (Index i = 0; i < points.size(); ++i)
            places.emplace_back(cell(at(points[i], 1), 0) * side_ + cell(at(points[i], 2), 1), i);
        std::sort(places.begin(), places.end());
        first_.assign(side_ * side_ + 1, 0);
        for (const auto& [c, i] : places) {
            ++first_[c + 1];
            which_.push_back(i);
            points_.push_back(points[i]);
        }
        counts_to_first(first_);
    }

    /// To be called for the triangles of closed components, from any thread. Each crossing counts `weight`.
    void add(const Triangle& triangle, Index component, int weight) {
        std::array<double, 3> lo, hi;
        for (unsigned k = 0; k < 3; ++k) {
            lo[k] = std::min({at(triangle[0], k), at(triangle[1], k), at(triangle[2], k)});
            hi[k] = std::max({at(triangle[0], k), at(triangle[1], k), at(triangle[2], k)});
        }
        for (std::size_t y = cell(lo[1], 0); y <= cell(hi[1], 0); ++y)
            for (Index i = first_[y * side_ + cell(lo[2], 1)]; i < first_[y * side_ + cell(hi[2], 1) + 1];
                 ++i) {
                const Index p = points_[i];
                if (p == component || at(p, 0) > hi[0] || at(p, 1) < lo[1] || at(p, 1) > hi[1]
                    || at(p, 2) < lo[2] || at(p, 2) > hi[2])
                    continue;
                std::atomic_ref(count_[which_[i]])
                    .fetch_add(weight * crossing(triangle, p), std::memory_order_relaxed);
            }
    }

    /// Per point, the weighted count of components around it.
    const std::vector<int>& counts() const { return count_; }

private:
    static constexpr std::size_t most_cells = 1 << 10; // along an axis

    double at(Index vertex, unsigned axis) const { return mesh_.positions[vertex][axis]; }
    std::size_t cell(double x, unsigned axis) const {
        const double place = (x - lo_[axis]) * scale_[axis];
        return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(side_ - 1)));
    }

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
        const int side = orientation(mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]],
                                     mesh_.positions[p]);
        return side * turns < 0 ? turns : 0;
    }

    const PolygonMesh& mesh_;
    std::size_t side_ = 1; // cells along an axis
    std::array<double, 2> lo_, scale_;
    std::vector<Index> first_, points_, which_; // by cell
    std::vector<int> count_;
};

/// Per point, the sum of the weights of the components that enclose it; a component that faces inward counts
/// negative.
template <class Weight>
std::vector<int> sum_around(const PolygonMesh& mesh, const Triangulation& cut,
                            const ComponentVolumes& components, std::span<const Index> points,
                            const Weight& weight) {
    Surroundings around(mesh, points);
    for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
        if (const Index c = components.of_facet[f]; const int w = weight(c))
            for (Index t = cut.first[f]; t < cut.first[f + 1]; ++t) around.add(cut.triangles[t], c, w);
    });
    return around.counts();
}

/// Marks the components to turn: closed ones that face inward and are not enclosed by others; and inside of
/// these all that then does not face against what encloses it, as walls of cavities and what is in them do.
std::vector<std::uint8_t> find_turns(const PolygonMesh& mesh, const Triangulation& cut,
                                     const ComponentVolumes& components) {
    std::vector<std::uint8_t> turns = large_vector<std::uint8_t>(mesh.vertex_count());
    std::vector<Index> closed;
    bool any_inward = false;
    const auto is_inward = [&](Index c) { return components.volume[c] < 0; };
    for_each_in_order(components.volume.size(), [&](std::size_t i) {
        const auto c = static_cast<Index>(i);
        if (components.open[c] || components.volume[c] == 0) return;
        closed.push_back(c);
        any_inward |= is_inward(c);
    });
    if (!any_inward) return turns;
    const auto sum = [&](const auto& weight) { return sum_around(mesh, cut, components, closed, weight); };
    const auto one_each = [&](Index c) { return components.open[c] ? 0 : is_inward(c) ? -1 : 1; };
    const std::vector<int> enclosed = sum([&](Index c) { return components.open[c] ? 0 : 1; });
    const std::vector<int> depth = sum(one_each);
    for (std::size_t i = 0; i < closed.size(); ++i)
        turns[closed[i]] = is_inward(closed[i]) && enclosed[i] == 0;
    const std::vector<int> in_turned = sum([&](Index c) { return turns[c] ? one_each(c) : 0; });
    for (std::size_t i = 0; i < closed.size(); ++i)
        if (in_turned[i] > 0) turns[closed[i]] = is_inward(closed[i]) != (depth[i] % 2 == 1);
    return turns;
}

void turn(PolygonMesh& mesh, std::size_t f, FeatureHints& hints) {
    const auto first = static_cast<std::ptrdiff_t>(mesh.first[f]);
    const auto last = static_cast<std::ptrdiff_t>(mesh.first[f + 1]);
    std::reverse(mesh.corners.begin() + first, mesh.corners.begin() + last);
    // reversing the corners keeps the last side last: between the first and the last corner
    if (hints.sides.empty()) return;
    std::reverse(hints.sides.begin() + first, hints.sides.begin() + last - 1);
}

std::size_t turn_components(PolygonMesh& mesh, const FacetLinks& links, FeatureHints& hints) {
    ComponentVolumes components = find_components(mesh, links);
    const Triangulation cut = triangulate(mesh);
    measure_volumes(mesh, cut, components);
    std::vector<std::uint8_t> turns = find_turns(mesh, cut, components);
    // If components pass through each other, each may be enclosed by another; the whole must face outward all
    // the same.
    double volume = 0;
    for_each_in_order(turns.size(), [&](std::size_t c) {
        if (components.open[c]) volume = std::numeric_limits<double>::infinity();
        volume += turns[c] ? -components.volume[c] : components.volume[c];
    });
    if (volume < 0)
        for (std::size_t c = 0; c < turns.size(); ++c) turns[c] = components.volume[c] < 0;
    std::size_t turned = 0;
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        if (turns[components.of_facet[f]]) turn(mesh, f, hints), ++turned;
    });
    return turned;
}

} // namespace

std::size_t turn_outward(PolygonMesh& mesh, FacetLinks& links, FeatureHints& hints) {
    const std::size_t turned = turn_components(mesh, links, hints);
    if (turned == 0) return 0;
    links = FacetLinks(); // its memory first
    links = link_facets(mesh);
    return turned;
}

void turn_over(PolygonMesh& mesh) {
    FeatureHints none;
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) { turn(mesh, f, none); });
}

} // namespace hsdm
