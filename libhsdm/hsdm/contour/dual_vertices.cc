#include "hsdm/contour/dual_vertices.hh"

#include "hsdm/contour/bevels.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// The side of a corner that its chain leaves it by.
FacetSide side_after(const Crossings& crossings, FacetCorner corner) {
    return crossings.of(corner).leaving ? corner : corner.previous();
}

/// The chain of corners through one corner, inside one voxel.
class Chain {
public:
    Chain(const Crossings& crossings, const Links& links) : crossings_(crossings), links_(links) {}

    std::vector<FacetCorner> corners;
    bool closed = false;
    bool turned = false; // do the corners run against the facets?

    /// Collects the chain through a corner in the direction in which facets run round the vertex: each
    /// facet's half-edge to the vertex lies across the face by which the chain enters the corner. False as
    /// soon as it comes to a corner before this one, from which the chain will be, or was, walked.
    bool walk(FacetCorner start) {
        corners.clear();
        closed = turned = false;
        const FacetSide exit = side_after(crossings_, start);
        if (!forward(start, exit)) return false;
        if (closed) return true;
        // Open: walk the other half too, then put both in order from end to end.
        std::vector<FacetCorner> tail = std::move(corners);
        corners.clear();
        if (!forward(start, start.other_side(exit))) return false;
        std::reverse(corners.begin(), corners.end());
        corners.insert(corners.end(), tail.begin() + 1, tail.end());
        return true;
    }

    /// Lets the corners run from the lower end, or from the same corner to the lower of the two beside it, as
    /// they do if all normals are turned as well.
    void turn_by_number() {
        const std::size_t fixed = closed ? 1 : 0;
        if (corners.size() <= fixed || corners[fixed] <= corners.back()) return;
        std::reverse(corners.begin() + static_cast<std::ptrdiff_t>(fixed), corners.end());
        turned = true;
    }
    /// The side of the i-th corner by which the next one follows.
    FacetSide way_on(std::size_t i) const {
        const FacetSide after = side_after(crossings_, corners[i]);
        return turned ? corners[i].other_side(after) : after;
    }

private:
    /// Leaves `start` by one of its sides and goes on until the chain closes or ends; false if it comes to a
    /// corner before `start`.
    bool forward(FacetCorner start, FacetSide exit) {
        FacetCorner corner = start;
        do {
            corners.push_back(corner);
            const Link& link = links_.of(exit);
            if (link.open()) return true;
            corner = across(corner, exit, link.twin);
            if (corner < start) return false;
            exit = corner.other_side(link.twin);
        } while (corner != start);
        return closed = true;
    }

    const Crossings& crossings_;
    const Links& links_;
};

/// The vertices that one chain is cut into: ranges of its corners, which may begin elsewhere than in the
/// chain.
struct Cut {
    struct Piece {
        std::size_t first, end; // in `corners`
        // bit 0: its first corner is also the last of the piece before; bit 1: its last is also the first of
        // the next
        std::uint8_t shared;
    };
    std::vector<FacetCorner> corners;
    std::vector<Piece> pieces;
};

/// Cuts a chain so that no vertex gets both sides of a thin part or of a gap, the thin part of what is
/// around. Wherever the chain leads from one side to the other it is cut: across the link if that goes round
/// the rim, else in a facet of the rim's own face, between the sides.
class ChainCutter {
public:
    ChainCutter(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                const Links& links, double voxel_size)
        : grid_(grid), crossings_(crossings), sets_(sets), links_(links), voxel_size_(voxel_size) {}

    void cut(const Chain& chain, Cut& result) {
        find_cuts(chain);
        result.pieces.clear();
        // A closed chain is rotated to start at its first cut. It has at least two cuts, so the first is not
        // after the last corner.
        const std::size_t begin = chain.closed && !cuts_.empty() ? (cuts_[0] + 1) / 2 : 0;
        const auto middle = chain.corners.begin() + static_cast<std::ptrdiff_t>(begin);
        result.corners.assign(middle, chain.corners.end());
        result.corners.insert(result.corners.end(), chain.corners.begin(), middle);
        const bool around = chain.closed && !cuts_.empty() && cuts_[0] % 2 == 0;
        if (around) result.corners.push_back(result.corners[0]);
        std::size_t first = 0;
        unsigned shared = around;
        for (std::size_t c = chain.closed ? 1 : 0; c < cuts_.size(); ++c) {
            const std::size_t at = cuts_[c] - 2 * begin;
            const unsigned at_node = at % 2 == 0;
            result.pieces.push_back({first, at / 2 + 1, static_cast<std::uint8_t>(shared | at_node << 1)});
            first = (at + 1) / 2;
            shared = at_node;
        }
        result.pieces.push_back(
            {first, result.corners.size(), static_cast<std::uint8_t>(shared | unsigned{around} << 1)});
    }

private:
    static constexpr std::size_t none = ~std::size_t{0};

