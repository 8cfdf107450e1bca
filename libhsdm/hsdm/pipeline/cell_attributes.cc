#include "hsdm/pipeline/cell_attributes.hh"

#include "hsdm/core/large_vector.hh"
#include "hsdm/pipeline/attributes.hh"

#include <algorithm>

namespace hsdm {

const char* CellAttributes::row(Index number) {
    if (number < begin_ || number >= end_) {
        const ScratchCloud::NumberedCell cell = cloud_.cell_with(number);
        cloud_.read_attributes(cell.code, rows_);
        begin_ = cell.first, end_ = cell.first + cell.points;
    }
    return rows_.data() + (number - begin_) * cloud_.attributes().bytes();
}

const char* CellAttributes::of(const Octree& octree, std::size_t point) {
    const AttributeRows& attributes = cloud_.attributes();
    if (attributes.bytes() == 0) return nullptr;
    const Index number = octree.source[point];
    const std::span<const Octree::Duplicate> others = duplicates_of(octree, number);
    if (others.empty()) return row(number);
    std::vector<const char*> rows{row(number)}; // equal points are of one cell
    for (const Octree::Duplicate& other : others) rows.push_back(row(other.other));
    mean_.resize(attributes.bytes());
    attributes.write_mean(rows, mean_.data());
    return mean_.data();
}

std::vector<std::int32_t> scanners_of(const ScratchCloud& cloud, const Octree& octree) {
    std::vector<std::int32_t> numbers;
    if (!cloud.attributes().has_scanners()) return numbers;
    CellAttributes on_disk(cloud);
    resize_large(numbers, octree.size());
    for_each_in_order(numbers.size(),
                      [&](std::size_t i) { numbers[i] = cloud.attributes().scanner(on_disk.of(octree, i)); });
    return numbers;
}

std::vector<char> take_attributes(const ScratchCloud& cloud, const VoxelRange& range, Octree& octree) {
    const AttributeRows& attributes = cloud.attributes();
    const std::size_t bytes = attributes.bytes();
    if (attributes.columns().empty() && !attributes.has_kinds()) return {};
    const int shift = 3 * (morton_levels - range.depth);
    const auto first_of = [&](MortonCode code) {
        return static_cast<std::size_t>(std::ranges::lower_bound(octree.codes, code << shift)
                                        - octree.codes.begin());
    };
    const std::size_t begin = first_of(range.begin), end = first_of(range.end);
    std::vector<char> rows = large_vector<char>((end - begin) * bytes);
    CellAttributes on_disk(cloud);
    for_each_in_order(octree.size(), [&](std::size_t i) {
        const bool is_own = i >= begin && i < end;
        const auto number = static_cast<Index>(is_own ? i - begin : 0);
        PointKind kind = PointKind::measured;
        if (is_own || attributes.has_kinds()) {
            const char* const row = on_disk.of(octree, i);
            if (is_own) std::copy_n(row, bytes, rows.begin() + static_cast<std::ptrdiff_t>(number * bytes));
            if (attributes.has_kinds()) kind = attributes.kind(row);
        }
        octree.source[i] = source_of(kind, number);
    });
    octree.duplicates.clear(); // rows have the means of equal points, by other numbers
    return rows;
}

} // namespace hsdm
