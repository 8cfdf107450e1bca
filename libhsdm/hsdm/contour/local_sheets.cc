#include "hsdm/contour/local_sheets.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/radix_sort.hh"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bitset>
#include <cmath>

namespace hsdm {
namespace {

constexpr std::size_t corners_per_chunk = 2048;
constexpr double surface_error = 0.15; // voxels: how far off its planes a sheet may pass
constexpr int closure_rounds = 8;
constexpr double least_closure_cosine = 0.35; // 70 degrees
constexpr double nearness = 0.5; // voxels: a set's say falls off with its distance from the corner

constexpr std::array<Index, 8> no_voxels{no_index, no_index, no_index, no_index,
                                         no_index, no_index, no_index, no_index};

/// The corners of voxels of one block of 4 x 4 x 4: voxels of a surface share most of theirs.
class BlockCorners {
public:
    static constexpr MortonCode voxels = 64;
    /// The place of a voxel's corner among those of its block; bit k of the number is set on the upper side
    /// of axis k.
    static std::size_t place(MortonCode voxel, unsigned corner) {
        const VoxelCoord c = morton_decode(voxel & (voxels - 1));
        return static_cast<std::size_t>(c[0] + static_cast<int>(corner & 1)
                                        + 5 * (c[1] + static_cast<int>(corner >> 1 & 1))
                                        + 25 * (c[2] + static_cast<int>(corner >> 2)));
    }

    void add(MortonCode voxel) {
        for (unsigned corner = 0; corner < 8; ++corner) used_.set(place(voxel, corner));
    }
    /// Calls each(place, code) for the corners of the block's voxels, and starts anew.
    template <class Each>
    void take(MortonCode block, Each each) {
        const VoxelCoord c = morton_decode(block * voxels);
        for (int i = 0; i < 125; ++i)
            if (used_[static_cast<std::size_t>(i)])
                each(i, CornerLattice::code({c[0] + i % 5, c[1] + i / 5 % 5, c[2] + i / 25}));
        used_.reset();
    }

private:
    std::bitset<125> used_;
};

/// Calls each(corners, block, begin, end, chunk) for the voxels of every block; a block that lies in two
/// chunks comes twice.
template <class Each>
void for_blocks(const OctreeLevel& level, Each each) {
    for_chunks(level.size(), corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        BlockCorners corners;
        for (std::size_t first = begin, v = begin; v < end; ++v) {
            const MortonCode block = level.codes[v] / BlockCorners::voxels;
            corners.add(level.codes[v]);
            if (v + 1 < end && level.codes[v + 1] / BlockCorners::voxels == block) continue;
            each(corners, block, first, v + 1, chunk);
            first = v + 1;
        }
    });
}

/// Every corner of every voxel, sorted, each once.
std::vector<MortonCode> corner_codes(const OctreeLevel& level) {
    std::vector<std::vector<CodeIndex>> parts(chunk_count(level.size(), corners_per_chunk));
    for_blocks(level,
               [&](BlockCorners& corners, MortonCode block, std::size_t, std::size_t, std::size_t chunk) {
                   corners.take(block, [&](int, MortonCode code) { parts[chunk].push_back({code, 0}); });
               });
    std::vector<CodeIndex> corners = joined(parts);
    radix_sort(corners, 3 * (level.depth + 2));
    std::vector<MortonCode> codes;
    codes.reserve(corners.size());
    for (const CodeIndex& corner : corners)
        if (codes.empty() || codes.back() != corner.code) codes.push_back(corner.code);
    return codes;
}

/// Each voxel is seen from its eight corners.
void connect_voxels(const OctreeLevel& level, CornerLattice& lattice) {
    lattice.voxels.resize(lattice.size(), no_voxels);
    for_blocks(level, [&](BlockCorners& corners, MortonCode block, std::size_t begin, std::size_t end, auto) {
        std::array<Index, 125> corner_at;
        corners.take(block, [&](int place, MortonCode code) {
            corner_at[static_cast<std::size_t>(place)] = lattice.index.find(code);
        });
        for (std::size_t v = begin; v < end; ++v)
            for (unsigned k = 0; k < 8; ++k)
                lattice.voxels[corner_at[BlockCorners::place(level.codes[v], k)]][7 - k] =
                    static_cast<Index>(v);
    });
}

/// The sets around one corner and their sheets, on the stack.
struct Corner {
    static constexpr std::size_t most = 64; // eight voxels of at most eight sets
    std::array<SheetMember, most> members;
    std::array<LocalSheet, most> sheets;
    std::size_t member_count = 0, sheet_count = 0;

