#include "hsdm/mesh/small_components.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/edge_table.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/remove_facets.hh"

#include <atomic>
#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

/// Of a component; the volume is that of a closed one.
struct Extent {
    double area = 0, volume = 0; ///< negative: it faces inward, as the side of a cavity does
    Box box;

    bool is_thinner_than(double thickness) const { return 2 * std::abs(volume) < thickness * area; }

    /// Nothing is turned outward yet.
    bool faces_against(const Extent& largest) const { return (volume < 0) != (largest.volume < 0); }
    bool is_small_in(const Extent& largest, double margin, double least_ratio) const {
        return is_within(largest, margin) && area * least_ratio <= largest.area;
    }
    /// May this be layers of the largest component: a cavity in it, or small and beside it?
    bool may_be_of(const Extent& largest, double margin, double least_ratio) const {
        return faces_against(largest) ? is_within(largest, margin) && area < largest.area
                                      : is_small_in(largest, margin, least_ratio);
    }

private:
    bool is_within(const Extent& largest, double margin) const {
        for (unsigned k = 0; k < 3; ++k)
            if (box.lo[k] < largest.box.lo[k] - margin || box.hi[k] > largest.box.hi[k] + margin)
                return false;
        return true;
    }
};

/// The connected components of a mesh, each known by the least of its vertices.
class Components {
public:
    explicit Components(const PolygonMesh& mesh)
        : mesh_(mesh), vertices_(mesh.vertex_count()), facets_(mesh.vertex_count(), 0) {
        for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
            for (Index v : mesh.facet(f)) vertices_.join(mesh.facet(f)[0], v);
        });
        for_chunks(mesh.facet_count(), chunks::quick, [&](std::size_t f, std::size_t end, std::size_t) {
            for (std::size_t first = f; f < end; first = f) { // facets of one come in long runs
                const Index component = of(f);
                while (++f < end && of(f) == component) continue;
                std::atomic_ref(facets_[component]).fetch_add(f - first, std::memory_order_relaxed);
            }
        });
    }

    Index of(std::size_t facet) { return vertices_.find(mesh_.facet(facet)[0]); }
    /// Per vertex, the number of facets of the component that it identifies, else 0.
    const std::vector<std::size_t>& facets() const { return facets_; }
    std::vector<double> areas() {
        std::vector<double> areas(facets_.size(), 0);
        for (std::size_t f = 0; f < mesh_.facet_count(); ++f)
            areas[of(f)] += area_vector(mesh_, mesh_.facet(f)).norm();
        return areas;
    }
    /// Per component of at most `most` facets, its area, what it encloses and its box; nothing for others.
    std::vector<Extent> extents(std::size_t most) {
        std::vector<Extent> result(facets_.size());
        for_each_in_order(mesh_.facet_count(), [&](std::size_t f) {
            const Index component = of(f);
            if (facets_[component] > most) return;
            const Vec3 area = 0.5 * area_vector(mesh_, mesh_.facet(f));
            Extent& extent = result[component];
            extent.area += area.norm();
            extent.volume += (area | (mesh_.positions[mesh_.facet(f)[0]] - mesh_.positions[component])) / 3;
            for (const Index v : mesh_.facet(f)) extent.box.add(mesh_.positions[v]);
        });
        return result;
    }
    /// Per component of at most `most` facets, does it have a border?
    std::vector<std::uint8_t> are_open(std::size_t most) {
        std::vector<std::uint8_t> open(facets_.size(), 0);
        const EdgeTable edges(mesh_.vertex_count(), [&](const auto& visit) {
            for (std::size_t f = 0; f < mesh_.facet_count(); ++f) {
                if (facets_[of(f)] > most) continue;
                Index side = mesh_.first[f + 1] - 1;
                for (Index next = mesh_.first[f]; next < mesh_.first[f + 1]; side = next++)
                    visit(mesh_.corners[side], mesh_.corners[next], side);
            }
        });
        edges.for_edges([&](Index lower, std::span<const EdgeSide> edge, std::size_t) {
            const auto upwards = std::ranges::count_if(
                edge, [&](const EdgeSide& side) { return mesh_.corners[side.side] == lower; });
            if (2 * upwards != std::ssize(edge))
                std::atomic_ref(open[vertices_.find(lower)]).store(1, std::memory_order_relaxed);
        });
        return open;
    }

    /// Does a closed component go round the vertex that another is known by? By the angles that its facets
    /// fill there (A. van Oosterom, J. Strackee, The solid angle of a plane triangle, 1983).
    bool encloses(Index component, Index other) {
        const Vec3& p = mesh_.positions[other];
        double half = 0; // of the angle
        for_each_in_order(mesh_.facet_count(), [&](std::size_t f) {
            if (of(f) != component) return;
            const auto facet = mesh_.facet(f);
            const Vec3 a = mesh_.positions[facet[0]] - p;
            for (std::size_t i = 2; i < facet.size(); ++i) {
                const Vec3 b = mesh_.positions[facet[i - 1]] - p, c = mesh_.positions[facet[i]] - p;
                const double x = a.norm(), y = b.norm(), z = c.norm();
                half += std::atan2(a | (b % c), x * y * z + (a | b) * z + (b | c) * x + (c | a) * y);
            }
        });
        return std::abs(half) > std::numbers::pi;
    }

private:
    const PolygonMesh& mesh_;
    DisjointSets vertices_;
    std::vector<std::size_t> facets_;
};

