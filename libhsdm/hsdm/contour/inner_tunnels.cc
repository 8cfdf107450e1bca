#include "hsdm/contour/inner_tunnels.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/surrounding.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "hsdm/mesh/vertex_neighbors.hh"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>

namespace hsdm {
namespace {

/// A closed chain with its voxel.
struct ChainOfVoxel {
    Index voxel;
    ChainVertices vertices;
    auto operator<=>(const ChainOfVoxel&) const = default;
};

/// The closed chains of the voxels that have two and more, by voxel.
std::vector<ChainOfVoxel> chains_that_share_voxels(const DualVertices& duals, std::size_t voxels) {
    const auto for_each_closed = [&](const auto& f) {
        duals.for_each_chain([&](Index first, Index end) {
            if (duals.voxels[first].voxel != no_index && !duals.open[first])
                f(duals.voxels[first].voxel, ChainVertices{first, end});
        });
    };
    std::vector<std::uint8_t> count = large_vector<std::uint8_t>(voxels, 0); // 2: or more
    for_each_closed([&](Index voxel, ChainVertices) {
        if (count[voxel] < 2) ++count[voxel];
    });
    std::vector<ChainOfVoxel> result;
    for_each_closed([&](Index voxel, ChainVertices chain) {
        if (count[voxel] > 1) result.push_back({voxel, chain});
    });
    std::ranges::sort(result);
    return result;
}

/// What a chain goes round.
struct Ring {
    Vec3 middle{0, 0, 0};
    double within = 0; ///< mean distance of the middle from the facets' planes, positive outside
};

Ring ring_of(const DualMesh& dual, ChainVertices chain) {
    std::vector<Index> crossings;
    for (Index v = chain.first; v < chain.end; ++v)
        for (const FacetCorner c : dual.duals.corners_of(v)) crossings.push_back(c.crossing());
    sort_unique(crossings); // a corner where the chain is cut belongs to two vertices
    Ring ring;
    const auto n = static_cast<double>(crossings.size());
    const auto position = [&](Index x) { return dual.crossing_position_of({x, 0}); };
    for (const Index x : crossings) ring.middle += position(x) / n;
    for (const Index x : crossings)
        ring.within += (dual.crossings.crossings[x].normal | (ring.middle - position(x))) / n;
    return ring;
}

/// The way between two rings of a voxel, and how sets lie about it.
class WayBetween {
public:
    WayBetween(const Ring& a, const Ring& b)
        : a_(a), b_(b), middle_(0.5 * (a.middle + b.middle)), way_(unit(b.middle - a.middle)), across_(way_) {
        sign_ = a.within > 0 ? 1 : -1;
    }

    /// Do both rings go round their middles, on one side of the surface?
    bool is_clear(double least) const { return sign_ * a_.within >= least && sign_ * b_.within >= least; }

    /// Does a set's plane lie on the side of both middles that the rings say?
    bool is_beside(const NormalSet& s) const {
        return !(sign_ * (s.normal | (a_.middle - s.centroid)) < 0
                 || sign_ * (s.normal | (b_.middle - s.centroid)) < 0);
    }
    bool is_near(const NormalSet& s, double farthest) const {
        return (s.centroid - middle_).sqrnorm() < farthest * farthest;
    }

    void add(const NormalSet& s) {
        if (std::abs(s.normal | way_) < angles::halfway) directions_.push_back(across_.angle_of(s.normal));
    }
    bool is_surrounded() { return wide_gaps(directions_) == 0; }

private:
    const Ring &a_, &b_;
    Vec3 middle_, way_;
    Frame across_;
    double sign_;
    std::vector<double> directions_; ///< of the sets added
};

/// Do all sets of a voxel lie beside the way between two rings, and they and those near it all round?
bool is_free(const Ring& a, const Ring& b, Index voxel, const OctreeLevel& level, const NormalSets& sets) {
    const double h = level.voxel_size;
    WayBetween way(a, b);
    if (!way.is_clear(sheets::surface_error() * h)) return false;
    for (const NormalSet& s : sets.of_voxel(voxel)) {
        if (!way.is_beside(s)) return false;
        way.add(s);
    }
    for_neighbors(level, voxel, [&](Index v) {
        for (const NormalSet& s : sets.of_voxel(v))
            if (way.is_beside(s) && way.is_near(s, surrounding::reach_along * h)) way.add(s);
    });
    return way.is_surrounded();
}

/// Joins two rings by facets that go on along both, where the sum of squared lengths between them is least.
class Sleeve {
public:
    Sleeve(const PolygonMesh& mesh, std::vector<Index> one, std::vector<Index> other)
        : longer_(std::move(one)), shorter_(std::move(other)) {
        if (shorter_.size() > longer_.size()) std::swap(longer_, shorter_);
        is_turned_ = longer_[1] > longer_.back(); // so that turned normals get the same facets, turned
        if (is_turned_) {
            std::reverse(longer_.begin() + 1, longer_.end());
            std::reverse(shorter_.begin() + 1, shorter_.end());
        }
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t begin = 0; begin < shorter_.size(); ++begin) {
            double sum = 0;
            for (std::size_t i = 0; i < longer_.size(); ++i)
                sum += (mesh.positions[longer_[i]] - mesh.positions[partner(i, begin)]).sqrnorm();
            if (sum < least) least = sum, begin_ = begin;
        }
    }