    void gather(const std::array<Index, 8>& voxels, const NormalSets& sets) {
        member_count = 0;
        for (std::uint8_t octant = 0; octant < 8; ++octant)
            if (voxels[octant] != no_index)
                for (Index s = sets.first[voxels[octant]]; s < sets.first[voxels[octant] + 1]; ++s)
                    members[member_count++] = {s, octant, 0};
    }

    /// Connected components of the smooth relation, numbered by their first member.
    void connect(const NormalSets& sets, const RelationTest& related) {
        std::array<std::uint8_t, most> pending;
        constexpr std::uint8_t none = 0xff;
        for (std::size_t i = 0; i < member_count; ++i) members[i].sheet = none;
        sheet_count = 0;
        for (std::size_t i = 0; i < member_count; ++i) {
            if (members[i].sheet != none) continue;
            std::size_t waiting = 0;
            pending[waiting++] = static_cast<std::uint8_t>(i);
            members[i].sheet = static_cast<std::uint8_t>(sheet_count);
            while (waiting > 0) {
                const NormalSet& a = sets.sets[members[pending[--waiting]].set];
                for (std::size_t j = i + 1; j < member_count; ++j) {
                    if (members[j].sheet != none || related(a, sets.sets[members[j].set]) != Relation::smooth)
                        continue;
                    members[j].sheet = static_cast<std::uint8_t>(sheet_count);
                    pending[waiting++] = static_cast<std::uint8_t>(j);
                }
            }
            ++sheet_count;
        }
    }

    /// Members whose sheets are known; renumbers the sheets without gaps, in order of their first member.
    void take(std::span<const SheetMember> known) {
        std::array<std::uint8_t, most> number;
        number.fill(0xff);
        member_count = known.size();
        sheet_count = 0;
        for (std::size_t i = 0; i < member_count; ++i) {
            members[i] = known[i];
            std::uint8_t& n = number[known[i].sheet];
            if (n == 0xff) n = static_cast<std::uint8_t>(sheet_count++);
            members[i].sheet = n;
        }
    }

    void measure(const Vec3& position, const NormalSets& sets, double voxel_size) {
        const double falloff = 1 / (nearness * nearness * voxel_size * voxel_size);
        for (std::size_t k = 0; k < sheet_count; ++k) sheets[k] = {};
        for (std::size_t i = 0; i < member_count; ++i) {
            const NormalSet& set = sets.sets[members[i].set];
            const Vec3 d = position - set.centroid;
            LocalSheet& sheet = sheets[members[i].sheet];
            const double weight = std::min<double>(set.count, 8) * std::exp(-d.sqrnorm() * falloff);
            sheet.weight += weight;
            sheet.distance += weight * (set.normal | d);
            sheet.normal += weight * set.normal;
            const double points = set.count;
            sheet.points += points;
            sheet.points_squared += points * points;
        }
    }

