#include "hsdm/contour/local_sheets.hh"

#include "hsdm/contour/blunt_creases.hh"
#include "hsdm/contour/components.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// The sets around one grid point and their sheets, on the stack.
struct SheetsAtPoint {
    static constexpr std::size_t most = SheetMembers::most;
    SheetMembers members;
    std::array<LocalSheet, most> sheets;
    std::size_t sheet_count = 0;

    /// Connected components of the smooth relation, numbered by their first member.
    void connect(const NormalSets& sets, const RelationTest& related) {
        sheet_count = label_components(
            members.count, [&](std::size_t i) -> std::uint8_t& { return members.all[i].sheet; },
            [&](std::size_t i, std::size_t j) {
                return related.smooth(sets.sets[members.all[i].set], sets.sets[members.all[j].set]);
            });
    }

    void copy_sheets_of_members(std::span<std::uint8_t> to) const {
        std::ranges::transform(members, to.begin(), &SheetMember::sheet);
    }

    /// How many sheets members with known sheets belong to.
    static Index count_sheets(std::span<const std::uint8_t> known) {
        std::uint64_t seen = 0; // a bit for each, of 64 at most
        Index count = 0;
        for (const std::uint8_t sheet : known) {
            const std::uint64_t bit = std::uint64_t{1} << sheet;
            count += (seen & bit) == 0;
            seen |= bit;
        }
        return count;
    }

    /// Renumbers the sheets of members without gaps, in order of their first member.
    void renumber() {
        std::array<std::uint8_t, most> number;
        number.fill(0xff);
        sheet_count = 0;
        for (std::size_t i = 0; i < members.count; ++i) {
            std::uint8_t& n = number[members.all[i].sheet];
            if (n == 0xff) n = static_cast<std::uint8_t>(sheet_count++);
            members.all[i].sheet = n;
        }
    }

    void measure(const Vec3& position, const NormalSets& sets, double voxel_size) {
        for (std::size_t k = 0; k < sheet_count; ++k) sheets[k] = {};
        for (const SheetMember& member : members) {
            const NormalSet& set = sets.sets[member.set];
            const Vec3 d = position - set.centroid;
            LocalSheet& sheet = sheets[member.sheet];
            const double weight = sheet_weight(set, d, voxel_size);
            sheet.weight += weight;
            sheet.distance += weight * (set.normal | d);
            sheet.normal += weight * set.normal;
        }
        for (std::size_t k = 0; k < sheet_count; ++k)
            if (is_bent(sheets[k].normal, sheets[k].weight))
                measure_at_crease(static_cast<std::uint8_t>(k), position, sets, voxel_size);
    }

    /// The distance of a sheet with a blunt crease is that of the outer face where it is convex, of the inner
    /// one where it is concave, not the mean of both.
    void measure_at_crease(std::uint8_t k, const Vec3& position, const NormalSets& sets, double voxel_size) {
        std::array<CreaseSample, most> samples;
        std::array<std::uint8_t, most> face;
        std::size_t n = 0;
        for (const SheetMember& m : members)
            if (m.sheet == k) samples[n++] = crease_sample(sets.sets[m.set]);
        BluntCrease crease;
        if (!find_blunt_crease({samples.data(), n}, points_of_plane, {face.data(), n}, crease)) return;
        std::array<double, 2> weight{0, 0}, distance{0, 0};
        n = 0;
        for (const SheetMember& m : members) {
            if (m.sheet != k) continue;
            const NormalSet& set = sets.sets[m.set];
            const Vec3 d = position - set.centroid;
            const double w = sheet_weight(set, d, voxel_size);
            weight[face[n]] += w;
            distance[face[n++]] += w * (set.normal | d);
        }
        if (!(weight[0] > 0 && weight[1] > 0)) return;
        const double one = distance[0] / weight[0], other = distance[1] / weight[1];
        sheets[k].distance =
            sheets[k].weight * (crease.is_convex ? std::max(one, other) : std::min(one, other));
    }

