#include "hsdm/sheets/settle_crossings.hh"

#include "hsdm/chunks.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

constexpr std::size_t corners_per_chunk = 2048;
constexpr int rounds = 8;

// What it costs to contradict the evidence, in crossings taken back.
constexpr double cost_of_weak = 0.5;    // taking back a crossing that the data do not carry
constexpr double cost_of_return = 0.75; // bringing back one beyond a crease or beyond the data
constexpr double cost_of_invention = 2; // a crossing where no sheet has one
constexpr double impossible = 1e30;

using Side = std::uint8_t;
constexpr Side inside = 0, outside = 1, unknown = 2;

/// The cheapest choice among an edge's crossings that leads from one side to another by turns.
class EdgeChoice {
public:
    explicit EdgeChoice(const CrossingCandidates& candidates)
        : list_(candidates.crossings), standing_(candidates.standing) {}

    static constexpr std::size_t most = 128; // sheets of an edge

    /// How firmly a standing crossing stands.
    double weight(Index x) const { return list_.crossings[x].supported ? 1 : cost_of_weak; }
    double cost_of_taking(Index x) const { return standing_[x] ? 0 : cost_of_return; }
    double cost_of_leaving(Index x) const { return standing_[x] ? weight(x) : 0; }
    Side side_before(Index x) const { return list_.crossings[x].leaving ? inside : outside; }

    double cost(Index edge, Side low, Side high) const {
        std::array<double, 2> after = at_upper_end(high);
        for (Index x = list_.first[edge + 1]; x-- > list_.first[edge];) after = before(x, after);
        return after[low];
    }

    /// Calls take(x, taken) for every crossing, lowest first; returns the side beyond the last.
    template <class Take>
    Side choose(Index edge, Side low, Side high, Take&& take) const {
        const Index begin = list_.first[edge];
        const std::size_t n = list_.first[edge + 1] - begin;
        std::array<std::array<double, 2>, most + 1> after;
        after[n] = at_upper_end(high);
        for (std::size_t k = n; k-- > 0;) after[k] = before(begin + static_cast<Index>(k), after[k + 1]);
        Side side = low;
        for (std::size_t k = 0; k < n; ++k) {
            const Index x = begin + static_cast<Index>(k);
            const bool taken =
                side == side_before(x) && after[k][side] < after[k + 1][side] + cost_of_leaving(x);
            if (taken) side = 1 - side;
            take(x, taken);
        }
        return side;
    }

private:
    static std::array<double, 2> at_upper_end(Side high) {
        std::array<double, 2> cost{cost_of_invention, cost_of_invention};
        cost[high] = 0;
        return cost;
    }

    /// Costs from each side before a crossing, given those after it.
    std::array<double, 2> before(Index x, const std::array<double, 2>& after) const {
        const Side from = side_before(x), to = 1 - from;
        std::array<double, 2> cost{after[0] + cost_of_leaving(x), after[1] + cost_of_leaving(x)};
        cost[from] = std::min(cost[from], after[to] + cost_of_taking(x));
        return cost;
    }

    const Crossings& list_;
    const std::vector<std::uint8_t>& standing_;
};

/// The sides of the grid points and what follows from them.
class Settlement {
public:
    Settlement(const CornerLattice& lattice, const LocalSheets& sheets, const NormalSets& sets,
               const CrossingCandidates& candidates, double voxel_size)
        : lattice_(lattice),
          sheets_(sheets),
          sets_(sets),
          list_(candidates.crossings),
          standing_(candidates.standing),
          choice_(candidates),
          h_(voxel_size),
          side_(lattice.size(), unknown),
          below_(lattice.size(), {no_index, no_index, no_index}) {
        for_corners([&](Index c) {
            for (unsigned a = 0; a < 3; ++a)
                if (lattice.next[c][a] != no_index) below_[lattice.next[c][a]][a] = c;
        });
    }

