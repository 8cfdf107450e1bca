#include "hsdm/contour/crossing_pairs.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/sets_round_face.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// A crossing on the perimeter of a face.
struct Stop {
    FacetSide side; // of its facet, through the face
    Vec3 position;  // voxels, relative to the face's lower corner
    bool exit;      // does the perimeter leave the solid there?
};

/// Pairs the crossings round one face.
class FacePairing {
public:
    FacePairing(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                const RelationTest& related)
        : grid_(grid), crossings_(crossings), sets_(sets), related_(related), around_(grid, sets, related) {}

    /// Calls join(exit, enter, opposed) for every pair and left_open(stop) for every crossing without a
    /// partner.
    template <class Join, class LeftOpen>
    void pair(Index grid_point, unsigned normal_axis, Join&& join, LeftOpen&& left_open) {
        stops_.clear();
        gather(grid_point, normal_axis);
        if (stops_.size() == 2 && stops_[0].exit != stops_[1].exit) {
            join_two(stops_[0], stops_[1], join);
            return;
        }
        if (stops_.size() < 2) {
            for (const Stop& s : stops_) left_open(s);
            return;
        }
        crowded_ = around_.gather(grid_point, normal_axis);
        find_best();
        take(0, stops_.size(), join, left_open);
    }

private:
    /// In order round the face.
    void gather(Index grid_point, unsigned n) {
        const unsigned u = (n + 1) % 3, v = (n + 2) % 3;
        const Index pu = grid_.next[grid_point][u], pv = grid_.next[grid_point][v];
        add(grid_point, u, 1, true, 0, v);
        if (pu != no_index) add(pu, v, 0, true, 1, u);
        if (pv != no_index) add(pv, u, 3, false, 1, v);
        add(grid_point, v, 2, false, 0, u);
    }

    void add(Index grid_point, unsigned axis, unsigned side, bool forward, double across,
             unsigned across_axis) {
        const Index edge = 3 * grid_point + axis;
        const std::size_t first = stops_.size();
        for (Index x = crossings_.first[edge]; x < crossings_.first[edge + 1]; ++x) {
            const Crossing& crossing = crossings_.crossings[x];
            Vec3 position(0, 0, 0);
            position[axis] = crossing.t;
            position[across_axis] = across;
            if (!crossings_.moved.empty()) position += crossings_.offset_of(crossing);
            stops_.push_back({{x, side}, position, crossing.leaving == forward});
        }
        if (!forward) std::reverse(stops_.begin() + static_cast<std::ptrdiff_t>(first), stops_.end());
    }

    const Crossing& of(const Stop& s) const { return crossings_.of(s.side); }

    Relation relation(const Stop& a, const Stop& b) const {
        if (of(a).set == of(b).set) return Relation::smooth;
        return related_(sets_.sets[of(a).set], sets_.sets[of(b).set]);
    }

    /// 0 for two crossings of one flat sheet; the larger, the less they look like parts of one surface.
    double cost(const Stop& a, const Stop& b) const {
        const Crossing &x = of(a), &y = of(b);
        const double cosine = x.normal | y.normal;
        if (crowded_ && cosine > angles::facing && around_.parted(x.set, y.set))
            return pairing::cost_of_parted;
        const Vec3 d = b.position - a.position;
        const double off_plane = std::abs(x.normal | d) + std::abs(y.normal | d);
        const Relation r = relation(a, b);
        const bool crease = (r == Relation::convex || r == Relation::concave)
                            || (crowded_ && opposed(x, y) && around_.joined_by_rim(x.set, y.set));
        return (1 - cosine) + off_plane
               + (crease                  ? pairing::cost_of_crease
                  : r == Relation::smooth ? 0
                                          : 2 * pairing::cost_of_crease);
    }

    /// Of all ways to pair the crossings without a link that crosses another the one of least cost, by
    /// intervals of the perimeter: best_ and partner_ are of those from a row's crossing to before a
    /// column's.
    void find_best() {
        const std::size_t n = stops_.size();
        costs_.resize(n * n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = i + 1; k < n; ++k)
                if (stops_[i].exit != stops_[k].exit) costs_[i * n + k] = cost(stops_[i], stops_[k]);
        best_.assign((n + 1) * (n + 1), 0);
        partner_.resize((n + 1) * (n + 1));
        const auto at = [&](std::size_t begin, std::size_t end) { return begin * (n + 1) + end; };
        for (std::size_t begin = n; begin-- > 0;)
            for (std::size_t end = begin + 1; end <= n; ++end) {
                double least = pairing::cost_of_open + best_[at(begin + 1, end)];
                std::size_t with = n;
                for (std::size_t k = begin + 1; k < end; ++k) {
                    if (stops_[k].exit == stops_[begin].exit) continue;
                    const double c = costs_[begin * n + k] + best_[at(begin + 1, k)] + best_[at(k + 1, end)];
                    if (c < least) least = c, with = k;
                }
                best_[at(begin, end)] = least;
                partner_[at(begin, end)] = with;
            }
    }

    template <class Join>
    void join_two(const Stop& a, const Stop& b, Join& join) const {
        join(a.exit ? a : b, a.exit ? b : a, opposed(of(a), of(b)));
    }

    template <class Join, class LeftOpen>
    void take(std::size_t begin, std::size_t end, Join& join, LeftOpen& left_open) {
        while (begin < end) {
            const std::size_t k = partner_[begin * (stops_.size() + 1) + end];
            if (k == stops_.size()) {
                left_open(stops_[begin]);
                ++begin;
                continue;
            }
            join_two(stops_[begin], stops_[k], join);
            take(begin + 1, k, join, left_open);
            begin = k + 1;
        }
    }

    const GridPoints& grid_;
    const Crossings& crossings_;
    const NormalSets& sets_;
    const RelationTest& related_;
    SetsRoundFace around_;
    bool crowded_ = false; // does a wall or gap part sets round the face?
    std::vector<Stop> stops_;
    std::vector<double> costs_, best_;
    std::vector<std::size_t> partner_;
};

} // namespace

Links pair_crossings(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                     const RelationTest& related) {
    Links links;
    resize_large(links.of_crossing, crossings.crossings.size());
    const auto pair = [&](std::size_t c, std::size_t end, std::vector<FacetSide>& crowded) {
        FacePairing face(grid, crossings, sets, related);
        std::vector<FacetSide> in_face;
        auto join = [&](const Stop& a, const Stop& b, bool rim) {
            links.of(a.side) = {b.side, rim};
            links.of(b.side) = {a.side, rim};
            in_face.push_back(a.side);
        };
        auto left_open = [&](const Stop& s) { in_face.push_back(s.side); };
        for (; c < end; ++c)
            for (unsigned axis = 0; axis < 3; ++axis) {
                in_face.clear();
                face.pair(static_cast<Index>(c), axis, join, left_open);
                if (in_face.size() < 2) continue;
                crowded.insert(crowded.end(), in_face.begin(), in_face.end());
                crowded.push_back(no_side);
            }
    };
    links.crowded = collected<FacetSide>(grid.size(), chunks::usual, pair);
    return links;
}

} // namespace hsdm