    /// A sheet may pass the grid point, nearer than the error of its planes, on a side where it has no
    /// points; then no voxel can carry it there, and the grid point gets the sign of the sheet's other side.
    void snap(double voxel_size) {
        std::array<std::uint8_t, most> octants{};
        for (const SheetMember& m : members)
            octants[m.sheet] = static_cast<std::uint8_t>(octants[m.sheet] | 1u << m.octant);
        for (std::size_t k = 0; k < sheet_count; ++k) {
            LocalSheet& sheet = sheets[k];
            if (std::abs(sheet.distance) > sheets::surface_error() * voxel_size * sheet.weight) continue;
            const Vec3 toward =
                sheet.distance < 0 ? sheet.normal : -sheet.normal; // from the grid point to the sheet
            unsigned axis = 0;
            for (unsigned a : {1u, 2u})
                if (std::abs(toward[a]) > std::abs(toward[axis])) axis = a;
            static constexpr std::array<std::uint8_t, 3> upper{
                0xaa, 0xcc, 0xf0}; // octants above the grid point, per axis
            const unsigned beyond = toward[axis] > 0 ? upper[axis] : 0xffu ^ upper[axis];
            if ((octants[k] & beyond) == 0)
                sheet.distance = std::copysign(1e-9 * voxel_size * sheet.weight, -sheet.distance);
        }
    }
};

/// Members and their sheets by the smooth relation alone; the sheets are not measured yet.
LocalSheets connect_members(const GridPoints& grid, const NormalSets& sets, const RelationTest& related) {
    LocalSheets result;
    const std::size_t n = grid.size();
    assign_large(result.first_member, n + 1, 0);
    for_each_index(n, chunks::usual, [&](Index i) {
        for (const Index voxel : grid.voxels[i])
            if (voxel != no_index) result.first_member[i + 1] += sets.first[voxel + 1] - sets.first[voxel];
    });
    counts_to_first(result.first_member);
    resize_unwritten(result.sheet_of, result.first_member.back());
    for_chunks(n, chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        SheetsAtPoint grid_point;
        for (std::size_t i = begin; i < end; ++i) {
            grid_point.members.gather(grid.voxels[i], sets);
            grid_point.connect(sets, related);
            grid_point.copy_sheets_of_members(result.sheets_of_members(static_cast<Index>(i)));
        }
    });
    return result;
}

/// Do two sets seen from a grid point belong to one sheet at a neighbouring one? Only where a neighbour's
/// voxels are both sets' too: along axes along which both lie on one side, and to that side.
bool joined_nearby(const GridPoints& grid, const NormalSets& sets, const LocalSheets& sheets, Index c,
                   const SheetMember& a, const SheetMember& b) {
    SheetMembers members;
    const unsigned same_side = ~unsigned{static_cast<std::uint8_t>(a.octant ^ b.octant)} & 7u;
    for (unsigned way = 1; way < 8; ++way) {
        if ((way & ~same_side) != 0) continue;
        VoxelCoord at = grid.coord(c);
        for (unsigned k = 0; k < 3; ++k)
            if (way >> k & 1u) at[k] += a.octant >> k & 1u ? 1 : -1;
        const Index grid_point = grid.find(GridPoints::code(at));
        if (grid_point == no_index) continue;
        int sheet_a = -1, sheet_b = -2;
        sheets.gather(grid, sets, grid_point, members);
        for (const SheetMember& m : members) {
            if (m.set == a.set) sheet_a = m.sheet;
            if (m.set == b.set) sheet_b = m.sheet;
        }
        if (sheet_a == sheet_b) return true;
    }
    return false;
}

/// Is a wall or gap known between two sheets? One pair of their sets may be an error, and so may be a set of
/// few points.
bool are_apart(const SheetMembers& members, std::uint8_t one, std::uint8_t other, const NormalSets& sets,
               const RelationTest& related) {
    unsigned points_of_one = 0, points_of_other = 0, pairs = 0;
    for (const SheetMember& a : members) {
        if (a.sheet == one) points_of_one += sets.sets[a.set].count;
        if (a.sheet == other) points_of_other += sets.sets[a.set].count;
        if (a.sheet != one) continue;
        for (const SheetMember& b : members)
            pairs += b.sheet == other && related.apart(sets.sets[a.set], sets.sets[b.set]);
    }
    return pairs >= two_agree && std::min(points_of_one, points_of_other) >= points_of_plane;
}