    Crossings run() {
        vote();
        for (int ring = 0; ring < 2; ++ring) spread();
        settle();
        return chosen();
    }

private:
    template <class F>
    void for_corners(F&& f) const {
        for_chunks(lattice_.size(), corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t c = begin; c < end; ++c) f(static_cast<Index>(c));
        });
    }

    /// Calls f(neighbour) for the up to six corners that share an edge with this one.
    template <class F>
    void for_neighbors(Index c, F&& f) const {
        for (unsigned a = 0; a < 3; ++a)
            for (Index n : {lattice_.next[c][a], below_[c][a]})
                if (n != no_index) f(n);
    }

    /// What the standing crossing nearest to the lower end of an edge says about it, or nearest to its upper
    /// end about that one: positive outside.
    double vote(Index edge, bool upper) const {
        const Index n = list_.first[edge + 1] - list_.first[edge];
        for (Index k = 0; k < n; ++k) {
            const Index x = upper ? list_.first[edge + 1] - 1 - k : list_.first[edge] + k;
            if (!standing_[x]) continue;
            return list_.crossings[x].leaving == upper ? choice_.weight(x) : -choice_.weight(x);
        }
        return 0;
    }

    /// The crossings next to a corner say on which side it lies.
    void vote() {
        for_corners([&](Index c) {
            double sum = 0;
            for (unsigned a = 0; a < 3; ++a) {
                sum += vote(3 * c + a, false);
                if (below_[c][a] != no_index) sum += vote(3 * below_[c][a] + a, true);
            }
            if (sum != 0) side_[c] = sum > 0 ? outside : inside;
        });
    }

    /// Corners without a crossing beside them lie on the side of their neighbours.
    void spread() {
        std::vector<Side> next = side_;
        for_corners([&](Index c) {
            if (side_[c] != unknown) return;
            int sum = 0;
            for_neighbors(c, [&](Index n) {
                if (side_[n] != unknown) sum += side_[n] == outside ? 1 : -1;
            });
            if (sum != 0) next[c] = sum > 0 ? outside : inside;
        });
        side_ = std::move(next);
    }

    double corner_cost(Index c, Side side) const {
        double sum = 0;
        for (unsigned a = 0; a < 3; ++a) {
            const Index up = lattice_.next[c][a], down = below_[c][a];
            if (up != no_index && side_[up] != unknown) sum += choice_.cost(3 * c + a, side, side_[up]);
            if (down != no_index && side_[down] != unknown)
                sum += choice_.cost(3 * down + a, side_[down], side);
        }
        return sum;
    }

    /// The corners at edges that contradict their ends, and those next to them.
    std::vector<Index> doubtful() const {
        std::vector<std::vector<Index>> parts(chunk_count(lattice_.size(), corners_per_chunk));
        for_corners([&](Index c) {
            if (side_[c] == unknown || corner_cost(c, side_[c]) == 0) return;
            auto& part = parts[c / corners_per_chunk];
            part.push_back(c);
            for_neighbors(c, [&](Index n) {
                if (side_[n] != unknown) part.push_back(n);
            });
        });
        std::vector<Index> corners = joined(parts);
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        return corners;
    }

    /// Doubtful corners change sides while that helps. Corners of one colour of the chessboard share no edge,
    /// so their order does not matter.
    void settle() {
        const std::vector<Index> corners = doubtful();
        std::vector<std::uint8_t> changed(corners.size());
        for (int round = 0; round < rounds; ++round) {
            std::fill(changed.begin(), changed.end(), 0);
            for (int colour : {0, 1})
                for_chunks(corners.size(), 512, [&](std::size_t begin, std::size_t end, std::size_t) {
                    for (std::size_t k = begin; k < end; ++k) {
                        const Index c = corners[k];
                        const VoxelCoord v = lattice_.coord(c);
                        if (((v[0] + v[1] + v[2]) & 1) != colour) continue;
                        const Side other = 1 - side_[c];
                        if (corner_cost(c, other) + 1e-9 >= corner_cost(c, side_[c])) continue;
                        side_[c] = other;
                        changed[k] = 1;
                    }
                });
            if (std::find(changed.begin(), changed.end(), 1) == changed.end()) break;
        }
    }

    /// Appends an edge's crossings.
    void choose(Index edge, std::vector<Crossing>& out, std::size_t& changes) const {
        const Index begin = list_.first[edge], end = list_.first[edge + 1];
        const Index upper = lattice_.next[edge / 3][edge % 3];
        const Side low = side_[edge / 3], high = upper == no_index ? unknown : side_[upper];
        if (low == unknown || high == unknown) {
            for (Index x = begin; x < end; ++x)
                if (standing_[x]) out.push_back(list_.crossings[x]);
            return;
        }
        const Side reached = choice_.choose(edge, low, high, [&](Index x, bool taken) {
            if (taken) out.push_back(list_.crossings[x]);
            changes += taken != (standing_[x] != 0);
        });
        if (reached != high && invent(edge, reached == inside, out)) ++changes;
    }

    /// A crossing where the plane of the nearest set comes nearest to crossing the edge.
    bool invent(Index edge, bool leaving, std::vector<Crossing>& out) const {
        const unsigned axis = edge % 3;
        const Index ends[2] = {edge / 3, lattice_.next[edge / 3][axis]};
        const VoxelCoord c = lattice_.coord(ends[0]);
        const Vec3 low = Vec3(c[0], c[1], c[2]) * h_;
        Vec3 middle = low;
        middle[axis] += 0.5 * h_;
        double nearest = impossible;
        Index set = no_index;
        for (Index end : ends)
            for (const SheetMember& m : sheets_.members_at(end)) {
                const NormalSet& s = sets_.sets[m.set];
                if ((s.normal[axis] > 0) != leaving) continue;
                const double d = (s.centroid - middle).sqrnorm();
                if (d < nearest || (d == nearest && m.set < set)) nearest = d, set = m.set;
            }
        if (set == no_index) return false;
        const NormalSet& s = sets_.sets[set];
        const double rise = s.normal[axis] * h_;
        double t = rise == 0 ? 0.5 : (s.normal | (s.centroid - low)) / rise;
        t = std::clamp(t, 0.01, 0.99);
        if (!out.empty() && out.back().edge == edge) t = std::max(t, out.back().t);
        out.push_back({t, s.normal, edge, set, leaving, false});
        return true;
    }

    Crossings chosen() const {
        Crossings result;
        result.dropped_beyond_crease = list_.dropped_beyond_crease;
        result.first.assign(3 * lattice_.size() + 1, 0);
        std::vector<std::vector<Crossing>> parts(chunk_count(lattice_.size(), corners_per_chunk));
        std::vector<std::size_t> changes(parts.size());
        for_chunks(lattice_.size(), corners_per_chunk,
                   [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                       for (std::size_t edge = 3 * begin; edge < 3 * end; ++edge) {
                           const std::size_t before = parts[chunk].size();
                           choose(static_cast<Index>(edge), parts[chunk], changes[chunk]);
                           result.first[edge + 1] = static_cast<Index>(parts[chunk].size() - before);
                       }
                   });
        result.crossings = joined(parts);
        counts_to_first(result.first);
        for (std::size_t n : changes) result.settled += n;
        return result;
    }

    const CornerLattice& lattice_;
    const LocalSheets& sheets_;
    const NormalSets& sets_;
    const Crossings& list_;
    const std::vector<std::uint8_t>& standing_;
    EdgeChoice choice_;
    double h_;
    std::vector<Side> side_;
    std::vector<std::array<Index, 3>> below_;
};

} // namespace

Crossings settle_crossings(const CornerLattice& lattice, const LocalSheets& sheets, const NormalSets& sets,
                           const CrossingCandidates& candidates, double voxel_size) {
    return Settlement(lattice, sheets, sets, candidates, voxel_size).run();
}

} // namespace hsdm
