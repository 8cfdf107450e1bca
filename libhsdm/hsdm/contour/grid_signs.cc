#include "hsdm/contour/grid_signs.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/minimum_cut.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace hsdm {
namespace {

// Costs are in units of one supported crossing dropped.
constexpr double impossible = 1e30;

// Of two sides that cost the same a grid point keeps the one it had.
constexpr double tie = 1e-5;

using Side = std::uint8_t;
constexpr Side inner_side = 0, outer_side = 1, unknown = 2; // the labels of cheapest_labels

/// The cheapest choice among an edge's crossings that alternates from one given side to the other (dynamic
/// programming along the edge).
class EdgeChoice {
public:
    explicit EdgeChoice(const Crossings& candidates) : list_(candidates) {}

    static constexpr std::size_t most = 128; // sheets of an edge

    /// Cost of dropping a standing crossing.
    double weight(Index x) const { return list_.crossings[x].supported ? 1 : signs::cost_of_weak; }
    double cost_of_taking(Index x) const {
        return list_.crossings[x].standing ? 0 : signs::cost_of_return * list_.crossings[x].sureness;
    }
    double cost_of_leaving(Index x) const { return list_.crossings[x].standing ? weight(x) : 0; }
    Side side_before(Index x) const { return list_.crossings[x].leaving ? inner_side : outer_side; }

    double cost(Index edge, Side low, Side high, double invention) const {
        std::array<double, 2> after = at_upper_end(high, invention);
        for (Index x = list_.first[edge + 1]; x-- > list_.first[edge];) after = before(x, after);
        return after[low];
    }

    /// Calls take(x, taken) for every crossing, lowest first; returns the side beyond the last.
    template <class Take>
    Side choose(Index edge, Side low, Side high, double invention, Take&& take) const {
        const Index begin = list_.first[edge];
        const std::size_t n = list_.first[edge + 1] - begin;
        std::array<std::array<double, 2>, most + 1> after;
        after[n] = at_upper_end(high, invention);
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
    static std::array<double, 2> at_upper_end(Side high, double invention) {
        return {high == inner_side ? 0 : invention, high == outer_side ? 0 : invention};
    }

    /// Least cost from each side before a crossing to the edge's upper end, given those after it.
    std::array<double, 2> before(Index x, const std::array<double, 2>& after) const {
        const Side from = side_before(x), to = 1 - from;
        std::array<double, 2> cost{after[0] + cost_of_leaving(x), after[1] + cost_of_leaving(x)};
        cost[from] = std::min(cost[from], after[to] + cost_of_taking(x));
        return cost;
    }

    const Crossings& list_;
};

/// Inserts invented crossings; both lists ascend by edge, and an invented one is the last of its edge.
void insert(const std::vector<Crossing>& invented, std::vector<Crossing>& crossings) {
    auto left = crossings.size();
    resize_unwritten(crossings, left + invented.size());
    const auto begin = crossings.begin();
    const auto at = [&](std::size_t i) { return begin + static_cast<std::ptrdiff_t>(i); };
    for (std::size_t i = invented.size(); i-- > 0;) { // from the end, so that nothing is in the way
        const auto later = std::upper_bound(begin, at(left), invented[i].edge,
                                            [](Index edge, const Crossing& x) { return edge < x.edge; });
        std::move_backward(later, at(left), at(left + i + 1));
        left = static_cast<std::size_t>(later - begin);
        crossings[left + i] = invented[i];
    }
}

/// Chooses the sides of the grid points, then the crossings.
class SignLabelling {
public:
    SignLabelling(const GridPoints& grid, std::vector<double> beliefs, const NormalSets& sets,
                  Crossings&& candidates, double voxel_size, bool all_round)
        : grid_(grid),
          sets_(sets),
          list_(std::move(candidates)),
          choice_(list_),
          h_(voxel_size),
          cost_of_border_(all_round ? 2 * signs::cost_of_belief : signs::cost_of_belief),
          side_(large_vector<Side>(grid.size(), unknown)),
          belief_(std::move(beliefs)),
          below_(grid_points_below(grid)) {}

