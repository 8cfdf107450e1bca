#include "hsdm/contour/crossings.hh"

#include "hsdm/contour/blunt_creases.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/contour/plane_area.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

/// A sheet along one edge: the union of the local sheets at the two ends that share a set beside the edge.
struct EdgeSheet {
    double weight[2] = {0, 0};   // at the lower and the upper end
    double distance[2] = {0, 0}; // signed, positive outside
    Vec3 normal{0, 0, 0};
    double points = 0, points_squared = 0;
    std::array<double, 4> held{0, 0, 0, 0}; // points of the sheet in each voxel beside the edge
    bool crosses = false, bent = false, by_crease = false;
    double t = 0;

    bool beside() const { return held[0] + held[1] + held[2] + held[3] > 0; }
    bool leaving() const { return distance[0] < 0; }
    /// Points per voxel, the mean over points rather than voxels, so that full voxels count more than clipped
    /// ones.
    double density() const { return points > 0 ? points_squared / points : 0; }
};

/// What is seen from a grid point: the one sheet that there is, from which side, and the octants that hold
/// points of it.
struct SeenFrom {
    std::uint8_t side, octants;
};
constexpr std::uint8_t inside_one = 0, outside_one = 1, several = 2; // or none, or one without weight

std::vector<SeenFrom> seen_from_all(const GridPoints& grid, const NormalSets& sets,
                                    const LocalSheets& local) {
    std::vector<SeenFrom> seen = unwritten_vector<SeenFrom>(grid.size());
    for_each_index(grid.size(), chunks::usual, [&](Index c) {
        seen[c] = {several, 0};
        const auto sheets = local.sheets_at(c);
        if (sheets.size() != 1 || !(sheets[0].weight > 0)) return;
        unsigned octants = 0;
        for (unsigned octant = 0; octant < 8; ++octant)
            if (const Index v = grid.voxels[c][octant]; v != no_index)
                octants |= unsigned{sets.first[v] < sets.first[v + 1]} << octant;
        seen[c] = {sheets[0].distance < 0 ? inside_one : outside_one, static_cast<std::uint8_t>(octants)};
    });
    return seen;
}

/// Finds the crossings of one edge. Reused from edge to edge.
class EdgeCrossings {
public:
    EdgeCrossings(const GridPoints& grid, const LocalSheets& local, const std::vector<SeenFrom>& seen,
                  const NormalSets& sets, const RelationTest& related, double voxel_size,
                  const CrossingOptions& options)
        : grid_(grid),
          local_(local),
          seen_(seen),
          sets_(sets),
          related_(related),
          h_(voxel_size),
          options_(options) {}

    std::size_t dropped_beyond_crease = 0;

    void find(Index grid_point, unsigned axis, std::vector<Crossing>& found) {
        ends_[0] = grid_point, ends_[1] = grid_.next[grid_point][axis], axis_ = axis;
        if (ends_[1] == no_index || passes_by()
            || (!local_.has_members(ends_[0]) && !local_.has_members(ends_[1])))
            return;
        low_ = grid_.position(grid_point) * h_;
        way_ = edge_vector(grid_, 3 * grid_point + axis, h_);
        is_moved_ = grid_.is_moved(ends_[0]) || grid_.is_moved(ends_[1]);
        join_sheets();
        if (!measure()) return;
        count_points();
        const std::size_t begin = found.size();
        for (std::size_t i = 0; i < count_; ++i) {
            if (!sheets_[i].crosses) continue;
            if (count_ > 1 && relations_for_ != i) relate(i);
            const double off = beyond(i);
            dropped_beyond_crease += off > 0;
            const bool carried = supported(i);
            found.push_back(crossing(i, carried));
            found.back().standing = off == 0 && (carried || sheets_[i].beside());
            found.back().sureness = off > 0 ? sureness(off) : 1;
        }
        std::sort(found.begin() + static_cast<std::ptrdiff_t>(begin), found.end(),
                  [](const Crossing& a, const Crossing& b) {
                      return std::pair(a.t, a.set) < std::pair(b.t, b.set);
                  });
    }

private:
    static constexpr std::size_t most = 128;

