#include "hsdm/simplify/intersection_check.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/point_cloud.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>
#include <array>

namespace hsdm {
namespace {

/// May a box touch one of the boxes added? True if some cell of a grid is touched by both. Counts are prefix
/// sums along the axes, so that a large box takes no longer than a small one.
class BoxGrid {
public:
    /// `whole` holds all boxes. The number of cells follows that of boxes: clearing many cells for a few
    /// boxes would take longer than testing these.
    BoxGrid(const Box& whole, std::size_t boxes) : lo_(whole.lo) {
        constexpr unsigned least_bits = 2, most_bits = 6;
        for (bits_ = least_bits; bits_ < most_bits && std::size_t{1} << 3 * bits_ < boxes; ++bits_) continue;
        counts_.assign(std::size_t{1} << 3 * bits_, 0);
        for (unsigned k = 0; k < 3; ++k)
            scale_[k] = whole.size()[k] > 0 ? static_cast<double>(side() - 1) / whole.size()[k] : 0;
    }

    void add(const Box& box) {
        for_corners(box, [&](std::size_t at, int sign) { counts_[at] -= sign; });
    }

    /// Sums up the number of boxes over each cell, then the number of covered cells before each.
    void sum_up() {
        add_along_axes();
        // the next cell in all directions; no box reaches the last cells
        const std::size_t next = 1 + side() + side() * side();
        for (std::size_t i = counts_.size(); i-- > next;) counts_[i] = counts_[i - next] > 0;
        std::fill_n(counts_.begin(), next, 0);
        add_along_axes();
    }

    bool touches(const Box& box) const {
        std::int32_t covered = 0;
        for_corners(box, [&](std::size_t at, int sign) { covered += sign * counts_[at]; });
        return covered > 0;
    }

private:
    std::size_t side() const { return std::size_t{1} << bits_; }

    std::size_t cell_of(double x, unsigned axis) const {
        return std::min(static_cast<std::size_t>((x - lo_[axis]) * scale_[axis]), side() - 2);
    }

    /// Visits the eight corners of a box in a prefix sum: the cells at its lower ends and behind its upper
    /// ones, with the sign that the sum over the box gives them.
    template <class F>
    void for_corners(const Box& box, F&& visit) const {
        std::array<std::array<std::size_t, 2>, 3> ends; // per axis the offsets of the cells at both ends
        for (unsigned k = 0; k < 3; ++k)
            ends[k] = {cell_of(box.lo[k], k) << bits_ * k, (cell_of(box.hi[k], k) + 1) << bits_ * k};
        for (unsigned corner = 0; corner < 8; ++corner) {
            const unsigned x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
            visit(ends[0][x] + ends[1][y] + ends[2][z], (x + y + z) % 2 == 1 ? 1 : -1);
        }
    }

    void add_along_axes() {
        for (std::size_t row = 0; row < counts_.size(); row += side())
            for (std::size_t x = 1; x < side(); ++x) counts_[row + x] += counts_[row + x - 1];
        for (std::size_t step = side(); step < counts_.size(); step *= side()) // rows, then layers
            for (std::size_t block = 0; block < counts_.size(); block += step * side()) {
                std::int32_t* const cells = counts_.data() + block;
                for (std::size_t at = step; at < step * side(); at += side())
                    for (std::size_t x = 0; x < side(); ++x) cells[at + x] += cells[at + x - step];
            }
    }

    Vec3 lo_, scale_;
    unsigned bits_; // per coordinate of a cell
    std::vector<std::int32_t> counts_;
};

/// Marked facets and those whose boxes may touch theirs, ascending.
std::vector<Index> with_touching(const PolygonMesh& mesh, const std::vector<std::uint8_t>& marked) {
    BoxGrid grid(bounds_of(mesh.positions), mesh.facet_count());
    for_each_in_order(marked.size(), [&](std::size_t f) {
        if (marked[f]) grid.add(box_of(mesh, f));
    });
    grid.sum_up();
    return indices_where(marked.size(), chunks::quick,
                         [&](Index f) { return marked[f] || grid.touches(box_of(mesh, f)); });
}

} // namespace

std::vector<std::array<Index, 2>> IntersectionCheck::find(const PolygonMesh& mesh, const Unchanged& same) {
    std::vector<std::uint8_t> changed = large_vector<std::uint8_t>(mesh.facet_count());
    for_each_index(changed.size(), chunks::light,
                   [&](Index f) { changed[f] = same.facet[f] == no_index || !is_clear_[same.facet[f]]; });
    const std::vector<Index> due = with_touching(mesh, changed);
    auto pairs = find_self_intersections(part_of(mesh, due)).facet_pairs;
    is_clear_.assign(mesh.facet_count(), 1);
    for (auto& pair : pairs)
        for (Index& f : pair) {
            f = due[f];
            is_clear_[f] = 0;
        }
    return pairs;
}

} // namespace hsdm