    /// Fills cuts_, ascending: 2 i for corner i, 2 i + 1 for the link after it.
    void find_cuts(const Chain& chain) {
        cuts_.clear();
        if (any_opposite(chain)) find_rims(chain);
        if (cuts_.empty()) find_bevels(chain);
        sort_unique(cuts_);
        if (chain.closed && cuts_.size() < 2) cuts_.clear();
    }

    /// Cuts between the two sides of a thin part or of a gap.
    void find_rims(const Chain& chain) {
        const std::size_t n = chain.corners.size();
        // From each corner, the shortest way (in steps) along the chain to a corner of the other side, and
        // where to cut it.
        length_.assign(n, 2 * n);
        place_.assign(n, none);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t steps = 1; steps < n && (chain.closed || i + steps < n) && place_[i] == none;
                 ++steps) {
                place_[i] = place_of_cut(chain, i, steps);
                if (place_[i] != none) length_[i] = steps;
            }
        for (std::size_t i = 0; i < n; ++i)
            if (place_[i] != none && !holds_shorter(i, chain)) cuts_.push_back(place_[i]);
    }

    /// Cuts between two creases with a narrow face between them: across a link that leads over it, and in a
    /// facet of that face. A closed chain passes two such places or more, or the face ends in the voxel.
    void find_bevels(const Chain& chain) {
        const std::size_t n = chain.corners.size();
        const auto corner = [&](std::size_t i) -> const Crossing& { return of(chain.corners[i % n]); };
        const auto link = [&](std::size_t i) -> const Link& { return links_.of(chain.way_on(i % n)); };
        const auto ends_after = [&](std::size_t i) {
            return (corner(i).normal | corner(i + 1).normal) < angles::smooth;
        };
        std::size_t begin = 0;
        if (chain.closed) {
            while (begin < n && !ends_after(begin)) ++begin;
            if (begin++ == n) return;
        }
        const std::size_t last = chain.closed ? begin + n : n - 1;
        std::size_t first = begin;
        for (std::size_t i = begin; i < last; ++i) {
            if (!ends_after(i)) continue;
            if (link(i).bevel) cuts_.push_back(2 * (i % n) + 1);
            const bool inner = chain.closed || first > 0;
            const std::size_t middle = (first + i) / 2;
            if (inner && !link(i).bevel && !link(first + n - 1).bevel
                && is_bevel(corner(first + n - 1), corner(middle), corner(i + 1)))
                cuts_.push_back(2 * (middle % n));
            first = i + 1;
        }
    }

    bool is_bevel(const Crossing& before, const Crossing& face, const Crossing& after) const {
        return lies_between(before.normal, face.normal, after.normal)
               && is_flat_between(grid_, before, sets_.sets[face.set], after, voxel_size_);
    }

    bool any_opposite(const Chain& chain) const {
        for (std::size_t i = 0; i < chain.corners.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (opposed(of(chain.corners[i]), of(chain.corners[j]))) return true;
        return false;
    }

    /// Where to cut the way of `steps` steps from corner i; none if it does not lead to the other side.
    std::size_t place_of_cut(const Chain& chain, std::size_t i, std::size_t steps) const {
        const std::size_t n = chain.corners.size();
        const FacetCorner a = chain.corners[i], b = chain.corners[(i + steps) % n];
        if (steps == 1) {
            const bool rim = links_.of(chain.way_on(i)).rim;
            return rim && !meet_nearby(a, b) ? 2 * i + 1 : none;
        }
        if (!opposed(of(a), of(b)) || meet_nearby(a, b)) return none;
        // The corner nearest to the middle of the way among those that lie on neither side.
        std::size_t best = none, best_off = n;
        for (std::size_t step = 1; step < steps; ++step) {
            const std::size_t off = 2 * step > steps ? 2 * step - steps : steps - 2 * step;
            const std::size_t corner = (i + step) % n;
            if (off < best_off && width(chain.corners[corner], a, b) > cuts::least_width)
                best = 2 * corner, best_off = off;
        }
        return best;
    }

    /// Do the planes of two corners meet near the voxel? Then they make the tip of a wedge, not a thin part.
    bool meet_nearby(FacetCorner a, FacetCorner b) const {
        const VoxelCoord c = CornerVoxel(grid_, crossings_, a).coord;
        const Vec3 at_a = crossing_position(grid_, of(a), 1), at_b = crossing_position(grid_, of(b), 1);
        const bool is_moved = crossings_.is_moved(of(a).edge) || crossings_.is_moved(of(b).edge);
        const Vec3 centre = is_moved ? 0.5 * (at_a + at_b) : Vec3(c[0], c[1], c[2]) + Vec3(0.5, 0.5, 0.5);
        const double k = of(a).normal | (at_a - centre), l = of(b).normal | (at_b - centre);
        const double cosine = of(a).normal | of(b).normal;
        return k * k + l * l - 2 * cosine * k * l < sheets::beside * sheets::beside * (1 - cosine * cosine);
    }

    /// How wide a face is between the planes of two sides, in voxels; 0 if it belongs to one of them. The rim
    /// of a wall lies within both, the bottom of a gap beyond both, and both count alike.
    double width(FacetCorner face, FacetCorner a, FacetCorner b) const {
        double sum = 0;
        for (FacetCorner side : {a, b}) {
            const Vec3& n = of(side).normal;
            const double cosine = of(face).normal | n;
            if (cosine > angles::one_sheet) return 0;
            const Vec3 d = crossing_position(grid_, of(side), 1) - crossing_position(grid_, of(face), 1);
            sum += (n | d) / std::sqrt(std::max(1 - cosine * cosine, 0.01));
        }
        return std::abs(sum);
    }

    /// Does the way from corner i to the other side contain a shorter or equal one from a later corner?
    bool holds_shorter(std::size_t i, const Chain& chain) const {
        const std::size_t n = chain.corners.size();
        for (std::size_t step = 1; step < length_[i] && (chain.closed || i + step < n); ++step)
            if (step + length_[(i + step) % n] <= length_[i]) return true;
        return false;
    }

    const Crossing& of(FacetCorner corner) const { return crossings_.of(corner); }

    const GridPoints& grid_;
    const Crossings& crossings_;
    const NormalSets& sets_;
    const Links& links_;
    double voxel_size_;
    std::vector<std::size_t> cuts_, length_, place_;
};