    bool beside(const SheetMember& m, unsigned end) const {
        return ((m.octant >> axis_ & 1u) != 0) == (end == 0);
    }

    /// Position of a voxel around the edge, two bits: upper side of the next axis, of the one after.
    unsigned around(const SheetMember& m) const {
        return (m.octant >> (axis_ + 1) % 3 & 1u) | (m.octant >> (axis_ + 2) % 3 & 1u) << 1;
    }

    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    /// Is there only one sheet, with both ends of the edge on its same side? So it is at most edges, and they
    /// are skipped.
    bool passes_by() const {
        const SeenFrom &low = seen_[ends_[0]], &high = seen_[ends_[1]];
        return low.side != several && low.side == high.side && holds_beside(ends_[0]);
    }

    /// Does a voxel beside the edge hold points of the one sheet seen from its lower end? Then the one seen
    /// from the upper end is the same.
    bool holds_beside(Index lower) const {
        static constexpr std::array<std::uint8_t, 3> upper{0xaa, 0xcc, 0xf0}; // octants, per axis
        return (seen_[lower].octants & upper[axis_]) != 0;
    }

    /// Local sheets at the two ends are one along the edge if they share a set of a voxel beside it.
    void join_sheets() {
        const std::size_t n0 = local_.sheets_at(ends_[0]).size(), n1 = local_.sheets_at(ends_[1]).size();
        for (std::size_t i = 0; i < n0 + n1; ++i) parent_[i] = static_cast<std::uint8_t>(i);
        if (n0 == 1 && n1 == 1 && holds_beside(ends_[0])) {
            parent_[1] = 0;
        } else {
            gather_members();
            for (const SheetMember& a : members_[0]) {
                if (!beside(a, 0)) continue;
                for (const SheetMember& b : members_[1])
                    if (b.set == a.set) {
                        const std::size_t ra = root(a.sheet), rb = root(n0 + b.sheet);
                        parent_[std::max(ra, rb)] = static_cast<std::uint8_t>(std::min(ra, rb));
                    }
            }
        }
        count_ = 0;
        for (std::size_t i = 0; i < n0 + n1; ++i) {
            if (root(i) == i) {
                number_[i] = static_cast<std::uint8_t>(count_);
                sheets_[count_++] = {};
            }
            number_[i] = number_[root(i)];
            const LocalSheet& part =
                i < n0 ? local_.sheets_at(ends_[0])[i] : local_.sheets_at(ends_[1])[i - n0];
            EdgeSheet& sheet = sheets_[number_[i]];
            const unsigned end = i < n0 ? 0 : 1;
            sheet.weight[end] += part.weight;
            sheet.distance[end] += part.distance;
            sheet.normal += part.normal;
        }
        offset_[0] = 0, offset_[1] = n0;
    }

    /// Most edges that are not crossed can do without.
    void gather_members() {
        for (unsigned end : {0u, 1u})
            if (std::exchange(members_of_[end], ends_[end]) != ends_[end])
                local_.gather(grid_, sets_, ends_[end], members_[end]);
    }

    void count_points() {
        gather_members();
        for (unsigned end : {0u, 1u})
            for (const SheetMember& m : members_[end]) {
                EdgeSheet& sheet = sheets_[number_[offset_[end] + m.sheet]];
                const double points = sets_.sets[m.set].count;
                sheet.points += points;
                sheet.points_squared += points * points;
                if (end == 0 && beside(m, 0)) sheet.held[around(m)] += points;
            }
    }

    bool measure() {
        for (std::size_t i = 0; i < count_; ++i) {
            measure(sheets_[i]);
            if (!sheets_[i].crosses || !sheets_[i].bent) continue;
            gather_members();
            cross_at_crease(i);
        }
        relations_for_ = most;
        return std::any_of(sheets_.begin(), sheets_.begin() + static_cast<std::ptrdiff_t>(count_),
                           [](const EdgeSheet& sheet) { return sheet.crosses; });
    }