    /// A sheet within the error of its planes may pass the corner on a side where none of its points lie;
    /// there is no voxel there to carry it. Then the corner takes the other side's sign.
    void snap(double voxel_size) {
        std::array<std::uint8_t, most> octants{};
        for (std::size_t i = 0; i < member_count; ++i)
            octants[members[i].sheet] =
                static_cast<std::uint8_t>(octants[members[i].sheet] | 1u << members[i].octant);
        for (std::size_t k = 0; k < sheet_count; ++k) {
            LocalSheet& sheet = sheets[k];
            if (std::abs(sheet.distance) > surface_error * voxel_size * sheet.weight) continue;
            const Vec3 toward =
                sheet.distance < 0 ? sheet.normal : -sheet.normal; // from the corner to the sheet
            unsigned axis = 0;
            for (unsigned a : {1u, 2u})
                if (std::abs(toward[a]) > std::abs(toward[axis])) axis = a;
            static constexpr std::array<std::uint8_t, 3> upper{0xaa, 0xcc,
                                                               0xf0}; // octants above the corner, per axis
            const unsigned beyond = toward[axis] > 0 ? upper[axis] : 0xffu ^ upper[axis];
            if ((octants[k] & beyond) == 0)
                sheet.distance = std::copysign(1e-9 * voxel_size * sheet.weight, -sheet.distance);
        }
    }
};

void connect_corner(CornerLattice& lattice, std::size_t i) {
    for (unsigned axis = 0; axis < 3; ++axis) {
        VoxelCoord next = lattice.coord(static_cast<Index>(i));
        ++next[axis];
        lattice.next[i][axis] = lattice.index.find(lattice.code(next));
    }
}

/// The grid points that the edges crossed from a corner need: both ends, and the other corners of the four
/// faces beside.
class MissingCorners {
public:
    MissingCorners(const CornerLattice& lattice, int side)
        : lattice_(lattice), below_(corners_below(lattice)), side_(side) {}

    /// Those of the edge from corner i up an axis, or down.
    void add(Index i, unsigned axis, bool up, std::vector<MortonCode>& missing) const {
        VoxelCoord c = lattice_.coord(i);
        add_beside(i, c, axis, missing);
        c[axis] += up ? 1 : -1;
        const Index end = up ? lattice_.next[i][axis] : below_[i][axis];
        if (end == no_index) add(c, missing, false);
        add_beside(end, c, axis, missing);
    }

private:
    /// The four grid points beside a corner, across an axis; the corner itself may be missing.
    void add_beside(Index i, const VoxelCoord& c, unsigned axis, std::vector<MortonCode>& missing) const {
        for (unsigned other : {(axis + 1) % 3, (axis + 2) % 3})
            for (bool up : {false, true}) {
                if (i != no_index && (up ? lattice_.next : below_)[i][other] != no_index) continue;
                VoxelCoord d = c;
                d[other] += up ? 1 : -1;
                add(d, missing, i == no_index);
            }
    }
    /// But for those beyond the margin around the bounding cube, and, in doubt, those there are.
    void add(const VoxelCoord& c, std::vector<MortonCode>& missing, bool in_doubt) const {
        if (std::any_of(c.begin(), c.end(), [&](int x) { return x < -1 || x > side_ + 1; })) return;
        if (!in_doubt || lattice_.index.find(lattice_.code(c)) == no_index)
            missing.push_back(lattice_.code(c));
    }

    const CornerLattice& lattice_;
    std::vector<std::array<Index, 3>> below_;
    int side_;
};

} // namespace

std::vector<std::array<Index, 3>> corners_below(const CornerLattice& lattice) {
    std::vector<std::array<Index, 3>> below(lattice.size(), {no_index, no_index, no_index});
    for_chunks(lattice.size(), corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t c = begin; c < end; ++c)
            for (unsigned axis = 0; axis < 3; ++axis)
                if (const Index next = lattice.next[c][axis]; next != no_index)
                    below[next][axis] = static_cast<Index>(c);
    });
    return below;
}

