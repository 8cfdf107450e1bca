#include "hsdm/contour/pairing.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

constexpr std::size_t corners_per_chunk = 2048;
/// Sides: a shorter boundary loop is a defect to close, not a border; and the same of the hole in the data
/// around it, whose outline is more ragged.
constexpr std::ptrdiff_t longest_defect = 16, longest_outline = 20;

/// A crossing on the perimeter of a face.
struct Stop {
    Index crossing;
    std::uint8_t ring_face;
    Vec3 position; // voxels, relative to the face's lower corner
};

/// The crossings of one face, sorted by whether the perimeter leaves or enters the solid there.
class FacePairing {
public:
    FacePairing(const CornerLattice& lattice, const Crossings& crossings, const NormalSets& sets,
                const RelationTest& related)
        : lattice_(lattice), crossings_(crossings), sets_(sets), related_(related) {}

    /// Calls join(exit, enter, opposed) for every pair and left_open(stop) for what finds no partner.
    template <class Join, class LeftOpen>
    void pair(Index corner, unsigned normal_axis, Join&& join, LeftOpen&& left_open) {
        exits_.clear();
        enters_.clear();
        gather(corner, normal_axis);
        if (exits_.size() == 1 && enters_.size() == 1) {
            join(exits_[0], enters_[0], opposed(of(exits_[0]), of(enters_[0])));
            return;
        }
        while (!exits_.empty() && !enters_.empty()) join_best(join);
        for (const Stop& s : exits_) left_open(s);
        for (const Stop& s : enters_) left_open(s);
    }

private:
    void gather(Index corner, unsigned n) {
        const unsigned u = (n + 1) % 3, v = (n + 2) % 3;
        const Index pu = lattice_.next[corner][u], pv = lattice_.next[corner][v];
        add(corner, u, 1, true, 0, v);
        add(corner, v, 2, false, 0, u);
        if (pu != no_index) add(pu, v, 0, true, 1, u);
        if (pv != no_index) add(pv, u, 3, false, 1, v);
    }

    void add(Index corner, unsigned axis, std::uint8_t ring_face, bool forward, double across,
             unsigned across_axis) {
        const Index edge = 3 * corner + axis;
        for (Index x = crossings_.first[edge]; x < crossings_.first[edge + 1]; ++x) {
            const Crossing& crossing = crossings_.crossings[x];
            Vec3 position(0, 0, 0);
            position[axis] = crossing.t;
            position[across_axis] = across;
            (crossing.leaving == forward ? exits_ : enters_).push_back({x, ring_face, position});
        }
    }

    const Crossing& of(const Stop& s) const { return crossings_.crossings[s.crossing]; }

    Relation relation(const Stop& a, const Stop& b) const {
        if (of(a).set == of(b).set) return Relation::smooth;
        return related_(sets_.sets[of(a).set], sets_.sets[of(b).set]);
    }

    /// 0 for one sheet, more the less two crossings look like parts of one surface.
    double cost(const Stop& a, const Stop& b) const {
        const Crossing &x = of(a), &y = of(b);
        const Vec3 d = b.position - a.position;
        const double off_plane = std::abs(x.normal | d) + std::abs(y.normal | d);
        const Relation r = relation(a, b);
        return (1 - (x.normal | y.normal)) + off_plane
               + (r == Relation::smooth ? 0
                  : r == Relation::none ? 2
                                        : 1);
    }

    /// Faces with two or more of each kind are rare: the cheapest pair first, ties by number.
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

    const CornerLattice& lattice_;
    const Crossings& crossings_;
    const NormalSets& sets_;
    const RelationTest& related_;
    std::vector<Stop> exits_, enters_;
};

} // namespace