    /// Signed distances at both ends; a sheet known at one end only is continued along its plane.
    void measure(EdgeSheet& sheet) const {
        const double length = sheet.normal.norm();
        sheet.bent = is_bent(sheet.normal, sheet.weight[0] + sheet.weight[1]);
        sheet.normal = length > 0 ? sheet.normal / length : Vec3(0, 0, 1);
        for (unsigned end : {0u, 1u})
            if (sheet.weight[end] > 0) sheet.distance[end] /= sheet.weight[end];
        if (!(sheet.weight[0] > 0)) sheet.distance[0] = sheet.distance[1] - (way_ | sheet.normal);
        if (!(sheet.weight[1] > 0)) sheet.distance[1] = sheet.distance[0] + (way_ | sheet.normal);
        sheet.crosses = (sheet.distance[0] < 0) != (sheet.distance[1] < 0);
        if (sheet.crosses) sheet.t = sheet.distance[0] / (sheet.distance[0] - sheet.distance[1]);
    }

    /// On a sheet with a blunt crease, lets the edge cross the face on which it enters or leaves what lies
    /// between both. The signs at the ends stay.
    void cross_at_crease(std::size_t i) {
        std::array<CreaseSample, most> samples;
        std::array<std::uint8_t, most> face;
        std::array<Index, most> of;
        std::size_t n = 0;
        const auto place_of = [&](Index set) {
            return static_cast<std::size_t>(
                std::find(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(n), set) - of.begin());
        };
        for_each_member(i, [&](const SheetMember& m, unsigned) {
            if (place_of(m.set) < n) return; // a set beside the edge, seen from its other end, too
            of[n] = m.set;
            samples[n++] = crease_sample(sets_.sets[m.set]);
        });
        BluntCrease crease;
        if (!find_blunt_crease({samples.data(), n}, points_of_plane, {face.data(), n}, crease)) return;
        std::array<EdgeSheet, 2> faces;
        for_each_member(i, [&](const SheetMember& m, unsigned end) {
            EdgeSheet& of_set = faces[face[place_of(m.set)]];
            const NormalSet& set = sets_.sets[m.set];
            Vec3 d = low_ - set.centroid;
            if (end == 1) d += way_;
            const double weight = sheet_weight(set, d, h_);
            of_set.weight[end] += weight;
            of_set.distance[end] += weight * (set.normal | d);
            of_set.normal += weight * set.normal;
        });
        EdgeSheet& sheet = sheets_[i];
        const bool is_first = crease.is_convex == sheet.leaving(); // of the two that it crosses
        for (EdgeSheet& one : faces) {
            measure(one);
            if (!one.crosses || one.leaving() != sheet.leaving()) continue;
            if (sheet.by_crease && (is_first ? one.t >= sheet.t : one.t <= sheet.t)) continue;
            sheet.t = one.t;
            sheet.normal = one.normal;
            sheet.by_crease = true;
        }
    }

    template <class F>
    void for_each_member(std::size_t i, F&& f) const {
        for (unsigned end : {0u, 1u})
            for (const SheetMember& m : members_[end])
                if (number_[offset_[end] + m.sheet] == i) f(m, end);
    }

    /// Calls f(one, other) for the pairs of sets of two sheets that an end of the edge sees.
    template <class F>
    void for_pairs(std::size_t j, std::size_t k, F&& f) const {
        for (unsigned end : {0u, 1u})
            for (const SheetMember& a : members_[end]) {
                if (number_[offset_[end] + a.sheet] != j) continue;
                for (const SheetMember& b : members_[end])
                    if (number_[offset_[end] + b.sheet] == k) f(sets_.sets[a.set], sets_.sets[b.set]);
            }
    }