    void add_to(PolygonMesh& facets) const {
        std::vector<Index> facet;
        for (std::size_t i = 0; i < longer_.size(); ++i) {
            const Index from = partner(i, begin_), to = partner(i + 1, begin_);
            facet = {longer_[i], longer_[(i + 1) % longer_.size()], to};
            if (from != to) facet.push_back(from);
            if (is_turned_) std::ranges::reverse(facet);
            facets.add_facet(facet);
        }
    }

private:
    /// The vertex of the shorter ring beside the i-th of the longer one; it runs the other way.
    Index partner(std::size_t i, std::size_t begin) const {
        const std::size_t n = shorter_.size(), back = i * n / longer_.size();
        return shorter_[(begin + 2 * n - back) % n];
    }

    std::vector<Index> longer_, shorter_;
    std::size_t begin_ = 0;
    bool is_turned_ = false;
};

/// What a tunnel takes away at one of its ends, and the ring of vertices round that.
struct TunnelEnd {
    std::vector<Index> facets, ring;
};
using TunnelEnds = std::array<TunnelEnd, 2>;

TunnelEnd end_of(const PolygonMesh& mesh, const FacetsAt& facets, ChainVertices chain) {
    std::vector<Index> vertices(chain.end - chain.first);
    std::iota(vertices.begin(), vertices.end(), chain.first);
    TunnelEnd end{facets.of_any(vertices), {}};
    end.ring = border_of(mesh, end.facets);
    return end;
}

/// Have two rings of vertices a facet in common? Then the surface leads from one to the other as it is.
bool meet(const FacetsAt& at, std::span<const Index> one, std::span<const Index> other) {
    const std::vector<Index> a = at.of_any(one), b = at.of_any(other);
    std::vector<Index> both;
    std::ranges::set_intersection(a, b, std::back_inserter(both));
    return !both.empty();
}

} // namespace

std::vector<InnerTunnel> find_inner_tunnels(const DualMesh& dual, const OctreeLevel& level,
                                            const NormalSets& sets) {
    const std::vector<ChainOfVoxel> chains = chains_that_share_voxels(dual.duals, sets.first.size() - 1);
    std::vector<InnerTunnel> result;
    for (std::size_t i = 0; i + 1 < chains.size(); ++i) {
        const Index voxel = chains[i].voxel;
        const bool is_pair = chains[i + 1].voxel == voxel && (i == 0 || chains[i - 1].voxel != voxel)
                             && (i + 2 == chains.size() || chains[i + 2].voxel != voxel);
        if (!is_pair || sets.of_voxel(voxel).empty()) continue;
        const InnerTunnel pair{chains[i].vertices, chains[i + 1].vertices};
        if (is_free(ring_of(dual, pair[0]), ring_of(dual, pair[1]), voxel, level, sets))
            result.push_back(pair);
    }
    return result;
}

std::size_t open_inner_tunnels(std::span<const InnerTunnel> tunnels, PolygonMesh& mesh) {
    if (tunnels.empty()) return 0;
    std::vector<std::uint8_t> of_chains = large_vector<std::uint8_t>(mesh.vertex_count(), 0),
                              of_rings = of_chains;
    for (const InnerTunnel& tunnel : tunnels)
        for (const ChainVertices& chain : tunnel)
            for (Index v = chain.first; v < chain.end; ++v) of_chains[v] = 1;
    const FacetsAt at_chains(mesh, of_chains);
    std::vector<TunnelEnds> ends;
    for (const InnerTunnel& tunnel : tunnels) {
        ends.push_back({end_of(mesh, at_chains, tunnel[0]), end_of(mesh, at_chains, tunnel[1])});
        for (const TunnelEnd& end : ends.back())
            for (const Index v : end.ring) of_rings[v] = 1;
    }
    const FacetsAt at_rings(mesh, of_rings);
    std::size_t opened = 0;
    PolygonMesh tubes;
    std::vector<std::uint8_t> taken = large_vector<std::uint8_t>(mesh.facet_count(), 0);
    for (TunnelEnds& pair : ends) {
        auto& [one, other] = pair;
        const auto is_taken = [&](Index f) { return taken[f] != 0; };
        if (one.ring.size() < 3 || other.ring.size() < 3 || meet(at_rings, one.ring, other.ring)
            || std::ranges::any_of(one.facets, is_taken) || std::ranges::any_of(other.facets, is_taken))
            continue;
        for (const TunnelEnd& end : pair)
            for (const Index f : end.facets) taken[f] = 1;
        Sleeve(mesh, std::move(one.ring), std::move(other.ring)).add_to(tubes);
        ++opened;
    }
    if (opened == 0) return 0;
    remove_facets(mesh, [&](std::size_t f) { return taken[f] != 0; });
    for (std::size_t f = 0; f < tubes.facet_count(); ++f) mesh.add_facet(tubes.facet(f));
    return opened;
}

} // namespace hsdm