Links pair_crossings(const CornerLattice& lattice, const Crossings& crossings, const NormalSets& sets,
                     const RelationTest& related) {
    Links links;
    links.of_crossing.resize(crossings.crossings.size());
    const std::size_t n = lattice.size();
    std::vector<std::size_t> rims(chunk_count(n, corners_per_chunk), 0), joined_faces(rims);
    std::vector<std::vector<Link>> crowded(rims.size());
    for_chunks(n, corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        FacePairing face(lattice, crossings, sets, related);
        std::vector<Link> in_face;
        auto join = [&](const Stop& a, const Stop& b, bool rim) {
            links.of_crossing[a.crossing][a.ring_face] = {b.crossing, b.ring_face, rim};
            links.of_crossing[b.crossing][b.ring_face] = {a.crossing, a.ring_face, rim};
            rims[chunk] += rim;
            ++joined_faces[chunk];
            in_face.push_back({a.crossing, a.ring_face, rim});
        };
        auto left_open = [&](const Stop& s) { in_face.push_back({s.crossing, s.ring_face, false}); };
        for (std::size_t c = begin; c < end; ++c)
            for (unsigned axis = 0; axis < 3; ++axis) {
                in_face.clear();
                face.pair(static_cast<Index>(c), axis, join, left_open);
                if (in_face.size() < 2) continue;
                crowded[chunk].insert(crowded[chunk].end(), in_face.begin(), in_face.end());
                crowded[chunk].push_back({});
            }
    });
    links.crowded = joined(crowded);
    for (std::size_t r : rims) links.rims += r;
    links.open = 4 * links.of_crossing.size();
    for (std::size_t j : joined_faces) links.open -= 2 * j;
    return links;
}

namespace {

bool is_open(const Link& link) {
    return link.crossing == no_index;
}

/// The boundary loops of the mesh to be.
struct OpenLoops {
    std::vector<Index> of_side;        ///< per side (4 * crossing + face); no_index: joined
    std::vector<std::ptrdiff_t> sides; ///< per loop
};

OpenLoops find_open_loops(const Crossings& crossings, const Links& links) {
    const auto open = [&](std::size_t side) { return is_open(links.of_crossing[side / 4][side % 4]); };
    // From an open side round the vertex at its end, face by face, to the next open one.
    const auto next = [&](std::size_t side) {
        auto k = static_cast<unsigned>(side % 4);
        auto x = static_cast<Index>(side / 4);
        unsigned j = crossings.crossings[x].leaving ? (k + 1) % 4 : k; // where the side ends
        for (;;) {
            k = k == j ? (j + 3) % 4 : j;
            const Link& link = links.of_crossing[x][k];
            if (link.crossing == no_index) return 4 * std::size_t{x} + k;
            j = Ring::across(j, k, link.face);
            x = link.crossing;
            k = link.face;
        }
    };
    OpenLoops loops;
    loops.of_side.assign(4 * links.of_crossing.size(), no_index);
    for (std::size_t start = 0; start < loops.of_side.size(); ++start) {
        if (!open(start) || loops.of_side[start] != no_index) continue;
        const auto number = static_cast<Index>(loops.sides.size());
        loops.sides.push_back(0);
        for (std::size_t side = start; loops.of_side[side] == no_index; side = next(side)) {
            loops.of_side[side] = number;
            ++loops.sides[number];
        }
    }
    return loops;
}

/// A connected patch of crossings that the data do not carry, and what its sides are.
struct Patch {
    std::vector<Index> crossings;
    std::vector<Index> open;      ///< of each open side, the loop; ascending
    std::ptrdiff_t bordering = 0; ///< sides joined to crossings that the data carry
};

/// Patches that a boundary loop reaches.
std::vector<Patch> find_patches(const Crossings& crossings, const Links& links, const OpenLoops& loops) {
    const auto& list = crossings.crossings;
    std::vector<Patch> patches;
    std::vector<std::uint8_t> seen(list.size(), 0);
    for (Index start = 0; start < list.size(); ++start) {
        const auto& around = links.of_crossing[start];
        if (list[start].supported || seen[start] || std::none_of(around.begin(), around.end(), is_open))
            continue;
        Patch patch{{start}, {}};
        seen[start] = 1;
        for (std::size_t i = 0; i < patch.crossings.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) {
                const std::size_t side = 4 * std::size_t{patch.crossings[i]} + k;
                const Index other = links.of_crossing[side / 4][k].crossing;
                if (other == no_index)
                    patch.open.push_back(loops.of_side[side]);
                else if (list[other].supported)
                    ++patch.bordering;
                else if (!std::exchange(seen[other], std::uint8_t{1}))
                    patch.crossings.push_back(other);
            }
        std::sort(patch.open.begin(), patch.open.end());
        patches.push_back(std::move(patch));
    }
    return patches;
}

/// Per loop, is it too long for a mere defect? What counts is the hole in the data: of a pipe's end that the
/// surface runs on beyond, the sides that the loop has without the patches beside it.
std::vector<std::uint8_t> find_borders(const OpenLoops& loops, const std::vector<Patch>& patches) {
    std::vector<std::ptrdiff_t> outline = loops.sides;
    for (const Patch& patch : patches)
        for (auto at = patch.open.begin(); at != patch.open.end();) {
            const auto end = std::upper_bound(at, patch.open.end(), *at);
            outline[*at] += patch.bordering - (end - at);
            at = end;
        }
    std::vector<std::uint8_t> is_border(outline.size());
    for (std::size_t l = 0; l < outline.size(); ++l)
        is_border[l] = loops.sides[l] > longest_defect || outline[l] > longest_outline;
    return is_border;
}

/// Is a patch to be taken back? Beyond a border always; beside a mere defect only if the boundary gets
/// shorter, as it does for a fin or a splinter.
bool ends_beyond(const Patch& patch, std::span<const std::uint8_t> is_border) {
    return std::any_of(patch.open.begin(), patch.open.end(), [&](Index loop) { return is_border[loop] != 0; })
           || patch.bordering < std::ssize(patch.open);
}

/// Returns how many.
std::size_t remove_crossings(std::span<const std::uint8_t> removed, Crossings& crossings) {
    auto& list = crossings.crossings;
    std::size_t kept = 0;
    for (std::size_t e = 0, x = 0; e + 1 < crossings.first.size(); ++e) {
        const std::size_t end = crossings.first[e + 1];
        crossings.first[e] = static_cast<Index>(kept);
        for (; x < end; ++x)
            if (!removed[x]) list[kept++] = list[x];
    }
    crossings.first.back() = static_cast<Index>(kept);
    const std::size_t count = list.size() - kept;
    list.resize(kept);
    return count;
}

} // namespace