    /// Relation of two sheets at a place, by the vote of their pairs of sets. Where a wall or gap is known
    /// between any two of them one pair with a single point does not say otherwise.
    Relation relation_between(std::size_t j, std::size_t k, const Vec3& at) const {
        unsigned convex = 0, concave = 0, points = 0; // of the lesser sets that vote
        bool any_apart = false;
        for_pairs(j, k, [&](const NormalSet& one, const NormalSet& other) {
            const Relation r = related_(one, other);
            convex += r == Relation::convex;
            concave += r == Relation::concave;
            if (r == Relation::convex || r == Relation::concave) points += std::min(one.count, other.count);
            any_apart = any_apart || (r == Relation::none && related_.apart(one, other));
        });
        if (any_apart && points == 1) return Relation::none;
        if (convex > 0 && concave > 0) return nearer_relation(j, k, at);
        return convex > concave ? Relation::convex : concave > convex ? Relation::concave : Relation::none;
    }

    /// Of two sheets that meet in a convex crease at one place and in a concave one at another, as round the
    /// corner where bars meet: pairs count by their points and how near they are.
    Relation nearer_relation(std::size_t j, std::size_t k, const Vec3& at) const {
        double convex = 0; // less what speaks for concave
        for_pairs(j, k, [&](const NormalSet& one, const NormalSet& other) {
            const Relation r = related_(one, other);
            if (r != Relation::convex && r != Relation::concave) return;
            const NormalSet& lesser = one.count < other.count ? one : other;
            const double say = sheet_weight(lesser, 0.5 * (one.centroid + other.centroid) - at, h_);
            convex += r == Relation::convex ? say : -say;
        });
        return convex > 0 ? Relation::convex : convex < 0 ? Relation::concave : Relation::none;
    }

    /// Relations of sheet i to every other sheet here.
    void relate(std::size_t i) {
        const Vec3 at = position(i);
        for (std::size_t j = 0; j < count_; ++j)
            relations_[j] = j == i ? Relation::none : relation_between(i, j, at);
        relations_for_ = i;
    }

    /// Is the crossing of sheet i outside sheet j? Ties go by number: of two sheets that cross at the same
    /// place in the same direction exactly one is kept.
    bool outside_at(std::size_t j, std::size_t i) const {
        const EdgeSheet& a = sheets_[i];
        const EdgeSheet& b = sheets_[j];
        if (!b.crosses) return b.distance[0] >= 0;
        const bool before = a.t < b.t || (a.t == b.t && i < j);
        return b.distance[before ? 0 : 1] >= 0;
    }

    /// Of a crossing of sheet i from sheet j; not 0.
    double distance_to(std::size_t j, std::size_t i) const {
        const EdgeSheet& b = sheets_[j];
        const double distance = b.distance[0] + sheets_[i].t * (b.distance[1] - b.distance[0]);
        return std::max(std::abs(distance), std::numeric_limits<double>::min());
    }

    /// A crossing counts if it lies on the solid's surface: inside every convex crease partner, outside every
    /// concave one. Two convex partners that meet in a concave crease bound the sheet together, so being
    /// inside one of them is enough (likewise with convex and concave exchanged); the top of an L-shaped
    /// bracket at its inner corner is an example. Returns how far it is off; 0 if it counts.
    double beyond(std::size_t i) const {
        double farthest = 0;
        for (std::size_t j = 0; j < count_; ++j) {
            if (j == i || relations_for_ != i) continue;
            if (relations_[j] != Relation::convex && relations_[j] != Relation::concave) continue;
            const bool wants_outside = relations_[j] == Relation::concave;
            if (outside_at(j, i) == wants_outside) continue;
            const Relation opposite = wants_outside ? Relation::convex : Relation::concave;
            double off = distance_to(j, i);
            for (std::size_t k = 0; k < count_ && off > 0; ++k) {
                if (k == i || k == j || relations_[k] != relations_[j]
                    || relation_between(j, k, position(i)) != opposite)
                    continue;
                off = outside_at(k, i) == wants_outside ? 0 : std::min(off, distance_to(k, i));
            }
            farthest = std::max(farthest, off);
        }
        return farthest;
    }