    Crossings run() {
        vote(true);
        // The last ring settles what no vote reached.
        for (int ring = 0; ring < repeats::few; ++ring) vote(false, ring + 1 < repeats::few);
        settle_doubtful();
        release(belief_);
        choose_all();
        return std::move(list_);
    }

private:
    /// The standing crossing of an edge nearest to one of its ends, or no_index.
    Index nearest_standing(Index edge, bool upper) const {
        const Index n = list_.first[edge + 1] - list_.first[edge];
        for (Index k = 0; k < n; ++k) {
            const Index x = upper ? list_.first[edge + 1] - 1 - k : list_.first[edge] + k;
            if (list_.crossings[x].standing) return x;
        }
        return no_index;
    }

    /// An edge's vote on one of its ends, positive for outside: by its nearest standing crossing, or, without
    /// one, the side of the other end.
    double vote(Index edge, bool upper, Side other, bool carried_only) const {
        const Index x = nearest_standing(edge, upper);
        if (x == no_index) return carried_only || other == unknown ? 0 : other == outer_side ? 1 : -1;
        if (carried_only && !list_.crossings[x].supported) return 0;
        return list_.crossings[x].leaving == upper ? choice_.weight(x) : -choice_.weight(x);
    }

    /// That of the first neighbour that has one, so that it turns with the normals; outside if none has.
    Side side_of_neighbour(Index c) const {
        for (unsigned a = 0; a < 3; ++a)
            for (const Index neighbour : {grid_.next[c][a], below_[c][a]})
                if (neighbour != no_index && side_[neighbour] != unknown) return side_[neighbour];
        return outer_side;
    }

    /// One round of votes for the grid points still unknown: `carried_only`, by crossings that the data
    /// carry; later also by the sides of neighbours, which tell more farther off, where sheets are only
    /// continued. Ties stay unknown if `undecided`, else follow a neighbour: after the last round none is.
    void vote(bool carried_only, bool undecided = true) {
        std::vector<Side> next = side_;
        for_each_index(grid_.size(), chunks::usual, [&](Index c) {
            if (side_[c] != unknown) return;
            double sum = belief_[c];
            for (unsigned a = 0; a < 3; ++a) {
                const Index up = grid_.next[c][a], down = below_[c][a];
                if (up != no_index) sum += vote(3 * c + a, false, side_[up], carried_only);
                if (down != no_index) sum += vote(3 * down + a, true, side_[down], carried_only);
            }
            if (sum != 0)
                next[c] = sum < 0 ? inner_side : outer_side;
            else if (!undecided)
                next[c] = side_of_neighbour(c);
        });
        side_ = std::move(next);
    }

    /// Does the grid end here: is one of the four faces beside the edge missing, or no set seen from its
    /// ends?
    bool is_at_end(Index edge) const {
        const Index lower = edge / 3, upper = grid_.next[lower][edge % 3];
        for (unsigned a : {(edge + 1) % 3, (edge + 2) % 3})
            for (Index end : {lower, upper})
                if (grid_.next[end][a] == no_index || below_[end][a] == no_index) return true;
        return !sees_a_set(lower) && !sees_a_set(upper);
    }
    bool sees_a_set(Index grid_point) const {
        return std::ranges::any_of(grid_.voxels[grid_point], [&](Index voxel) {
            return voxel != no_index && !sets_.of_voxel(voxel).empty();
        });
    }

    double cost_of_invention(Index edge) const {
        return is_at_end(edge) ? cost_of_border_ : 2 * signs::cost_of_belief;
    }

    /// Do the crossings of an edge contradict the sides of its ends?
    bool is_contradicted(Index edge) const {
        const Index c = edge / 3, up = grid_.next[c][edge % 3];
        if (up == no_index) return false;
        if (list_.first[edge] == list_.first[edge + 1]) return side_[c] != side_[up]; // most
        return choice_.cost(edge, side_[c], side_[up], 2 * signs::cost_of_belief) > 0;
    }

