#include "hsdm/spatial/cell_search.hh"

#include "hsdm/spatial/two_triangles.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

constexpr double farthest =
    1 - 2 * FacetCells::rounding; // in cells: the 27 cells around a point hold all facets nearer than this
// factor on squared distances that covers rounding, which is 1e-12 of a triangle's size
constexpr double sure = 1 + 1e-9;

} // namespace

/// Correct because every facet that reaches into a ball is listed in a cell that the ball reaches into.
double CellSearch::squared_distance(const Vec3& point) {
    const FacetCells::Place place = cells_.place(point);
    const VoxelCoord cell = FacetCells::cell_of(place);
    if (cell != cell_) enter(cell);
    double squared = nearest_in(centre, point, Box::inf);
    const double reach = std::min(std::sqrt(squared) / cells_.cell_size(), farthest) + FacetCells::rounding;
    CellRange beside;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
        const double from_wall = place[k] - cell[k];
        beside.lo[k] = from_wall < reach ? 0 : 1;
        beside.hi[k] = from_wall + reach < 1 ? 1 : 2;
        inside &= beside.lo[k] == beside.hi[k];
    }
    if (inside) return squared;
    beside.for_each([&](const VoxelCoord& c) {
        const auto slot = static_cast<std::size_t>(c[0] + 3 * c[1] + 9 * c[2]);
        if (slot != centre) squared = nearest_in(slot, point, squared);
    });
    return std::sqrt(squared) <= farthest * cells_.cell_size() ? squared : Box::inf;
}

void CellSearch::enter(const VoxelCoord& cell) {
    cell_ = cell;
    around_.fill({});
    eight_count_ = 0;
    facets_ = {};
    load(centre);
}

/// The smaller of `squared` and the squared distance to a slot's triangles. Lower bounds skip most.
double CellSearch::nearest_in(std::size_t slot, const Vec3& point, double squared) {
    if (!around_[slot].loaded) load(slot);
    const Slice slice = around_[slot];
    const std::size_t eights = chunk_count(slice.triangles, EightBounds::size);
    if (beyond_.size() < eights) beyond_.resize(eights);
    const Eight* const first = eights_.data() + slice.first;
    double least = Box::inf;
    for (std::size_t i = 0; i < eights; ++i) {
        const LeastSquares found = lanes_.squares(first[i].bounds, point, beyond_[i]);
        squared = std::min(squared, found.above);
        least = std::min(least, found.beyond);
    }
    if (!(least < sure * squared)) return squared;
    for (std::size_t t = 0; t < slice.triangles; t += 2) {
        const std::size_t i = t / EightBounds::size, lane = t % EightBounds::size;
        if (std::min(beyond_[i][lane], beyond_[i][lane + 1]) < sure * squared)
            squared = std::min(squared, exactly(&first[i].triangle[lane], point));
    }
    return squared;
}

double CellSearch::exactly(const Index* two_triangles, const Vec3& point) const {
    TwoTriangles two;
    for (std::size_t lane = 0; lane < 2; ++lane) {
        const auto& [a, b, c] = cut_.triangles[two_triangles[lane]];
        const Vec3& corner = mesh_.positions[a];
        two.put(lane, corner, mesh_.positions[b] - corner, mesh_.positions[c] - corner);
    }
    const auto twice = [](double x) { return Double2{x, x}; };
    const Double2 squared = two.squared_distances({twice(point[0]), twice(point[1]), twice(point[2])});
    return std::min(squared[0], squared[1]);
}

/// Loads the facets of a slot's cell, without those listed in the centre cell too.
void CellSearch::load(std::size_t slot) {
    const auto s = static_cast<std::int32_t>(slot);
    const VoxelCoord c{cell_[0] + s % 3 - 1, cell_[1] + s / 3 % 3 - 1, cell_[2] + s / 9 - 1};
    const Index cell = std::ranges::min(c) < 0 ? no_index : cells_.find(c);
    Slice slice{true, eight_count_, 0};
    const auto add = [&](Index t) {
        const std::size_t lane = slice.triangles++ % EightBounds::size;
        if (lane == 0 && eight_count_++ == eights_.size()) eights_.emplace_back();
        Eight& eight = eights_[eight_count_ - 1];
        const auto& [a, b, of_c] = cut_.triangles[t];
        eight.bounds.put(lane, mesh_.positions[a], mesh_.positions[b], mesh_.positions[of_c]);
        eight.triangle[lane] = t;
    };
    const auto list = cell == no_index ? std::span<const Index>{} : cells_.facets(cell);
    for (const Index f : list)
        if (!std::ranges::binary_search(facets_, f))
            for (Index t = cut_.first[f]; t < cut_.first[f + 1]; ++t) add(t);
    if (slice.triangles % 2 == 1)
        add(eights_[eight_count_ - 1].triangle[(slice.triangles - 1) % EightBounds::size]);
    if (const std::size_t lane = slice.triangles % EightBounds::size; lane > 0)
        eights_[eight_count_ - 1].bounds.fill_up(lane);
    for (std::size_t i = slice.first; i < eight_count_; ++i) lanes_.prepare(eights_[i].bounds);
    if (slot == centre) facets_ = list;
    around_[slot] = slice;
}

} // namespace hsdm