    /// Of what is so far beyond a crease, that it is: within the error of a sheet a share.
    float sureness(double off) const {
        return static_cast<float>(std::min(1.0, off / (sheets::surface_error() * h_)));
    }

    Vec3 position(std::size_t i) const { return low_ + sheets_[i].t * way_; }

    /// Do the data carry the sheet into all four voxels beside the edge, slivers apart? A voxel in which few
    /// points are expected is a sliver; any other must hold at least a fair share of the points expected.
    bool supported(std::size_t i) const {
        if (is_moved_)
            return true; // its grid points moved to where sheets are all round; points are asked later
        const EdgeSheet& sheet = sheets_[i];
        double density = 0; // the densest sheet's: this sheet may hold clipped voxels only
        for (std::size_t j = 0; j < count_; ++j) density = std::max(density, sheets_[j].density());
        unsigned doubtful = 0;
        for (unsigned v = 0; v < 4; ++v)
            doubtful |= unsigned{sheet.held[v] < crossing::fair_share * density} << v;
        if (doubtful == 0) return true;
        std::array<HalfSpace, 16> clips;
        const std::size_t clip_count = partner_half_spaces(i, clips);
        const double offset = sheet.normal | position(i);
        for (unsigned v = 0; v < 4; ++v) {
            if (!(doubtful >> v & 1u)) continue;
            Vec3 lo = low_ + Vec3(1, 1, 1) * (sheets::plane_error * h_);
            if (!(v & 1u)) lo[(axis_ + 1) % 3] -= h_;
            if (!(v & 2u)) lo[(axis_ + 2) % 3] -= h_;
            if (passes(sheet.normal, offset, lo, (1 - 2 * sheets::plane_error) * h_)) continue;
            const double area = plane_area(sheet.normal, offset, lo, (1 - 2 * sheets::plane_error) * h_,
                                           {clips.data(), clip_count});
            const double expected = area * density / (h_ * h_);
            if (expected > options_.sliver_points && sheet.held[v] < crossing::fair_share * expected)
                return false;
        }
        return true;
    }

    /// Does a plane pass by a cube? No other area costs less to find.
    static bool passes(const Vec3& normal, double offset, const Vec3& lo, double size) {
        const double to_middle = (normal | (lo + Vec3(0.5, 0.5, 0.5) * size)) - offset;
        const double reach = std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
        return std::abs(to_middle) > 0.5 * size * reach * (1 + 1e-9);
    }

    /// The half-spaces that its crease partners clip sheet i to. Returns how many.
    std::size_t partner_half_spaces(std::size_t i, std::array<HalfSpace, 16>& clips) const {
        std::size_t n = 0;
        if (relations_for_ != i) return n;
        const Vec3 x = position(i);
        for (std::size_t j = 0; j < count_ && n < clips.size(); ++j) {
            if (relations_[j] != Relation::convex && relations_[j] != Relation::concave) continue;
            const EdgeSheet& partner = sheets_[j];
            const double sign = relations_[j] == Relation::convex ? 1 : -1;
            const double here =
                partner.distance[0] + sheets_[i].t * (partner.distance[1] - partner.distance[0]);
            const Vec3 normal = partner.normal * sign;
            clips[n++] = {normal, (normal | x) - sign * here};
        }
        return n;
    }

    Crossing crossing(std::size_t i, bool carried) {
        const Vec3 x = position(i);
        double nearest = std::numeric_limits<double>::infinity();
        Index set = no_index;
        for_each_member(i, [&](const SheetMember& m, unsigned end) {
            if (end == 1 && beside(m, end)) return; // seen from the lower end, too
            const double d = (sets_.sets[m.set].centroid - x).sqrnorm();
            if (d < nearest || (d == nearest && m.set < set)) nearest = d, set = m.set;
        });
        carried = carried && (is_moved_ || nearest < sheets::beside * sheets::beside * h_ * h_);
        return {sheets_[i].t,         sheets_[i].normal, 3 * ends_[0] + axis_, set,
                sheets_[i].leaving(), carried,           sheets_[i].by_crease};
    }