    /// The grid points whose sides are in doubt: those at the ends of a contradicted edge, and those around.
    std::vector<Index> doubtful() const {
        const auto add = [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
            for (Index edge = static_cast<Index>(3 * begin); edge < 3 * end; ++edge) {
                if (!is_contradicted(edge)) continue;
                found.push_back(edge / 3);
                found.push_back(grid_.next[edge / 3][edge % 3]);
            }
        };
        std::vector<Index> found = collected<Index>(grid_.size(), chunks::usual, add);
        sort_unique(found);
        for (int ring = 0; ring < signs::rings; ++ring) {
            for (std::size_t i = 0, n = found.size(); i < n; ++i)
                for (unsigned a = 0; a < 3; ++a)
                    for (const Index c : {grid_.next[found[i]][a], below_[found[i]][a]})
                        if (c != no_index) found.push_back(c);
            sort_unique(found);
        }
        return found;
    }

    /// Adds what an edge costs, by the sides of those of its ends that `number` says are in doubt.
    void add_edge(Index edge, const std::vector<Index>& number, LabelCosts& costs) const {
        const Index c = edge / 3, up = grid_.next[c][edge % 3];
        if (up == no_index) return;
        const Index low = number[c], high = number[up];
        const double invention = cost_of_invention(edge);
        const auto cost = [&](Side a, Side b) { return choice_.cost(edge, a, b, invention); };
        if (low == no_index && high != no_index)
            costs.add(high, cost(side_[c], inner_side), cost(side_[c], outer_side));
        else if (high == no_index)
            costs.add(low, cost(inner_side, side_[up]), cost(outer_side, side_[up]));
        else
            costs.add(low, high,
                      {{{cost(inner_side, inner_side), cost(inner_side, outer_side)},
                        {cost(outer_side, inner_side), cost(outer_side, outer_side)}}});
    }

    /// The doubtful grid points get the sides that all together cost least, given those around. An edge's
    /// costs are submodular: each crossing's are, and so is the least sum over what lies between two of them.
    void settle_doubtful() {
        const std::vector<Index> points = doubtful();
        std::vector<Index> number;
        assign_large(number, grid_.size(), no_index);
        for (std::size_t i = 0; i < points.size(); ++i) number[points[i]] = static_cast<Index>(i);
        LabelCosts costs(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Index c = points[i];
            costs.add(static_cast<Index>(i), 0, -belief_[c] + (side_[c] == outer_side ? -tie : tie));
            for (unsigned a = 0; a < 3; ++a) {
                add_edge(3 * c + a, number, costs);
                const Index down = below_[c][a];
                if (down != no_index && number[down] == no_index) add_edge(3 * down + a, number, costs);
            }
        }
        const std::vector<std::uint8_t> sides = cheapest_labels(costs);
        for (std::size_t i = 0; i < points.size(); ++i) side_[points[i]] = sides[i];
    }

    /// Of the crossings of a chunk's edges, those that go on are moved to its front.
    struct Chosen {
        Index begin, end;               ///< of those that stay
        std::vector<Crossing> invented; ///< by edge
        std::size_t changes = 0;        ///< those dropped, restored or invented
    };

    /// Chooses an edge's crossings; returns how many, invented ones included.
    std::uint8_t choose(Index edge, Chosen& chosen) {
        const Index begin = list_.first[edge], end = list_.first[edge + 1], before = chosen.end;
        const Index upper = grid_.next[edge / 3][edge % 3];
        const auto keep = [&](Index x) { list_.crossings[chosen.end++] = list_.crossings[x]; };
        if (upper == no_index) {
            for (Index x = begin; x < end; ++x)
                if (list_.crossings[x].standing) keep(x);
            return static_cast<std::uint8_t>(chosen.end - before);
        }
        const Side low = side_[edge / 3], high = side_[upper];
        if (begin == end && low == high) return 0;                           // most edges
        const double invention = begin == end ? 0 : cost_of_invention(edge); // without any it changes nothing
        const Side reached = choice_.choose(edge, low, high, invention, [&](Index x, bool taken) {
            chosen.changes += taken != list_.crossings[x].standing;
            if (taken) keep(x);
        });
        const auto kept = static_cast<std::uint8_t>(chosen.end - before);
        if (reached == high) return kept;
        const double least = kept > 0 ? list_.crossings[chosen.end - 1].t : 0;
        if (!invent(edge, reached == inner_side, least, chosen.invented)) return kept;
        ++chosen.changes;
        return kept + 1;
    }

