#include "hsdm/contour/trim_crossings.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <utility>

namespace hsdm {
namespace {

/// The boundary loops that the mesh will have.
struct OpenLoops {
    std::vector<Index> of_side;        ///< per side, its loop; no_index: it has a twin
    std::vector<std::ptrdiff_t> sides; ///< per loop, how many sides it has
};

/// `open`: the crossings with sides that have no twin.
OpenLoops find_open_loops(const Crossings& crossings, const Links& links, const std::vector<Index>& open) {
    // The next open side of the loop: rotates round the vertex at this side's end, face by face.
    const auto next = [&](FacetSide side) {
        FacetCorner end = crossings.of(side).leaving ? side.next() : side;
        for (;;) {
            side = end.other_side(side);
            const FacetSide twin = links.of(side).twin;
            if (twin == no_side) return side;
            end = across(end, side, twin);
            side = twin;
        }
    };
    OpenLoops loops;
    assign_large(loops.of_side, 4 * links.of_crossing.size(), no_index);
    for (const Index x : open)
        for (const FacetSide start : corners_of_facet(x)) {
            if (!links.of(start).open() || loops.of_side[start.number()] != no_index) continue;
            const auto number = static_cast<Index>(loops.sides.size());
            loops.sides.push_back(0);
            for (FacetSide side = start; loops.of_side[side.number()] == no_index; side = next(side)) {
                loops.of_side[side.number()] = number;
                ++loops.sides[number];
            }
        }
    return loops;
}

/// A connected patch of unsupported crossings, and its perimeter.
struct Patch {
    std::vector<Index> crossings;
    std::vector<Index> open;      ///< the loop of each of its open sides; ascending
    std::ptrdiff_t bordering = 0; ///< sides joined to supported crossings
};

/// The patches that touch a boundary loop.
std::vector<Patch> find_patches(const Crossings& crossings, const Links& links,
                                const std::vector<Index>& open, const OpenLoops& loops) {
    const auto& list = crossings.crossings;
    std::vector<Patch> patches;
    std::vector<std::uint8_t> seen(list.size(), 0);
    for (const Index start : open) {
        if (list[start].supported || seen[start]) continue;
        Patch patch{{start}, {}};
        seen[start] = 1;
        for (std::size_t i = 0; i < patch.crossings.size(); ++i)
            for (const FacetSide side : corners_of_facet(patch.crossings[i])) {
                const FacetSide twin = links.of(side).twin;
                if (twin == no_side)
                    patch.open.push_back(loops.of_side[side.number()]);
                else if (crossings.of(twin).supported)
                    ++patch.bordering;
                else if (!std::exchange(seen[twin.crossing()], std::uint8_t{1}))
                    patch.crossings.push_back(twin.crossing());
            }
        std::sort(patch.open.begin(), patch.open.end());
        patches.push_back(std::move(patch));
    }
    return patches;
}

/// Per loop, is it a border rather than a defect? Both its own length counts and that of the hole in the
/// data, that is the loop without the patches beside it (at the open end of a pipe the surface may run on
/// beyond the data).
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
        is_border[l] = loops.sides[l] > pairing::longest_defect || outline[l] > pairing::longest_outline;
    return is_border;
}

/// Is a patch to be dropped? At a border always; at a mere defect only if the boundary gets shorter, as for a
/// fin or a splinter.
bool ends_beyond(const Patch& patch, std::span<const std::uint8_t> is_border) {
    return std::any_of(patch.open.begin(), patch.open.end(), [&](Index loop) { return is_border[loop] != 0; })
           || patch.bordering < std::ssize(patch.open);
}

/// Removes marked crossings; returns how many.
std::size_t remove_crossings(std::span<const std::uint8_t> removed, Crossings& crossings) {
    if (std::ranges::find(removed, 1) == removed.end()) return 0; // mostly
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

std::size_t trim_unsupported(Crossings& crossings, const Links& links, bool all_round) {
    auto& list = crossings.crossings;
    const std::vector<Index> open = indices_where(list.size(), chunks::quick, [&](Index x) {
        return std::ranges::any_of(links.of_crossing[x], &Link::open);
    });
    for (const Index x : open) {
        // Such a crossing is attached by one side at most.
        if (std::ranges::count_if(links.of_crossing[x], &Link::open) >= 3) list[x].supported = false;
    }
    const OpenLoops loops = find_open_loops(crossings, links, open);
    const std::vector<Patch> patches = find_patches(crossings, links, open, loops);
    const std::vector<std::uint8_t> is_border =
        all_round ? std::vector<std::uint8_t>(loops.sides.size(), 0) : find_borders(loops, patches);
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
    const std::vector<Index> tips = indices_where(list.size(), chunks::quick, [&](Index x) {
        if (x + 1 == list.size() || list[x].edge != list[x + 1].edge) return false;
        const auto joined = std::ranges::count_if(
            links.of_crossing[x], [&](const Link& link) { return link.twin.crossing() == x + 1; });
        return joined >= 3 && !are_sides(list[x], list[x + 1]);
    });
    std::vector<std::uint8_t> removed(list.size(), 0);
    for (const Index x : tips) removed[x] = removed[x + 1] = 1;
    const std::size_t count = remove_crossings(removed, crossings);
    crossings.tips += count / 2;
    return count / 2;
}

} // namespace hsdm