    const GridPoints& grid_;
    const LocalSheets& local_;
    const std::vector<SeenFrom>& seen_;
    const NormalSets& sets_;
    const RelationTest& related_;
    double h_;
    const CrossingOptions& options_;

    Index ends_[2] = {0, 0};
    Index members_of_[2] = {no_index, no_index};
    SheetMembers members_[2]; // of those grid points
    unsigned axis_ = 0;
    Vec3 low_, way_;        // the lower end, and from it to the upper one
    bool is_moved_ = false; // does one of them lie off its place?
    std::size_t offset_[2] = {0, 0};
    std::array<std::uint8_t, most> parent_;
    std::array<std::uint8_t, most>
        number_; // edge sheet of each local sheet of the lower, then of the upper end
    std::array<EdgeSheet, most> sheets_;
    std::size_t count_ = 0;
    std::array<Relation, most> relations_;
    std::size_t relations_for_ = most;
};

std::vector<Crossings::MovedEdge> moved_edges(const GridPoints& grid) {
    if (grid.moved_by.empty()) return {};
    const auto moved_by = [&](Index c) { return grid.is_moved(c) ? grid.moved_by[c] : Vec3(0, 0, 0); };
    const auto add = [&](std::size_t begin, std::size_t end, std::vector<Crossings::MovedEdge>& found) {
        for (auto c = static_cast<Index>(begin); c < end; ++c)
            for (unsigned axis = 0; axis < 3; ++axis)
                if (const Index up = grid.next[c][axis];
                    up != no_index && (grid.is_moved(c) || grid.is_moved(up)))
                    found.push_back({3 * c + axis, {moved_by(c), moved_by(up)}});
    };
    return collected<Crossings::MovedEdge>(grid.size(), chunks::usual, add);
}

} // namespace

Crossings find_crossings(const GridPoints& grid, const LocalSheets& local, const NormalSets& sets,
                         const RelationTest& related, double voxel_size, const CrossingOptions& options) {
    Crossings result;
    const std::vector<SeenFrom> seen = seen_from_all(grid, sets, local);
    resize_unwritten(result.first, 3 * grid.size() + 1);
    result.first[0] = 0;
    std::atomic<std::size_t> dropped = 0;
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Crossing>& found) {
        EdgeCrossings edge(grid, local, seen, sets, related, voxel_size, options);
        for (std::size_t c = begin; c < end; ++c)
            for (unsigned axis = 0; axis < 3; ++axis) {
                const std::size_t before = found.size();
                edge.find(static_cast<Index>(c), axis, found);
                result.first[3 * c + axis + 1] = static_cast<Index>(found.size() - before);
            }
        dropped += edge.dropped_beyond_crease;
    };
    result.crossings = collected<Crossing>(grid.size(), chunks::slow, find);
    counts_to_first(result.first);
    result.dropped_beyond_crease = dropped;
    result.moved = moved_edges(grid);
    return result;
}

Vec3 edge_vector(const GridPoints& grid, Index edge, double voxel_size) {
    const Index lower = edge / 3, upper = grid.next[lower][edge % 3];
    if (grid.is_moved(lower) || grid.is_moved(upper))
        return (grid.position(upper) - grid.position(lower)) * voxel_size;
    Vec3 way(0, 0, 0);
    way[edge % 3] = voxel_size;
    return way;
}

Vec3 crossing_position(const GridPoints& grid, const Crossing& crossing, double voxel_size) {
    const Index lower = crossing.edge / 3;
    const unsigned axis = crossing.edge % 3;
    Vec3 p = grid.position(lower);
    if (!grid.moved_by.empty()) {
        const Index upper = grid.next[lower][axis];
        if (upper != no_index && (grid.is_moved(lower) || grid.is_moved(upper)))
            return (p + crossing.t * (grid.position(upper) - p)) * voxel_size;
    }
    p[axis] += crossing.t;
    return p * voxel_size;
}

} // namespace hsdm