struct ChunkDualVertices {
    std::vector<FacetCorner> corners;
    std::vector<Index> sizes;
    std::vector<CornerVoxel> voxels;
    std::vector<std::uint8_t> shared, open;
    struct Cap {
        std::size_t first, count; // dual vertices
        bool turned;
    };
    std::vector<Cap> caps;
    std::vector<std::size_t> after_cut;

    /// Dual vertices are numbered along the chain as it was cut; the corners of each run as facets do.
    void add(const Cut& cut_chain, const CornerVoxel& voxel, bool closed, bool turned) {
        const std::size_t pieces = cut_chain.pieces.size();
        for (std::size_t i = 1; i < pieces; ++i) after_cut.push_back(sizes.size() + i);
        if (pieces > 2 && closed) caps.push_back({sizes.size(), pieces, turned});
        for (const Cut::Piece& piece : cut_chain.pieces) {
            const std::size_t size = corners.size();
            corners.insert(corners.end(),
                           cut_chain.corners.begin() + static_cast<std::ptrdiff_t>(piece.first),
                           cut_chain.corners.begin() + static_cast<std::ptrdiff_t>(piece.end));
            if (turned) std::reverse(corners.begin() + static_cast<std::ptrdiff_t>(size), corners.end());
            sizes.push_back(static_cast<Index>(piece.end - piece.first));
            const unsigned swapped = piece.shared >> 1 | (piece.shared & 1u) << 1;
            shared.push_back(turned ? static_cast<std::uint8_t>(swapped) : piece.shared);
            voxels.push_back(voxel);
            open.push_back(!closed);
        }
    }
};

