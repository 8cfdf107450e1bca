#include "hsdm/octree/octree.hh"

#include "hsdm/cloud/strided.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/radix_sort.hh"
#include "hsdm/errors.hh"

#include <tbb/parallel_invoke.h>

#include <atomic>
#include <cmath>
#include <span>
#include <tuple>

namespace hsdm {
Vec3 centred_origin(const Box& bounds, double extent) {
    Vec3 origin;
    // A side as long as the cube's: rounding must not leave its ends a hair outside.
    for (unsigned k = 0; k < 3; ++k)
        origin[k] =
            std::clamp(bounds.lo[k] + bounds.size()[k] / 2 - extent / 2, bounds.hi[k] - extent, bounds.lo[k]);
    return origin;
}

namespace {

constexpr double cells = 1 << morton_levels; // along an edge of the cube
constexpr std::size_t ahead = gathered_ahead;

const Vec3 zero(0, 0, 0); // adding it turns -0 into 0: which of two equal points comes first must not show

/// A normal as it was given, or (0, 0, 0) if it has no direction.
Vec3 directed_or_zero(const Vec3& n) {
    const double length = n.norm();
    return length > 0 && std::isfinite(length) ? n : zero;
}

/// change(vector) of the vectors at these places.
template <class Change>
std::vector<Vec3> gathered(const StridedSpan& rows, const std::vector<Index>& places, const Change& change) {
    std::vector<Vec3> result = unwritten_vector<Vec3>(places.size());
    for_each_index(places.size(), chunks::light, [&](Index i) {
        if (i + ahead < places.size()) __builtin_prefetch(row_of(rows, places[i + ahead]));
        result[i] = change(vec3_at(rows, places[i]));
    });
    return result;
}

/// Level-21 code of a position relative to the cube; the cube's far faces belong to the last voxel.
MortonCode code_of(const Vec3& relative, double scale) {
    constexpr double last = (1 << morton_levels) - 1;
    std::array<std::uint32_t, 3> c;
    for (unsigned k = 0; k < 3; ++k) {
        const double x = relative[k] * scale;
        c[k] = x > 0 ? static_cast<std::uint32_t>(std::min(x, last)) : 0; // NaN goes to the first voxel
    }
    return morton_encode(c[0], c[1], c[2]);
}

} // namespace

Vec3 normal_in_octree(const Vec3& given) {
    const double length = given.norm();
    return length > 0 && std::isfinite(length) ? given / length + zero : zero; // -0 becomes 0
}

MortonCode code_at(const Vec3& relative, double extent) {
    return code_of(relative, cells / extent);
}

namespace {

/// Points in the octree's order: their codes, and their indices in the cloud.
struct Order {
    std::vector<MortonCode> codes;
    std::vector<Index> source;
};

constexpr int index_bits = 8 * sizeof(Index);
/// A cell is what the other bits of a key tell apart: by so many bits codes of one cell may differ.
constexpr int in_cell = 3 * morton_levels - (64 - index_bits);

/// A point's cell and, below it, its index.
std::uint64_t key_of(MortonCode code, Index i) {
    return code >> in_cell << index_bits | i;
}

/// The order of sorted keys.
Order order_of(const std::vector<MortonCode>& codes, const std::vector<std::uint64_t>& keys) {
    Order order{unwritten_vector<MortonCode>(keys.size()), unwritten_vector<Index>(keys.size())};
    for_each_index(keys.size(), chunks::light, [&](Index i) {
        if (i + ahead < keys.size()) __builtin_prefetch(&codes[static_cast<Index>(keys[i + ahead])]);
        order.source[i] = static_cast<Index>(keys[i]);
        order.codes[i] = codes[order.source[i]];
    });
    return order;
}

/// Sorts by all of the codes.
void sort_by_codes(Order& order) {
    std::vector<CodeIndex> points = unwritten_vector<CodeIndex>(order.codes.size());
    for_each_index(points.size(), chunks::light, [&](Index i) {
        points[i] = {order.codes[i], order.source[i]};
    });
    radix_sort(points, 3 * morton_levels);
    for_each_index(points.size(), chunks::light, [&](Index i) {
        order.codes[i] = points[i].code;
        order.source[i] = points[i].index;
    });
}

/// Sorts by cells, or by all of the code where one of these is crowded: an outlier far away leaves few cells
/// to all other points. Returns by how many bits codes of one cell may differ.
int sort_by_cells(std::vector<MortonCode> codes, std::vector<std::uint64_t> keys, Order& order) {
    constexpr std::size_t crowd = 256;
    radix_sort(keys, 64, index_bits);
    order = order_of(codes, keys);
    codes = std::vector<MortonCode>();
    for (std::size_t i = 0; i + crowd < keys.size(); i += crowd)
        if (keys[i] >> index_bits == keys[i + crowd] >> index_bits) {
            keys = std::vector<std::uint64_t>();
            sort_by_codes(order);
            return 0;
        }
    return in_cell;
}

/// What orders points of one code.
auto tie_of(const StridedSpan& positions, const StridedSpan& normals, Index i) {
    const Vec3 p = vec3_at(positions, i);
    const Vec3 n = normals.count == 0 ? zero : directed_or_zero(vec3_at(normals, i)); // NaN has no order
    return std::tuple(p[0], p[1], p[2], n[0], n[1], n[2], i);
}

/// Do points come as order_points() would put them?
bool are_in_order(const StridedSpan& positions, const StridedSpan& normals,
                  const std::vector<MortonCode>& codes) {
    std::atomic<bool> are = true;
    for_chunks(codes.size(), chunks::light, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = std::max<std::size_t>(begin, 1); i < end && are; ++i)
            if (codes[i - 1] > codes[i]
                || (codes[i - 1] == codes[i]
                    && tie_of(positions, normals, static_cast<Index>(i - 1))
                           > tie_of(positions, normals, static_cast<Index>(i))))
                are = false;
    });
    return are;
}