    /// Among the sets seen from an edge's ends the one nearest to its middle, with preference for those whose
    /// normals agree with the crossing's direction; no_index if neither end sees a set.
    Index set_near(Index edge, bool leaving, const Vec3& middle, const Vec3& way) const {
        std::tuple<bool, double, Index> best{true, impossible, no_index};
        SheetMembers members;
        for (Index end : {edge / 3, grid_.next[edge / 3][edge % 3]}) {
            members.gather(grid_.voxels[end], sets_);
            for (const SheetMember& m : members) {
                const NormalSet& s = sets_.sets[m.set];
                best = std::min(best,
                                {((s.normal | way) > 0) != leaving, (s.centroid - middle).sqrnorm(), m.set});
            }
        }
        return std::get<2>(best);
    }

    /// Invents a crossing: where the plane of the nearest set crosses the edge, clamped to what of it is
    /// beyond `least`. False if there is no set.
    bool invent(Index edge, bool leaving, double least, std::vector<Crossing>& out) const {
        const Vec3 way = edge_vector(grid_, edge, h_), middle = grid_.position(edge / 3) * h_ + 0.5 * way;
        const Index set = set_near(edge, leaving, middle, way);
        if (set == no_index) return false;
        const NormalSet& s = sets_.sets[set];
        Crossing crossing{0.5, s.normal, edge, set, leaving, false};
        const double rise = s.normal | way;
        if ((rise > 0) == leaving) {
            crossing.t = rise == 0 ? 0.5 : 0.5 + (s.normal | (s.centroid - middle)) / rise;
        } else {
            crossing.normal = leaving ? unit(way) : -unit(way);
        }
        crossing.t = std::max(std::clamp(crossing.t, signs::end_gap, 1 - signs::end_gap), least);
        out.push_back(crossing);
        return true;
    }

    /// Leaves the crossings chosen, in place: most candidates are.
    void choose_all() {
        std::vector<Chosen> chosen(chunk_count(grid_.size(), chunks::usual));
        std::vector<std::uint8_t> count = unwritten_vector<std::uint8_t>(3 * grid_.size());
        for_chunks(grid_.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
            chosen[chunk].begin = chosen[chunk].end = list_.first[3 * begin];
            for (auto edge = static_cast<Index>(3 * begin); edge < 3 * end; ++edge)
                count[edge] = choose(edge, chosen[chunk]);
        });
        for_each_index(count.size(), chunks::light, [&](Index edge) { list_.first[edge + 1] = count[edge]; });
        counts_to_first(list_.first);
        std::vector<Crossing> invented;
        Index kept = 0;
        for_each_in_order(chosen.size(), [&](std::size_t chunk) {
            const Chosen& of = chosen[chunk];
            const auto all = list_.crossings.begin();
            if (of.begin != kept) std::copy(all + of.begin, all + of.end, all + kept);
            kept += of.end - of.begin;
            invented.insert(invented.end(), of.invented.begin(), of.invented.end());
            list_.settled += of.changes;
        });
        list_.crossings.resize(kept);
        insert(invented, list_.crossings);
    }

    const GridPoints& grid_;
    const NormalSets& sets_;
    Crossings list_;
    EdgeChoice choice_; // of `list_`
    double h_, cost_of_border_;
    std::vector<Side> side_;
    std::vector<double> belief_;
    std::vector<std::array<Index, 3>> below_;
};

} // namespace

std::vector<double> beliefs_of_sheets(const LocalSheets& sheets, double voxel_size) {
    std::vector<double> beliefs = unwritten_vector<double>(sheets.first_sheet.size() - 1);
    for_each_index(beliefs.size(), chunks::usual, [&](Index c) {
        double sum = 0, size = 0;
        beliefs[c] = 0;
        for (const LocalSheet& sheet : sheets.sheets_at(c)) {
            if (std::abs(sheet.distance) < sheets::surface_error() * voxel_size * sheet.weight) return;
            sum += sheet.distance;
            size += std::abs(sheet.distance);
        }
        if (size > 0) beliefs[c] = signs::cost_of_belief * sum / size;
    });
    return beliefs;
}

Crossings label_grid_signs(const GridPoints& grid, std::vector<double> beliefs, const NormalSets& sets,
                           Crossings candidates, double voxel_size, bool all_round) {
    return SignLabelling(grid, std::move(beliefs), sets, std::move(candidates), voxel_size, all_round).run();
}

} // namespace hsdm