void append(const ChunkDualVertices& chunk, DualVertices& duals) {
    const auto base = static_cast<Index>(duals.size());
    duals.corners.insert(duals.corners.end(), chunk.corners.begin(), chunk.corners.end());
    duals.voxels.insert(duals.voxels.end(), chunk.voxels.begin(), chunk.voxels.end());
    duals.open.insert(duals.open.end(), chunk.open.begin(), chunk.open.end());
    for (Index size : chunk.sizes) duals.first.push_back(duals.first.back() + size);
    for (std::size_t dual : chunk.after_cut) duals.after_cut.push_back(base + static_cast<Index>(dual));
    for (const ChunkDualVertices::Cap& cap : chunk.caps) {
        std::vector<Index> vertices;
        for (std::size_t i = 0; i < cap.count; ++i)
            vertices.push_back(base + static_cast<Index>(cap.first + i));
        // Facets at the cuts run from each dual vertex to the next, the cap against them.
        if (!cap.turned) std::reverse(vertices.begin() + 1, vertices.end());
        duals.caps.push_back(std::move(vertices));
    }
}

/// Fills of_corner: both sides of a corner belong to its dual vertex; of a corner shared by two dual
/// vertices, one side to each.
void number_sides(const Crossings& crossings, std::span<const std::uint8_t> shared, DualVertices& duals) {
    assign_large(duals.of_corner, 8 * crossings.crossings.size(), no_index);
    for_each_index(duals.size(), chunks::quick, [&](Index v) {
        const auto corners = duals.corners_of(v);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::size_t leaves_by = crossings.of(corners[i]).leaving, corner = corners[i].number();
            if (i > 0 || !(shared[v] & 1u)) duals.of_corner[2 * corner + 1 - leaves_by] = v;
            if (i + 1 < corners.size() || !(shared[v] & 2u)) duals.of_corner[2 * corner + leaves_by] = v;
        }
    });
}

} // namespace

CornerVoxel::CornerVoxel(const GridPoints& grid, const Crossings& crossings, FacetCorner corner) {
    const Index edge = crossings.of(corner).edge;
    const unsigned octant = corner.octant(edge % 3);
    const VoxelCoord lower = grid.coord(edge / 3);
    for (unsigned k = 0; k < 3; ++k) coord[k] = lower[k] + static_cast<int>(octant >> k & 1u) - 1;
    voxel = grid.voxels[edge / 3][octant];
}

DualVertices build_dual_vertices(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                                 double voxel_size, const Links& links) {
    const std::size_t n = crossings.crossings.size();
    std::vector<ChunkDualVertices> chunks(chunk_count(n, chunks::quick));
    for_chunks(n, chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t c) {
        Chain chain(crossings, links);
        ChainCutter cutter(grid, crossings, sets, links, voxel_size);
        Cut cut;
        for (auto x = static_cast<Index>(begin); x < end; ++x)
            for (const FacetCorner corner : corners_of_facet(x)) {
                if (!chain.walk(corner)) continue;
                chain.turn_by_number();
                cutter.cut(chain, cut);
                chunks[c].add(cut, {grid, crossings, corner}, chain.closed, chain.turned);
            }
    });
    std::size_t corners = 0, vertices = 0;
    for (const ChunkDualVertices& chunk : chunks)
        corners += chunk.corners.size(), vertices += chunk.sizes.size();
    DualVertices duals;
    reserve_large(duals.corners, corners);
    reserve_large(duals.first, vertices + 1);
    reserve_large(duals.voxels, vertices);
    reserve_large(duals.open, vertices);
    std::vector<std::uint8_t> shared;
    reserve_large(shared, vertices);
    for (ChunkDualVertices& chunk : chunks) {
        Interruption::poll();
        append(chunk, duals);
        shared.insert(shared.end(), chunk.shared.begin(), chunk.shared.end());
        chunk = {}; // frees it before more is needed
    }
    number_sides(crossings, shared, duals);
    return duals;
}

} // namespace hsdm