/// Orders the points of one cell by code, then position, then normal if there are some. `points`: space to
/// work in.
void order_cell(const StridedSpan& positions, const StridedSpan& normals, std::size_t begin, std::size_t end,
                Order& order, std::vector<CodeIndex>& points) {
    const auto key = [&](Index i) { return tie_of(positions, normals, i); };
    points.clear();
    for (std::size_t i = begin; i < end; ++i) points.push_back({order.codes[i], order.source[i]});
    std::sort(points.begin(), points.end(), [&](const CodeIndex& a, const CodeIndex& b) {
        return a.code != b.code ? a.code < b.code : key(a.index) < key(b.index);
    });
    for (std::size_t i = begin; i < end; ++i) {
        order.codes[i] = points[i - begin].code;
        order.source[i] = points[i - begin].index;
    }
}

/// Orders points by code, then position, then normal. Cells are sorted by digits; few points of a surface
/// share one, and those few are compared.
Order order_points(const StridedSpan& positions, const StridedSpan& normals, std::vector<MortonCode> codes,
                   std::vector<std::uint64_t> keys) {
    Order order;
    const int differing = sort_by_cells(std::move(codes), std::move(keys), order);
    const std::size_t size = order.codes.size();
    const auto cell = [&](std::size_t i) { return order.codes[i] >> differing; };
    // chunks end at cell boundaries
    std::vector<std::size_t> first(chunk_count(size, chunks::light) + 1, size);
    for (std::size_t chunk = 0; chunk + 1 < first.size(); ++chunk) {
        std::size_t i = chunk * chunks::light;
        if (chunk > 0) i = std::max(i, first[chunk - 1]);
        while (i > 0 && i < size && cell(i - 1) == cell(i)) ++i;
        first[chunk] = i;
    }
    for_each_task(first.size() - 1, [&](std::size_t chunk) {
        std::vector<CodeIndex> points;
        for (std::size_t begin = first[chunk], end; begin < first[chunk + 1]; begin = end) {
            for (end = begin + 1; end < first[chunk + 1] && cell(begin) == cell(end);) ++end;
            if (end > begin + 1) order_cell(positions, normals, begin, end, order, points);
        }
    });
    return order;
}