/// The components c for which is_small(c).
template <class IsSmall>
SmallComponentFacets components_where(const PolygonMesh& mesh, Components& components, IsSmall is_small) {
    SmallComponentFacets found;
    std::vector<std::uint8_t> small(components.facets().size(), 0);
    for (std::size_t c = 0; c < small.size(); ++c)
        if (components.facets()[c] > 0 && is_small(c)) small[c] = 1, ++found.components;
    found.facets.assign(mesh.facet_count(), 0);
    if (found.components > 0)
        for_each_index(mesh.facet_count(), chunks::quick,
                       [&](Index f) { found.facets[f] = small[components.of(f)]; });
    return found;
}

/// Removes the components with their facets.
SmallComponents remove_components(PolygonMesh& mesh, std::vector<EdgeHint>& hints,
                                  const SmallComponentFacets& small) {
    SmallComponents removed;
    removed.components = small.components;
    if (removed.components > 0)
        removed.facets = remove_facets(mesh, hints, [&](std::size_t f) { return small.facets[f] != 0; });
    return removed;
}

} // namespace

bool has_cavity(const PolygonMesh& mesh) {
    Components components(mesh);
    const std::vector<std::uint8_t> open = components.are_open(mesh.facet_count());
    const std::vector<Extent> extents = components.extents(mesh.facet_count());
    if (extents.empty()) return false;
    const Extent& widest = *std::ranges::max_element(extents, {}, &Extent::area);
    for (std::size_t c = 0; c < extents.size(); ++c)
        if (extents[c].area > 0 && open[c] == 0 && extents[c].faces_against(widest)) return true;
    return false;
}

Occurrences drop_splinters(PolygonMesh& mesh, const SplinterOptions& options) {
    if (mesh.facet_count() == 0) return {};
    Components components(mesh);
    const std::vector<std::size_t>& sizes = components.facets();
    const auto largest = static_cast<double>(options.largest > 0 ? options.largest : std::ranges::max(sizes));
    const std::size_t most = std::max({options.most_open, options.most_flat, options.most_facets});
    const auto may_go = [&](std::size_t size, double area) {
        const auto facets = static_cast<double>(size);
        return size <= most
               && (facets * options.least_ratio <= largest
                   || (area < options.least_area && facets < largest));
    };
    const bool looks_at_all = options.layers > 0;
    if (!looks_at_all
        && std::ranges::none_of(sizes, [&](std::size_t size) { return size > 0 && may_go(size, 0); }))
        return {};
    const std::size_t looked_at = looks_at_all ? mesh.facet_count() : most;
    const std::vector<std::uint8_t> open = components.are_open(looked_at);
    const std::vector<Extent> extents = components.extents(looked_at);
    const auto of_most = std::ranges::max_element(extents, {}, &Extent::area) - extents.begin();
    Extent widest = extents[static_cast<std::size_t>(of_most)];
    if (open[static_cast<std::size_t>(of_most)] != 0) widest.volume = 0;
    std::vector<EdgeHint> none;
    const SmallComponentFacets small = components_where(mesh, components, [&](std::size_t c) {
        const Extent& extent = extents[c];
        if (open[c] == 0 && extent.is_thinner_than(options.layers)
            && extent.may_be_of(widest, options.layers, options.least_ratio))
            return true;
        const bool flat = sizes[c] <= options.most_flat && extent.is_thinner_than(options.flat);
        const std::size_t most_closed = flat ? options.most_flat : options.most_facets;
        return may_go(sizes[c], extent.area) && sizes[c] <= (open[c] ? options.most_open : most_closed);
    });
    return remove_components(mesh, none, small).facets;
}

Occurrences drop_cavities(PolygonMesh& mesh, FeatureHints& hints) {
    if (mesh.facet_count() == 0) return {};
    Components components(mesh);
    const std::vector<std::uint8_t> open = components.are_open(mesh.facet_count());
    const std::vector<Extent> extents = components.extents(mesh.facet_count());
    const auto of_most = std::ranges::max_element(extents, {}, &Extent::area) - extents.begin();
    const auto widest = static_cast<std::size_t>(of_most);
    if (open[widest] != 0) return {};
    const SmallComponentFacets cavities = components_where(mesh, components, [&](std::size_t c) {
        return open[c] == 0 && extents[c].faces_against(extents[widest])
               && extents[c].is_small_in(extents[widest], 0, splinters::least_ratio)
               && components.encloses(static_cast<Index>(widest), static_cast<Index>(c));
    });
    return remove_components(mesh, hints.sides, cavities).facets;
}

SmallComponentFacets find_small_components(const PolygonMesh& mesh, const SmallComponentOptions& options) {
    if (mesh.facet_count() == 0) return {};
    Components components(mesh);
    const std::vector<double> areas = components.areas();
    const auto largest =
        static_cast<std::size_t>(std::max_element(areas.begin(), areas.end()) - areas.begin());
    return components_where(mesh, components, [&](std::size_t c) {
        if (c == largest) return false;
        return static_cast<double>(components.facets()[c]) < options.least_facets || options.least_share >= 1
               || areas[c] < options.least_share * areas[largest];
    });
}

SmallComponents drop_small_components(PolygonMesh& mesh, FeatureHints& hints,
                                      const SmallComponentOptions& options) {
    return remove_components(mesh, hints.sides, find_small_components(mesh, options));
}

} // namespace hsdm
