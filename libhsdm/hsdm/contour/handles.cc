#include "hsdm/contour/handles.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/ring_search.hh"
#include "hsdm/contour/witnesses.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/copy_vertex.hh"
#include "hsdm/mesh/split_polygon.hh"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

namespace hsdm {
namespace {

/// Has a vertex's voxel sets, and none whose plane passes the facet and faces the same way?
bool is_contradicted(const PolygonMesh& mesh, Index f, const NormalSets& sets, std::span<const Index> voxel,
                     double voxel_size) {
    const auto facet = mesh.facet(f);
    const Vec3 area = area_vector(mesh, facet);
    const double length = area.norm();
    if (!(length > 0)) return false;
    const Vec3 centre = centroid(mesh, facet);
    bool any = false;
    for (const Index v : facet)
        for (const NormalSet& set : sets.of_voxel(voxel[mesh.origin[v]])) {
            any = true;
            if ((set.normal | area) > angles::facing * length
                && std::abs(set.normal | (centre - set.centroid)) < handles::agreeing_gap * voxel_size)
                return false;
        }
    return any;
}

/// Do two sets of a voxel face apart or each other, more than across, as the sides of a wall or gap do?
bool has_wall(std::span<const NormalSet> sets) {
    for (std::size_t i = 1; i < sets.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if ((sets[i].normal | sets[j].normal) <= -angles::halfway) return true;
    return false;
}

/// Per voxel whether a wall or gap passes it, between several vertices: what joins its two sides there may
/// not be the part's.
std::vector<std::uint8_t> voxels_of_walls(const NormalSets& sets, std::span<const Index> voxel,
                                          const PolygonMesh& mesh) {
    std::vector<std::uint8_t> result(sets.first.size() - 1, 0);
    for (const Index origin : mesh.origin) result[voxel[origin]] += result[voxel[origin]] < 2;
    for_each_index(result.size(), chunks::usual,
                   [&](Index v) { result[v] = result[v] > 1 && has_wall(sets.of_voxel(v)); });
    return result;
}

/// A ring that is to be cut.
struct Ring {
    std::vector<Index> vertices, sides;
};

/// What is asked about rings, by all threads; what they find out is the same whoever does.
class RingQuestions {
public:
    RingQuestions(const VertexFans& around, const Witnesses& speakers, std::span<const Index> voxel,
                  const PartVoxels& part)
        : fans(around),
          witnesses(speakers),
          voxel_(voxel),
          part_(part),
          spoken_for_(large_vector<std::uint8_t>(around.mesh.facet_count())),
          notes_(large_vector<std::uint32_t>(around.mesh.vertex_count())) {}

    bool is_own(Index vertex) const { return part_.is_part() && part_.owns(voxel_at(vertex)); }
    bool is_far(Index facet) const {
        return part_.is_part() && !std::ranges::all_of(fans.mesh.facet(facet), [&](Index v) {
                   return part_.is_near(voxel_at(v));
               });
    }
    /// Witnesses are heard once for each facet: some twenty rings pass it.
    bool speak_for(Index facet) const {
        enum Answer : std::uint8_t { not_asked, no, yes };
        return known(spoken_for_[facet], [&] { return witnesses.speak_for(facet) ? yes : no; }) == yes;
    }
    /// What find() tells of a vertex, other than 0; kept.
    template <class Find>
    std::uint32_t note(Index vertex, Find&& find) const {
        return known(notes_[vertex], find);
    }

    const VertexFans& fans;
    const Witnesses& witnesses;

private:
    Index voxel_at(Index vertex) const { return voxel_[fans.mesh.origin[vertex]]; }

    template <class T, class Find>
    static T known(T& place, Find&& find) {
        const std::atomic_ref<T> kept(place);
        T value = kept.load(std::memory_order_relaxed);
        if (value == T{}) kept.store(value = find(), std::memory_order_relaxed);
        return value;
    }

    std::span<const Index> voxel_; // per origin of the mesh's vertices
    const PartVoxels& part_;
    mutable std::vector<std::uint8_t> spoken_for_; // per facet
    mutable std::vector<std::uint32_t> notes_;     // per vertex
};

/// Judges the rings at vertices, one after the other. For one thread.
class RingJudge {
public:
    explicit RingJudge(const RingQuestions& ask) : ask_(ask), fans_(ask.fans), search_(ask.fans) {}

    /// The ring at a vertex, if it is to be cut.
    std::optional<Ring> ring_to_cut(Index root) {
        std::vector<Index> ring = search_.ring_at(root);
        std::vector<Index> sides = fans_.sides_of(ring);
        if (sides.size() < 3) return std::nullopt;
        const Witnesses& witnesses = ask_.witnesses;
        const std::vector<Index> beside = fans_.facets_beside(sides);
        const bool is_denied = witnesses.deny(ring, beside),
                   is_narrow = !is_denied && witnesses.is_narrow(ring);
        const double share = contradicted(beside) / static_cast<double>(2 * sides.size());
        const bool is_contradicted = share >= handles::least_contradicted;
        const bool is_triangle = sides.size() == 3 && share > 0; // four facets go round a bar or bore
        if (!(is_denied || is_narrow || is_triangle || is_contradicted)) return std::nullopt;
        if (!is_denied && (witnesses.surround(ring) || witnesses.are_missing_across(ring, beside)))
            return std::nullopt;
        bool far = false; // behind it last: that takes longest, and reaches farthest
        const bool is_cut = (is_denied || is_narrow || is_triangle || are_contradicted_beside(sides, far))
                            && !bounds(sides, far);
        looked_far_ |= far && ask_.is_own(root);
        if (!is_cut) return std::nullopt;
        return Ring{std::move(ring), std::move(sides)};
    }
    bool looked_far() const { return looked_far_; }

private:
    /// Of the facets beside a ring, how many no points speak for.
    std::uint32_t contradicted(std::span<const Index> beside) const {
        return static_cast<std::uint32_t>(
            std::ranges::count_if(beside, [&](Index f) { return !ask_.speak_for(f); }));
    }

    /// The ring at a vertex as those beside it count it.
    struct Note {
        bool counts = false, looked_far = false;
        std::uint32_t size = 0, contradicted = 0; // sides; facets beside

        std::uint32_t packed() const {
            return 1u | std::uint32_t{counts} << 1 | std::uint32_t{looked_far} << 2 | size << 8
                   | contradicted << 16;
        }
        static Note unpacked(std::uint32_t bits) {
            return {(bits & 2) != 0, (bits & 4) != 0, bits >> 8 & 0xff, bits >> 16};
        }
    };
    Note note_of(Index v) {
        return Note::unpacked(ask_.note(v, [&] {
            const std::vector<Index> sides = fans_.sides_of(search_.ring_at(v));
            if (sides.size() < 3) return Note().packed();
            Note note;
            note.counts = !bounds(sides, note.looked_far);
            note.size = static_cast<std::uint32_t>(sides.size());
            note.contradicted = contradicted(fans_.facets_beside(sides));
            return note.packed();
        }));
    }

    /// Is what holds for a ring true of those round the vertices beside it, on average? A hole or rod of the
    /// part is spoken for along most of its length. `far` as in bounds().
    bool are_contradicted_beside(std::span<const Index> sides, bool& far) {
        std::vector<Index> beside;
        for (const Index f : fans_.facets_beside(sides))
            for (const Index v : fans_.mesh.facet(f)) beside.push_back(v);
        sort_unique(beside);
        double sum = 0, count = 0;
        for (const Index v : beside) {
            const Note note = note_of(v);
            far |= note.looked_far;
            if (!note.counts) continue;
            sum += note.contradicted / static_cast<double>(2 * note.size);
            ++count;
        }
        return sum >= handles::least_contradicted * count;
    }

    /// Does the ring bound a small part of its own, a knob rather than one of two parts that a bridge joins?
    /// Facets are gathered on both sides by turns, until they meet behind the ring, one side has no more, or
    /// both have as many as a part. Sets `far` where some lie beyond what is near.
    bool bounds(std::span<const Index> sides, bool& far) {
        const PolygonMesh& mesh = fans_.mesh;
        const FacetLinks& links = fans_.links;
        side_of_.clear();
        for (std::vector<Index>& facets : gathered_) facets.clear();
        bool met = false;
        const auto visit = [&](Index f, unsigned side) {
            if (side_of_.add(f, side)) {
                gathered_[side].push_back(f);
                far = far || ask_.is_far(f);
            } else if (side_of_.at(f) != side) {
                met = true;
            }
        };
        for (const Index side : sides) visit(links.facet[side], 0), visit(links.facet[links.twin[side]], 1);
        const auto is_small = [&] {
            return std::min(gathered_[0].size(), gathered_[1].size()) < handles::fewest_of_part;
        };
        std::array<std::size_t, 2> next{0, 0};
        bool ended = false;
        for (unsigned side = 0; !met && is_small(); side = 1 - side) {
            ended = next[side] == gathered_[side].size();
            if (ended) break;
            const Index f = gathered_[side][next[side]++];
            for (Index c = mesh.first[f]; c < mesh.first[f + 1]; ++c) {
                const Index twin = links.twin[c];
                if (twin == no_index || std::ranges::find(sides, c) != sides.end()
                    || std::ranges::find(sides, twin) != sides.end())
                    continue;
                visit(links.facet[twin], side);
            }
        }
        return ended;
    }

    const RingQuestions& ask_;
    const VertexFans& fans_;
    RingSearch search_;
    SmallTable side_of_;                         // of a ring, that a facet lies on
    std::array<std::vector<Index>, 2> gathered_; // facets on each
    bool looked_far_ = false;                    // behind a ring at a vertex that is the part's
};

/// Cuts rings in rounds: all that can be cut without touching each other, then those near by once more.
class HandleCutter {
public:
    HandleCutter(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                 std::span<const Index> voxel, const PartVoxels& part, PolygonMesh& mesh)
        : level_(level),
          sets_(sets),
          voxel_(voxel),
          part_(part),
          mesh_(mesh),
          witnesses_(octree, level, voxel, mesh) {}

    HandleCounts cut(std::optional<FacetLinks>& known_links) {
        HandleCounts counts;
        std::vector<Index> roots = doubtful_vertices({});
        for (int round = 0; !roots.empty() && round < enough_rounds; ++round) {
            FacetLinks links = known_links ? std::move(*known_links) : link_facets(mesh_);
            known_links.reset();
            const VertexFans fans(mesh_, links);
            if (round > 0) roots = doubtful_vertices(near_changed(fans));
            const std::vector<Ring> rings = apart(rings_to_cut(roots, fans), fans);
            counts.cut += rings.size();
            if (rings.empty()) {
                known_links = std::move(links);
                break;
            }
            open(rings, fans);
        }
        counts.looked_far = looked_far_;
        return counts;
    }

private:
    /// Does a facet face aside from a set of a voxel?
    bool joins_wall(Index f, Index v) const {
        const Vec3 area = area_vector(mesh_, mesh_.facet(f));
        const double most = angles::halfway * area.norm();
        return std::ranges::any_of(sets_.of_voxel(v),
                                   [&](const NormalSet& set) { return std::abs(set.normal | area) < most; });
    }

    /// Those of facets that join the sides of walls and gaps, or that no set speaks for, and where two edges
    /// of a facet meet that are shorter together than a narrow ring is across: where points are as dense as
    /// in the fullest voxel at the facet. `among`: these alone, a flag per vertex; empty: all.
    std::vector<Index> doubtful_vertices(const std::vector<std::uint8_t>& among) const {
        const std::vector<std::uint8_t> has_wall = voxels_of_walls(sets_, voxel_, mesh_);
        const auto add = [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
            for (auto f = static_cast<Index>(begin); f < end; ++f) {
                const auto facet = mesh_.facet(f);
                const std::size_t n = facet.size();
                const auto is_asked = [&](Index v) { return among.empty() || among[v]; };
                if (std::ranges::none_of(facet, is_asked)) continue;
                const auto length = [&](std::size_t i) {
                    return (mesh_.positions[facet[i % n]] - mesh_.positions[facet[(i + 1) % n]]).norm();
                };
                double spacing = std::numeric_limits<double>::infinity();
                for (const Index v : facet) spacing = std::min(spacing, witnesses_.spacing_at(v));
                const bool contradicted = is_contradicted(mesh_, f, sets_, voxel_, level_.voxel_size);
                double before = length(n - 1);
                for (std::size_t i = 0; i < n; ++i) {
                    const double after = length(i);
                    const Index v = voxel_at(facet[i]);
                    if (is_asked(facet[i])
                        && (contradicted || (has_wall[v] && joins_wall(f, v))
                            || before + after < 2 * spacing))
                        found.push_back(facet[i]);
                    before = after;
                }
            }
        };
        std::vector<Index> found = collected<Index>(mesh_.facet_count(), chunks::usual, add);
        sort_unique(found);
        return found;
    }

    Index voxel_at(Index vertex) const { return voxel_[mesh_.origin[vertex]]; }

    /// Rings at these vertices may pass what has changed: a flag per vertex. What is on average beside a ring
    /// is not asked again.
    std::vector<std::uint8_t> near_changed(const VertexFans& fans) const {
        std::vector<std::uint8_t> is_near = large_vector<std::uint8_t>(mesh_.vertex_count());
        std::vector<Index> reached = changed_;
        for (const Index v : reached) is_near[v] = 1;
        std::size_t begin = 0;
        for (int edges = 0; edges < handles::reach; ++edges)
            for (const std::size_t end = reached.size(); begin < end; ++begin)
                fans.for_each_side_out(reached[begin], [&](Index c) {
                    const Index v = fans.end(c);
                    if (!std::exchange(is_near[v], std::uint8_t{1})) reached.push_back(v);
                });
        return is_near;
    }

    /// Those at these vertices, in their order.
    std::vector<Ring> rings_to_cut(const std::vector<Index>& roots, const VertexFans& fans) {
        const RingQuestions ask(fans, witnesses_, voxel_, part_);
        std::atomic<bool> looked_far = false;
        std::vector<Ring> rings = collected<Ring>(
            roots.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::vector<Ring>& found) {
                RingJudge judge(ask);
                for (std::size_t i = begin; i < end; ++i) {
                    Interruption::poll();
                    if (std::optional<Ring> ring = judge.ring_to_cut(roots[i]))
                        found.push_back(std::move(*ring));
                }
                if (judge.looked_far()) looked_far = true;
            });
        looked_far_ |= looked_far;
        return rings;
    }

    /// Those of which none has a vertex at a facet beside another one; keeps the vertices of these facets.
    std::vector<Ring> apart(std::vector<Ring> rings, const VertexFans& fans) {
        changed_.clear();
        std::vector<std::uint8_t> touched = large_vector<std::uint8_t>(mesh_.vertex_count());
        std::vector<Ring> kept;
        for (Ring& ring : rings) { // those that come first go first
            if (std::ranges::any_of(ring.vertices, [&](Index v) { return touched[v] != 0; })) continue;
            for (const Index f : fans.facets_beside(ring.sides))
                for (const Index v : mesh_.facet(f))
                    if (!std::exchange(touched[v], std::uint8_t{1})) changed_.push_back(v);
            kept.push_back(std::move(ring));
        }
        return kept;
    }

    /// Gives the facets on the left of each ring vertices of their own, and closes both sides.
    void open(const std::vector<Ring>& rings, const VertexFans& fans) {
        std::vector<std::vector<Index>> ends; // of the mesh, two a ring
        std::vector<std::pair<Index, Vec3>> moves;
        for (const Ring& ring : rings) {
            ends.push_back(ring.vertices);
            ends.push_back(parted(ring, fans, moves));
        }
        std::vector<Index> all;
        for (const std::vector<Index>& end : ends) all.insert(all.end(), end.begin(), end.end());
        const EdgeSet edges(mesh_, all);
        for (const std::vector<Index>& end : ends) close(end, edges);
        for (const auto& [v, place] : moves) mesh_.positions[v] = place;
        changed_.insert(changed_.end(), all.begin(), all.end());
        sort_unique(changed_);
    }

    /// The vertices of the facets on a ring's left, the other way round.
    std::vector<Index> parted(const Ring& ring, const VertexFans& fans,
                              std::vector<std::pair<Index, Vec3>>& moves) {
        const std::size_t n = ring.vertices.size();
        std::vector<Index> left(n);
        std::vector<std::vector<Index>> corners(n); // on the left
        for (std::size_t i = 0; i < n; ++i) {
            const Index v = ring.vertices[i];
            corners[i] = fans.corners_left_of(ring.sides, i);
            const auto back_left = drawn_back(v, ring.vertices, corners[i], fans);
            left[i] = copy_vertex(mesh_, v);
            if (back_left) moves.emplace_back(left[i], *back_left);
            const auto back = drawn_back(v, ring.vertices, fans.corners_right_of(ring.sides, i), fans);
            if (back) moves.emplace_back(v, *back);
        }
        for (std::size_t i = 0; i < n; ++i)
            for (const Index c : corners[i]) mesh_.corners[c] = left[i];
        std::reverse(left.begin(), left.end());
        return left;
    }

    /// Half of the way from a vertex of a ring to its neighbours on one side, so that the sides part.
    std::optional<Vec3> drawn_back(Index v, const std::vector<Index>& ring, const std::vector<Index>& corners,
                                   const VertexFans& fans) const {
        Vec3 sum(0, 0, 0);
        double count = 0;
        for (const Index c : corners) {
            const Index w = mesh_.corners[previous_side(mesh_, fans.facet_of(c), c)];
            if (std::ranges::find(ring, w) != ring.end()) continue;
            sum += mesh_.positions[w];
            ++count;
        }
        if (count == 0) return std::nullopt;
        return 0.5 * (mesh_.positions[v] + sum / count);
    }

    void close(const std::vector<Index>& end, const EdgeSet& edges) {
        const std::vector<Vec3> none(end.size(), Vec3(0, 0, 0));
        const Pieces pieces = split_polygon(mesh_, end, none, edges);
        for (const std::vector<Index>& piece : pieces) mesh_.add_facet(piece);
        if (pieces.empty()) mesh_.add_facet(end);
    }

    const OctreeLevel& level_;
    const NormalSets& sets_;
    std::span<const Index> voxel_;
    const PartVoxels& part_;
    PolygonMesh& mesh_;
    const Witnesses witnesses_;
    std::vector<Index> changed_; // vertices, by the last round
    bool looked_far_ = false;
};

} // namespace

HandleCounts cut_handles(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                         std::span<const Index> voxel, PolygonMesh& mesh, std::optional<FacetLinks>& links,
                         const PartVoxels& part) {
    return HandleCutter(octree, level, sets, voxel, part, mesh).cut(links);
}

} // namespace hsdm