/// Removes points equal to their predecessor in position and normal; equal points are neighbours by now, the
/// first in the cloud before the others. Adds the others to `duplicates` if it is not null. Returns how many.
std::size_t merge_equal(const StridedSpan& positions, const StridedSpan& normals, Order& order,
                        std::vector<Octree::Duplicate>* duplicates) {
    const std::size_t size = order.codes.size();
    const auto direction = [&](std::size_t i) { return directed_or_zero(vec3_at(normals, order.source[i])); };
    const std::vector<Index> equal = indices_where(size, chunks::light, [&](Index i) {
        return i > 0 && order.codes[i - 1] == order.codes[i]
               && vec3_at(positions, order.source[i - 1]) == vec3_at(positions, order.source[i])
               && (normals.count == 0 || direction(i - 1) == direction(i));
    });
    if (equal.empty()) return 0;
    std::size_t kept = 0, merged = 0;
    for_each_in_order(size, [&](std::size_t i) {
        if (merged < equal.size() && equal[merged] == i) {
            ++merged;
            if (duplicates) duplicates->push_back({order.source[kept - 1], order.source[i]});
            return;
        }
        order.codes[kept] = order.codes[i];
        order.source[kept++] = order.source[i];
    });
    order.codes.resize(kept);
    order.source.resize(kept);
    if (duplicates)
        std::sort(duplicates->begin(), duplicates->end(), [](const auto& a, const auto& b) {
            return std::tie(a.first, a.other) < std::tie(b.first, b.other);
        });
    return merged;
}

template <class T>
void keep_unmarked(std::vector<T>& values, std::span<const std::uint8_t> marked) {
    if (values.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < marked.size(); ++i)
        if (!marked[i]) values[kept++] = values[i];
    values.resize(kept);
}

/// The octree's box, its cube and where that lies. Throws Error, OptionError.
void place_cube(const PointView& cloud, const OctreeOptions& options, Octree& octree) {
    if (!options.skip_nonfinite && find_nonfinite(cloud.positions).count > 0)
        throw Error("the cloud holds coordinates that are not finite; call drop_nonfinite first");
    const Box bounds = options.whole ? *options.whole : finite_bounds(cloud.positions);
    octree.bounds = {bounds.lo * (1 / options.unit) + zero, bounds.hi * (1 / options.unit) + zero};
    octree.origin = octree.bounds.lo;
    octree.extent = octree.bounds.extent();
    if (octree.extent <= 0) throw Error("all points are equal; a surface needs points that differ");
    if (!has_voxels(octree.bounds))
        throw Error("the cloud is too large or too small for double precision; scale it, or give a unit");
    if (options.cube_extent != 0) {
        check_option(options.cube_extent >= octree.extent, "cube_extent", options.cube_extent,
                     "be 0 or at least " + std::to_string(octree.extent));
        octree.extent = options.cube_extent;
    }
    if (options.placement == CubePlacement::centred)
        octree.origin = centred_origin(octree.bounds, octree.extent);
    if (!options.origin) return;
    octree.origin = *options.origin;
    for (unsigned k = 0; k < 3; ++k)
        if (!(octree.origin[k] <= octree.bounds.lo[k])
            || !(octree.bounds.hi[k] <= octree.origin[k] + octree.extent))
            throw OptionError("the cube at `origin`, of edge `cube_extent`, must hold the cloud");
}

/// The octree's codes of its cloud's points, and its order. Equal points are not merged.
Order order_of_cloud(const PointView& cloud, const StridedSpan& normals, const OctreeOptions& options,
                     const Octree& octree) {
    const double scale = cells / octree.extent, per_unit = 1 / options.unit;
    std::vector<MortonCode> codes = unwritten_vector<MortonCode>(cloud.size());
    std::vector<std::uint64_t> keys = unwritten_vector<std::uint64_t>(cloud.size());
    for_each_index(codes.size(), chunks::light, [&](Index i) {
        codes[i] = code_of(vec3_at(cloud.positions, i) * per_unit - octree.origin, scale);
        keys[i] = key_of(codes[i], i);
    });
    if (options.skip_nonfinite)
        std::erase_if(keys, [&](std::uint64_t key) {
            return !is_finite(vec3_at(cloud.positions, static_cast<Index>(key)));
        });
    return order_points(cloud.positions, normals, std::move(codes), std::move(keys));
}