std::size_t trim_unsupported(Crossings& crossings, const Links& links) {
    auto& list = crossings.crossings;
    for (Index x = 0; x < list.size(); ++x) {
        const auto& around = links.of_crossing[x];
        // Hangs by one side at most.
        if (std::count_if(around.begin(), around.end(), is_open) >= 3) list[x].supported = false;
    }
    const OpenLoops loops = find_open_loops(crossings, links);
    const std::vector<Patch> patches = find_patches(crossings, links, loops);
    const std::vector<std::uint8_t> is_border = find_borders(loops, patches);
    std::vector<std::uint8_t> removed(list.size(), 0);
    for (const Patch& patch : patches)
        if (ends_beyond(patch, is_border))
            for (Index x : patch.crossings) removed[x] = 1;
    const std::size_t count = remove_crossings(removed, crossings);
    crossings.trimmed += count;
    return count;
}

std::size_t drop_tips(const NormalSets& sets, const RelationTest& related, const Links& links,
                      Crossings& crossings) {
    const auto& list = crossings.crossings;
    const auto are_sides = [&](const Crossing& x, const Crossing& y) {
        return opposed(x, y) && related(sets.sets[x.set], sets.sets[y.set]) == Relation::none;
    };
    std::vector<std::uint8_t> removed(list.size(), 0);
    for (Index x = 0; x + 1 < list.size(); ++x) {
        if (list[x].edge != list[x + 1].edge) continue;
        const auto& around = links.of_crossing[x];
        const auto joined = std::count_if(around.begin(), around.end(),
                                          [&](const Link& link) { return link.crossing == x + 1; });
        if (joined >= 3 && !are_sides(list[x], list[x + 1])) removed[x] = removed[x + 1] = 1;
    }
    const std::size_t count = remove_crossings(removed, crossings);
    crossings.tips += count / 2;
    return count / 2;
}

} // namespace hsdm
