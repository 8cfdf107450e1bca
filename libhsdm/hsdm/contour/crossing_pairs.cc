#include "hsdm/contour/crossing_pairs.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// A crossing on the perimeter of a face.
struct Stop {
    FacetSide side; // of its facet, through the face
    Vec3 position;  // voxels, relative to the face's lower corner
};

/// The crossings of one face, sorted by whether the perimeter leaves or enters the solid there.
class FacePairing {
public:
    FacePairing(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                const RelationTest& related)
        : grid_(grid), crossings_(crossings), sets_(sets), related_(related) {}

    /// Calls join(exit, enter, opposed) for every pair and left_open(stop) for every crossing without a
    /// partner.
    template <class Join, class LeftOpen>
    void pair(Index grid_point, unsigned normal_axis, Join&& join, LeftOpen&& left_open) {
        exits_.clear();
        enters_.clear();
        gather(grid_point, normal_axis);
        if (exits_.size() == 1 && enters_.size() == 1) {
            join(exits_[0], enters_[0], opposed(of(exits_[0]), of(enters_[0])));
            return;
        }
        while (!exits_.empty() && !enters_.empty()) join_best(join);
        for (const Stop& s : exits_) left_open(s);
        for (const Stop& s : enters_) left_open(s);
    }

private:
    void gather(Index grid_point, unsigned n) {
        const unsigned u = (n + 1) % 3, v = (n + 2) % 3;
        const Index pu = grid_.next[grid_point][u], pv = grid_.next[grid_point][v];
        add(grid_point, u, 1, true, 0, v);
        add(grid_point, v, 2, false, 0, u);
        if (pu != no_index) add(pu, v, 0, true, 1, u);
        if (pv != no_index) add(pv, u, 3, false, 1, v);
    }

    void add(Index grid_point, unsigned axis, unsigned side, bool forward, double across,
             unsigned across_axis) {
        const Index edge = 3 * grid_point + axis;
        for (Index x = crossings_.first[edge]; x < crossings_.first[edge + 1]; ++x) {
            const Crossing& crossing = crossings_.crossings[x];
            Vec3 position(0, 0, 0);
            position[axis] = crossing.t;
            position[across_axis] = across;
            (crossing.leaving == forward ? exits_ : enters_).push_back({{x, side}, position});
        }
    }

    const Crossing& of(const Stop& s) const { return crossings_.of(s.side); }

    Relation relation(const Stop& a, const Stop& b) const {
        if (of(a).set == of(b).set) return Relation::smooth;
        return related_(sets_.sets[of(a).set], sets_.sets[of(b).set]);
    }

    /// 0 for two crossings of one flat sheet; the larger, the less they look like parts of one surface.
    double cost(const Stop& a, const Stop& b) const {
        const Crossing &x = of(a), &y = of(b);
        const Vec3 d = b.position - a.position;
        const double off_plane = std::abs(x.normal | d) + std::abs(y.normal | d);
        const Relation r = relation(a, b);
        return (1 - (x.normal | y.normal)) + off_plane
               + (r == Relation::smooth ? 0
                  : r == Relation::none ? pairing::cost_of_strangers
                                        : pairing::cost_of_crease);
    }

    /// Joins one pair: of two exits and two enters, one of the better pairing; of more (rare) the cheapest
    /// pair, ties by number.
    template <class Join>
    void join_best(Join&& join) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t best_exit = 0, best_enter = 0;
        if (exits_.size() == 2 && enters_.size() == 2) { // exactly: the better of the two pairings
            const double straight = cost(exits_[0], enters_[0]) + cost(exits_[1], enters_[1]);
            const double swapped = cost(exits_[0], enters_[1]) + cost(exits_[1], enters_[0]);
            best_enter = straight <= swapped ? 0 : 1;
        } else {
            for (std::size_t i = 0; i < exits_.size(); ++i)
                for (std::size_t j = 0; j < enters_.size(); ++j)
                    if (const double c = cost(exits_[i], enters_[j]); c < least)
                        least = c, best_exit = i, best_enter = j;
        }
        const Stop &exit = exits_[best_exit], &enter = enters_[best_enter];
        join(exit, enter, opposed(of(exit), of(enter)));
        exits_.erase(exits_.begin() + static_cast<std::ptrdiff_t>(best_exit));
        enters_.erase(enters_.begin() + static_cast<std::ptrdiff_t>(best_enter));
    }

    const GridPoints& grid_;
    const Crossings& crossings_;
    const NormalSets& sets_;
    const RelationTest& related_;
    std::vector<Stop> exits_, enters_;
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