/// `ours`: the cloud's normals if we may take them, or null.
Octree build(const PointView& cloud, std::vector<Vec3>* ours, const OctreeOptions& options) {
    if (cloud.size() == 0) throw Error("the cloud holds no point; nothing can be reconstructed");
    Octree octree;
    place_cube(cloud, options, octree);
    const bool with_values = options.tell_duplicates || cloud.colors.count > 0 || !cloud.scalars.empty();
    const StridedSpan normals = options.use_normals ? cloud.normals : StridedSpan();
    Order order = order_of_cloud(cloud, normals, options, octree);
    if (options.merge_duplicates)
        octree.merged_duplicates =
            merge_equal(cloud.positions, normals, order, with_values ? &octree.duplicates : nullptr);
    octree.codes = std::move(order.codes);
    octree.source = std::move(order.source);
    if (normals.count > 0) octree.normals = gathered(normals, octree.source, normal_in_octree);
    if (ours) *ours = std::vector<Vec3>();
    const double per_unit = 1 / options.unit;
    octree.positions = gathered(cloud.positions, octree.source,
                                [&](const Vec3& p) { return p * per_unit - octree.origin + zero; });
    return octree;
}

} // namespace

Octree build_octree(const PointView& cloud, const OctreeOptions& options) {
    return build(cloud, nullptr, options);
}

Octree build_octree(const PointCloud& cloud, const OctreeOptions& options) {
    return build(view_of(cloud), nullptr, options);
}

Octree build_octree_taking_normals(PointCloud& cloud, const OctreeOptions& options) {
    return build(view_of(cloud), &cloud.normals, options);
}

void rearrange(Octree& octree, std::vector<Vec3> positions, double extent) {
    octree.positions = std::vector<Vec3>();
    const Vec3 before = octree.origin;
    if (extent != octree.extent) octree.origin = centred_origin(octree.bounds, extent);
    octree.extent = extent;
    const Vec3 shift = before - octree.origin;
    const double scale = cells / extent;
    std::vector<MortonCode> codes = std::move(octree.codes);
    resize_unwritten(codes, positions.size());
    for_each_index(codes.size(), chunks::light, [&](Index i) {
        positions[i] += shift;
        codes[i] = code_of(positions[i], scale);
    });
    if (are_in_order(rows_of(positions), rows_of(octree.normals), codes)) {
        octree.codes = std::move(codes);
        octree.positions = std::move(positions);
        return;
    }
    std::vector<std::uint64_t> keys = unwritten_vector<std::uint64_t>(positions.size());
    for_each_index(keys.size(), chunks::light, [&](Index i) { keys[i] = key_of(codes[i], i); });
    Order order =
        order_points(rows_of(positions), rows_of(octree.normals), std::move(codes), std::move(keys));
    octree.codes = std::move(order.codes);
    octree.source = gathered(octree.source, order.source);
    if (octree.has_normals()) octree.normals = gathered(octree.normals, order.source);
    octree.positions = gathered(positions, order.source);
}

Occurrences remove_points(Octree& octree, std::span<const std::uint8_t> marked) {
    const auto first = std::find(marked.begin(), marked.end(), 1) - marked.begin();
    const auto count = static_cast<std::size_t>(std::count(marked.begin(), marked.end(), 1));
    if (count == 0) return {};
    const Occurrences discarded{count, octree.positions[static_cast<std::size_t>(first)] + octree.origin};
    tbb::parallel_invoke(
        [&] { keep_unmarked(octree.codes, marked); }, [&] { keep_unmarked(octree.positions, marked); },
        [&] { keep_unmarked(octree.normals, marked); }, [&] { keep_unmarked(octree.source, marked); });
    return discarded;
}

bool has_voxels(const Box& bounds) {
    return all_finite(std::array{bounds.lo, bounds.hi}) && bounds.extent() > 0
           && std::isfinite(bounds.extent()) && std::isfinite(cells / bounds.extent());
}