std::vector<Index> grid_points_with_several(const LocalSheets& sheets) {
    return indices_where(sheets.first_member.size() - 1, chunks::usual, [&](Index i) {
        return std::ranges::any_of(sheets.sheets_of_members(i), [](std::uint8_t sheet) { return sheet > 0; });
    });
}

/// Closure: two sets of one sheet at one grid point are one sheet at every grid point they share, unless
/// their normals are so far apart that they were only joined round the rim of a thin part, or a wall or gap
/// passes between the two sheets there: those that end on one ground are one there alone. Repeats until
/// nothing changes. Only grid points with several sheets are looked at; each round reads the sheets of the
/// round before, so the order does not matter.
void close_sheets(const GridPoints& grid, const NormalSets& sets, const RelationTest& related,
                  LocalSheets& sheets) {
    const std::vector<Index> open = grid_points_with_several(sheets);
    struct Merge {
        Index grid_point;
        std::uint8_t kept, merged;
    };
    for (int round = 0; round < enough_rounds; ++round) {
        std::vector<std::vector<Merge>> found(chunk_count(open.size(), 256));
        for_chunks(open.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
            SheetMembers members;
            for (std::size_t k = begin; k < end; ++k) {
                sheets.gather(grid, sets, open[k], members);
                for (const SheetMember* a = members.begin(); a != members.end(); ++a)
                    for (const SheetMember* b = a + 1; b != members.end(); ++b) {
                        if (a->sheet == b->sheet) continue;
                        if ((sets.sets[a->set].normal | sets.sets[b->set].normal)
                            < sheets::least_closure_cosine)
                            continue;
                        if (!joined_nearby(grid, sets, sheets, open[k], *a, *b)) continue;
                        if (are_apart(members, a->sheet, b->sheet, sets, related)) continue;
                        found[chunk].push_back(
                            {open[k], std::min(a->sheet, b->sheet), std::max(a->sheet, b->sheet)});
                    }
            }
        });
        bool changed = false;
        for (const auto& merges : found)
            for (Merge m : merges)
                for (std::uint8_t& sheet : sheets.sheets_of_members(m.grid_point))
                    if (sheet == m.merged) sheet = m.kept, changed = true;
        if (!changed) break;
    }
}

/// Collects grid points that a crossed edge needs and that are missing: its ends, and the other corners of
/// the four faces beside it.
class MissingGridPoints {
public:
    MissingGridPoints(const GridPoints& grid, int side)
        : grid_(grid), below_(grid_points_below(grid)), side_(side) {}

    /// For the edge from grid point i up or down an axis.
    void add(Index i, unsigned axis, bool up, std::vector<MortonCode>& missing) const {
        const Index end = up ? grid_.next[i][axis] : below_[i][axis];
        if (end != no_index && has_all_beside(i, axis) && has_all_beside(end, axis)) return; // most
        VoxelCoord c = grid_.coord(i);
        add_beside(i, c, axis, missing);
        c[axis] += up ? 1 : -1;
        if (end == no_index) add(c, missing, false);
        add_beside(end, c, axis, missing);
    }

private:
    /// Are the four neighbours of grid point i across an axis there?
    bool has_all_beside(Index i, unsigned axis) const {
        const unsigned one = (axis + 1) % 3, other = (axis + 2) % 3;
        return grid_.next[i][one] != no_index && grid_.next[i][other] != no_index
               && below_[i][one] != no_index && below_[i][other] != no_index;
    }
    /// The four neighbours of grid point i at c across an axis; i is no_index if the grid point itself is
    /// missing.
    void add_beside(Index i, const VoxelCoord& c, unsigned axis, std::vector<MortonCode>& missing) const {
        for (unsigned other : {(axis + 1) % 3, (axis + 2) % 3})
            for (bool up : {false, true}) {
                if (i != no_index && (up ? grid_.next : below_)[i][other] != no_index) continue;
                VoxelCoord d = c;
                d[other] += up ? 1 : -1;
                add(d, missing, i == no_index);
            }
    }
    /// Skips grid points beyond the margin around the bounding cube and, if `in_doubt`, looks up whether they
    /// exist.
    void add(const VoxelCoord& c, std::vector<MortonCode>& missing, bool in_doubt) const {
        if (std::any_of(c.begin(), c.end(), [&](int x) { return x < -1 || x > side_ + 1; })) return;
        if (!in_doubt || grid_.find(grid_.code(c)) == no_index) missing.push_back(grid_.code(c));
    }