CornerLattice build_corner_lattice(const OctreeLevel& level) {
    CornerLattice lattice;
    lattice.codes = corner_codes(level);
    lattice.index.build(lattice.codes);
    connect_voxels(level, lattice);
    lattice.next.resize(lattice.size());
    for_chunks(lattice.size(), corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) connect_corner(lattice, i);
    });
    return lattice;
}

namespace {

/// Members and their sheets by the smooth relation alone; the sheets are not measured yet.
LocalSheets connect_members(const CornerLattice& lattice, const NormalSets& sets,
                            const RelationTest& related) {
    LocalSheets result;
    const std::size_t n = lattice.size();
    result.first_member.assign(n + 1, 0);
    std::vector<std::vector<SheetMember>> members(chunk_count(n, corners_per_chunk));
    for_chunks(n, corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        Corner corner;
        for (std::size_t i = begin; i < end; ++i) {
            corner.gather(lattice.voxels[i], sets);
            corner.connect(sets, related);
            const auto last = corner.members.begin() + static_cast<std::ptrdiff_t>(corner.member_count);
            members[chunk].insert(members[chunk].end(), corner.members.begin(), last);
            result.first_member[i + 1] = static_cast<Index>(corner.member_count);
        }
    });
    result.members = joined(members);
    counts_to_first(result.first_member);
    return result;
}

/// Are two sets of one sheet at another corner near by?
bool joined_nearby(const CornerLattice& lattice, const LocalSheets& sheets, const VoxelCoord& c, Index a,
                   Index b) {
    for (const VoxelCoord& o : neighbor_offsets) {
        const Index corner = lattice.index.find(CornerLattice::code({c[0] + o[0], c[1] + o[1], c[2] + o[2]}));
        if (corner == no_index) continue;
        int sheet_a = -1, sheet_b = -2;
        for (const SheetMember& m : sheets.members_at(corner)) {
            if (m.set == a) sheet_a = m.sheet;
            if (m.set == b) sheet_b = m.sheet;
        }
        if (sheet_a == sheet_b) return true;
    }
    return false;
}

std::vector<Index> corners_with_several(const LocalSheets& sheets) {
    const std::size_t n = sheets.first_member.size() - 1;
    std::vector<std::vector<Index>> parts(chunk_count(n, corners_per_chunk));
    for_chunks(n, corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto members = sheets.members_at(static_cast<Index>(i));
            if (std::any_of(members.begin(), members.end(), [](const SheetMember& m) { return m.sheet > 0; }))
                parts[chunk].push_back(static_cast<Index>(i));
        }
    });
    return joined(parts);
}

/// Closure: two sets that are one sheet at one corner are one sheet at every corner they share, unless their
/// normals are so far apart that they only met round the rim of a thin part. Repeats until nothing changes;
/// only corners with several sheets are looked at, and in rounds, so that the order does not matter.
void close_sheets(const CornerLattice& lattice, const NormalSets& sets, LocalSheets& sheets) {
    const std::vector<Index> open = corners_with_several(sheets);
    struct Merge {
        Index corner;
        std::uint8_t kept, merged;
    };
    for (int round = 0; round < closure_rounds; ++round) {
        std::vector<std::vector<Merge>> found(chunk_count(open.size(), 256));
        for_chunks(open.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
            for (std::size_t k = begin; k < end; ++k) {
                const auto members = sheets.members_at(open[k]);
                const VoxelCoord c = lattice.coord(open[k]);
                for (std::size_t i = 0; i < members.size(); ++i)
                    for (std::size_t j = i + 1; j < members.size(); ++j) {
                        if (members[i].sheet == members[j].sheet) continue;
                        const Index a = members[i].set, b = members[j].set;
                        if ((sets.sets[a].normal | sets.sets[b].normal) < least_closure_cosine) continue;
                        if (!joined_nearby(lattice, sheets, c, a, b)) continue;
                        found[chunk].push_back({open[k], std::min(members[i].sheet, members[j].sheet),
                                                std::max(members[i].sheet, members[j].sheet)});
                    }
            }
        });
        bool changed = false;
        for (const auto& merges : found)
            for (Merge m : merges) {
                SheetMember* first = sheets.members.data() + sheets.first_member[m.corner];
                const std::size_t n = sheets.first_member[m.corner + 1] - sheets.first_member[m.corner];
                for (std::size_t i = 0; i < n; ++i)
                    if (first[i].sheet == m.merged) first[i].sheet = m.kept, changed = true;
            }
        if (!changed) break;
    }
}

} // namespace