bool is_other_box(const Box& left, const Box& before) {
    constexpr double negligible = 1e-9; // of the box
    const double change = std::max((left.lo - before.lo).max_abs(), (left.hi - before.hi).max_abs());
    return has_voxels(left) && change > negligible * left.extent();
}

bool fit_to_points(Octree& octree) {
    if (octree.size() == 0) return false;
    const Box box = bounds_of(octree.positions);
    const Box bounds{box.lo + octree.origin, box.hi + octree.origin};
    if (!is_other_box(bounds, octree.bounds)) return false;
    octree.bounds = bounds;
    rearrange(octree, std::move(octree.positions), bounds.extent());
    return true;
}

namespace {

/// The places where shifted codes change, followed by the number of codes.
std::vector<Index> find_runs(const std::vector<MortonCode>& codes, int shift) {
    const auto add = [&](std::size_t begin, std::size_t end, std::vector<Index>& part) {
        MortonCode last = begin == 0 ? ~MortonCode{0} : codes[begin - 1] >> shift;
        std::array<Index, 256> found;
        while (begin < end) {
            std::size_t count = 0;
            const std::size_t stop = std::min(end, begin + found.size());
            for (; begin < stop; ++begin) { // without branches, of which many would be guessed wrong
                const MortonCode code = codes[begin] >> shift;
                found[count] = static_cast<Index>(begin);
                count += code != last;
                last = code;
            }
            part.insert(part.end(), found.begin(), found.begin() + count);
        }
    };
    return collected<Index>(codes.size(), chunks::light, add, static_cast<Index>(codes.size()));
}

/// The voxels of a level from its runs of points or of finer voxels.
void fill_level(const std::vector<MortonCode>& codes, int shift, const std::vector<Index>& runs,
                OctreeLevel& level) {
    resize_unwritten(level.codes, runs.size() - 1);
    for_each_index(level.codes.size(), chunks::light,
                   [&](Index v) { level.codes[v] = codes[runs[v]] >> shift; });
    level.build_index();
}

} // namespace

std::vector<Index> first_points(const Octree& octree, int depth) {
    return find_runs(octree.codes, 3 * (morton_levels - depth));
}

OctreeLevel extract_level(const Octree& octree, int depth) {
    OctreeLevel level;
    level.depth = depth;
    level.voxel_size = octree.voxel_size(depth);
    level.first_point = first_points(octree, depth);
    fill_level(octree.codes, 3 * (morton_levels - depth), level.first_point, level);
    return level;
}

OctreeLevel coarser_level(const OctreeLevel& finer, int depth) {
    OctreeLevel level;
    level.depth = depth;
    level.voxel_size = finer.voxel_size * static_cast<double>(1u << (finer.depth - depth));
    const int shift = 3 * (finer.depth - depth);
    level.first_point = find_runs(finer.codes, shift);
    fill_level(finer.codes, shift, level.first_point, level);
    for_each_index(level.first_point.size(), chunks::light,
                   [&](Index v) { level.first_point[v] = finer.first_point[level.first_point[v]]; });
    return level;
}

Index OctreeLevel::find(const VoxelCoord& c) const {
    const std::int32_t side = std::int32_t{1} << depth;
    for (std::int32_t x : c)
        if (x < 0 || x >= side) return no_index;
    return find(morton_encode(c));
}

const std::array<VoxelCoord, 26> neighbor_offsets = {{
    // 6 faces
    {-1, 0, 0},
    {1, 0, 0},
    {0, -1, 0},
    {0, 1, 0},
    {0, 0, -1},
    {0, 0, 1},
    // 12 edges
    {-1, -1, 0},
    {1, -1, 0},
    {-1, 1, 0},
    {1, 1, 0},
    {-1, 0, -1},
    {1, 0, -1},
    {-1, 0, 1},
    {1, 0, 1},
    {0, -1, -1},
    {0, 1, -1},
    {0, -1, 1},
    {0, 1, 1},
    // 8 corners
    {-1, -1, -1},
    {1, -1, -1},
    {-1, 1, -1},
    {1, 1, -1},
    {-1, -1, 1},
    {1, -1, 1},
    {-1, 1, 1},
    {1, 1, 1},
}};

} // namespace hsdm
