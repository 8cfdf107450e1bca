#include "hsdm/spatial/facet_cells.hh"

#include "hsdm/core/large_vector.hh"
#include "hsdm/core/radix_sort.hh"
#include "hsdm/point_cloud.hh"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace hsdm {
namespace {

// mean number of cells per facet; about four if facets span the voxels of a grid
constexpr double most_cells = 16;
constexpr std::size_t most_facets = 64; // mean number of facets per cell

CellRange range_of(const FacetCells& cells, const PolygonMesh& mesh, std::size_t facet) {
    const Box box = box_of(mesh, facet);
    return {cells.cell_of(cells.place(box.lo)), cells.cell_of(cells.place(box.hi))};
}

} // namespace

FacetCells::FacetCells(const PolygonMesh& mesh, double size) : size_(size), per_size_(1 / size) {
    if (mesh.facet_count() == 0 || !fit(bounds_of(mesh.positions))) return;
    std::vector<CellRange> ranges = unwritten_vector<CellRange>(mesh.facet_count());
    const std::vector<std::size_t> offset = list_ranges(mesh, ranges);
    if (offset.empty()) return;
    std::vector<CodeIndex> entries = unwritten_vector<CodeIndex>(offset.back());
    for_chunks(mesh.facet_count(), chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        std::size_t at = offset[chunk];
        for (std::size_t f = begin; f < end; ++f)
            ranges[f].for_each([&](const VoxelCoord& c) {
                entries[at++] = {morton_encode(c), static_cast<Index>(f)};
            });
    });
    release(ranges);
    const int bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(std::ranges::max(last_))));
    radix_sort(entries, 3 * bits);
    group(entries);
    usable_ = facet_.size() <= most_facets * this->size();
}

/// Fits the grid to a box, with a layer of empty cells around it for whatever lies outside.
bool FacetCells::fit(const Box& box) {
    if (!(size_ > 0)) return false;
    constexpr double most = (1 << morton_levels) - 1;
    for (unsigned k = 0; k < 3; ++k) {
        const double first = std::floor(box.lo[k] * per_size_) - 1;
        origin_[k] = first * size_;
        last_[k] = std::floor(box.hi[k] * per_size_) - first + 1;
        if (!(std::abs(first) < most && last_[k] <= most)) return false;
    }
    return true;
}

/// Sets the cells of each facet; returns where the entries of each chunk of facets begin and end, nothing if
/// there are too many.
std::vector<std::size_t> FacetCells::list_ranges(const PolygonMesh& mesh,
                                                 std::vector<CellRange>& ranges) const {
    const std::size_t facets = mesh.facet_count(), chunks = chunk_count(facets, chunks::quick);
    std::vector<double> counts(chunks, 0.0);
    for_chunks(facets, chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t f = begin; f < end; ++f) {
            ranges[f] = range_of(*this, mesh, f);
            counts[chunk] += ranges[f].count();
        }
    });
    const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
    if (total > std::min<double>(most_cells * static_cast<double>(facets), no_index)) return {};
    std::vector<std::size_t> offset(chunks + 1, 0);
    for (std::size_t c = 0; c < chunks; ++c) offset[c + 1] = offset[c] + static_cast<std::size_t>(counts[c]);
    return offset;
}

void FacetCells::group(const std::vector<CodeIndex>& entries) {
    resize_unwritten(facet_, entries.size());
    first_ = indices_where(entries.size(), chunks::light, [&](Index i) {
        facet_[i] = entries[i].index;
        return i == 0 || entries[i].code != entries[i - 1].code;
    });
    std::vector<MortonCode> codes = unwritten_vector<MortonCode>(first_.size());
    for_each_index(codes.size(), chunks::light, [&](Index c) { codes[c] = entries[first_[c]].code; });
    index_.build(codes);
    first_.push_back(static_cast<Index>(entries.size()));
}

void FacetCells::renumber(std::span<const Index> now) {
    for_each_index(size(), chunks::light, [&](Index cell) {
        const auto begin = facet_.begin() + static_cast<std::ptrdiff_t>(first_[cell]);
        const auto end = facet_.begin() + static_cast<std::ptrdiff_t>(first_[cell + 1]);
        std::transform(begin, end, begin, [&](Index f) { return now[f]; });
        std::sort(begin, end);
    });
}

Index FacetCells::find(const VoxelCoord& c) const {
    return index_.find(morton_encode(c));
}

} // namespace hsdm