    const GridPoints& grid_;
    std::vector<std::array<Index, 3>> below_;
    int side_;
};

} // namespace

LocalSheets group_local_sheets(const GridPoints& grid, const NormalSets& sets, const RelationTest& related,
                               double voxel_size) {
    LocalSheets result = connect_members(grid, sets, related);
    close_sheets(grid, sets, related, result);
    const std::size_t n = grid.size();
    assign_large(result.first_sheet, n + 1, 0);
    for_each_index(n, chunks::usual, [&](Index i) {
        result.first_sheet[i + 1] = SheetsAtPoint::count_sheets(result.sheets_of_members(i));
    });
    counts_to_first(result.first_sheet);
    resize_unwritten(result.sheets, result.first_sheet.back());
    for_chunks(n, chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        SheetsAtPoint grid_point;
        for (auto i = static_cast<Index>(begin); i < end; ++i) {
            grid_point.sheet_count = result.first_sheet[i + 1] - result.first_sheet[i];
            if (grid_point.sheet_count < 2) {
                grid_point.members.gather(grid.voxels[i], sets); // all of sheet 0
            } else {
                result.gather(grid, sets, i, grid_point.members);
                grid_point.renumber();
                grid_point.copy_sheets_of_members(result.sheets_of_members(i));
            }
            grid_point.measure(grid.position(i) * voxel_size, sets, voxel_size);
            if (!grid.is_moved(i)) grid_point.snap(voxel_size); // else octants do not say where points are
            std::copy_n(grid_point.sheets.begin(), grid_point.sheet_count,
                        result.sheets.data() + result.first_sheet[i]);
        }
    });
    return result;
}

std::size_t extend_grid_points(GridPoints& grid, LocalSheets& sheets, const OctreeLevel& level) {
    const MissingGridPoints grid_points(grid, 1 << level.depth);
    const auto add_missing = [&](std::size_t begin, std::size_t end, std::vector<MortonCode>& missing) {
        for (auto i = static_cast<Index>(begin); i < end; ++i)
            for (const LocalSheet& sheet : sheets.sheets_at(i))
                for (unsigned axis = 0; axis < 3; ++axis) {
                    const double rise = sheet.normal[axis] * level.voxel_size;
                    const bool is_inside = sheet.distance < 0;
                    const double at_place = // of the grid point, wherever it lies
                        grid.is_moved(i)
                            ? sheet.distance - (sheet.normal | grid.moved_by[i]) * level.voxel_size
                            : sheet.distance;
                    for (bool up : {true, false})
                        if (is_inside != (at_place + (up ? rise : -rise) < 0))
                            grid_points.add(i, axis, up, missing);
                }
    };
    std::vector<MortonCode> missing = collected<MortonCode>(grid.size(), chunks::usual, add_missing);
    if (missing.empty()) return 0;
    parallel_sort_unique(missing);
    add_grid_points(grid, missing);
    resize_large(sheets.first_member, grid.size() + 1, sheets.first_member.back());
    resize_large(sheets.first_sheet, grid.size() + 1, sheets.first_sheet.back());
    return missing.size();
}

} // namespace hsdm