LocalSheets group_local_sheets(const CornerLattice& lattice, const NormalSets& sets,
                               const RelationTest& related, double voxel_size) {
    LocalSheets result = connect_members(lattice, sets, related);
    close_sheets(lattice, sets, result);
    const std::size_t n = lattice.size();
    result.first_sheet.assign(n + 1, 0);
    std::vector<std::vector<LocalSheet>> sheets(chunk_count(n, corners_per_chunk));
    for_chunks(n, corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        Corner corner;
        for (std::size_t i = begin; i < end; ++i) {
            SheetMember* first = result.members.data() + result.first_member[i];
            corner.take({first, result.members.data() + result.first_member[i + 1]});
            const VoxelCoord c = lattice.coord(static_cast<Index>(i));
            corner.measure(Vec3(c[0], c[1], c[2]) * voxel_size, sets, voxel_size);
            corner.snap(voxel_size);
            std::copy_n(corner.members.begin(), corner.member_count, first);
            const auto last = corner.sheets.begin() + static_cast<std::ptrdiff_t>(corner.sheet_count);
            sheets[chunk].insert(sheets[chunk].end(), corner.sheets.begin(), last);
            result.first_sheet[i + 1] = static_cast<Index>(corner.sheet_count);
        }
    });
    result.sheets = joined(sheets);
    counts_to_first(result.first_sheet);
    return result;
}

std::size_t extend_lattice(CornerLattice& lattice, LocalSheets& sheets, const OctreeLevel& level) {
    const std::size_t n = lattice.size();
    const MissingCorners corners(lattice, 1 << level.depth);
    std::vector<std::vector<MortonCode>> parts(chunk_count(n, corners_per_chunk));
    for_chunks(n, corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t i = begin; i < end; ++i)
            for (const LocalSheet& sheet : sheets.sheets_at(static_cast<Index>(i)))
                for (unsigned axis = 0; axis < 3; ++axis) {
                    const double rise = sheet.normal[axis] * level.voxel_size;
                    const bool inside = sheet.distance < 0;
                    for (bool up : {true, false})
                        if (inside != (sheet.distance + (up ? rise : -rise) < 0))
                            corners.add(static_cast<Index>(i), axis, up, parts[chunk]);
                }
    });
    std::vector<MortonCode> missing = joined(parts);
    if (missing.empty()) return 0;
    tbb::parallel_sort(missing.begin(), missing.end());
    missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    lattice.codes.insert(lattice.codes.end(), missing.begin(), missing.end());
    lattice.index.build(lattice.codes);
    lattice.voxels.resize(lattice.size(), no_voxels);
    lattice.next.resize(lattice.size());
    for_chunks(missing.size(), corners_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = n + begin; i < n + end; ++i) {
            connect_corner(lattice, i);
            for (unsigned axis = 0; axis < 3; ++axis) {
                VoxelCoord below = lattice.coord(static_cast<Index>(i));
                --below[axis];
                const Index corner = lattice.index.find(CornerLattice::code(below));
                // Corners added connect themselves.
                if (corner != no_index && corner < n) lattice.next[corner][axis] = static_cast<Index>(i);
            }
        }
    });
    sheets.first_member.resize(lattice.size() + 1, sheets.first_member.back());
    sheets.first_sheet.resize(lattice.size() + 1, sheets.first_sheet.back());
    return missing.size();
}

} // namespace hsdm
