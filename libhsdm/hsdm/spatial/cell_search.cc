#include "hsdm/spatial/cell_search.hh"

#include "hsdm/spatial/two_triangles.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

constexpr double farthest =
    1 - 2 * FacetCells::rounding; // in cells: the 27 cells around a point hold all facets nearer than this
// of a triangle's corner angle: normals of flatter triangles are not relied on
constexpr double least_sine = 1e-4;
// factor on squared distances that covers rounding, which is 1e-12 of a triangle's size
constexpr double sure = 1 + 1e-9;

Double2 root(Double2 x) {
    return Double2{std::sqrt(x[0]), std::sqrt(x[1])};
}

} // namespace

/// Correct because every facet that reaches into a ball is listed in a cell that the ball reaches into.
double CellSearch::squared_distance(const Vec3& point) {
    const FacetCells::Place place = cells_.place(point);
    const VoxelCoord cell = FacetCells::cell_of(place);
    if (cell != cell_) enter(cell);
    const VectorPair twice(point, point);
    double squared = nearest_in(centre, twice, Box::inf);
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
        if (slot != centre) squared = nearest_in(slot, twice, squared);
    });
    return std::sqrt(squared) <= farthest * cells_.cell_size() ? squared : Box::inf;
}

void CellSearch::enter(const VoxelCoord& cell) {
    cell_ = cell;
    around_.fill({});
    bounds_.clear();
    facets_ = {};
    load(centre);
}

/// The smaller of `squared` and the squared distance to a slot's triangles. Lower bounds skip most: a
/// triangle is no nearer than its plane and than the farthest of the lines of its sides that the point lies
/// beyond; beyond none of them it is as near as its plane.
double CellSearch::nearest_in(std::size_t slot, const VectorPair& point, double squared) {
    if (!around_[slot].loaded) load(slot);
    const Slice slice = around_[slot];
    if (low_.size() < slice.end) low_.resize(slice.end);
    Double2 least = Double2{} + squared;
    for (std::size_t i = slice.begin; i < slice.end; ++i) {
        const Bounds& b = bounds_[i];
        const VectorPair arm = point - b.corner;
        const Double2 height = arm | b.normal;
        const Double2 beyond =
            max_lanes(max_lanes(arm | b.out[0], arm | b.out[1]), (arm | b.out[2]) - b.across);
        const Double2 low = square(height) + square(max_lanes(beyond, Double2{}));
        low_[i] = beyond > 0 ? low : Double2{} + Box::inf;
        least = min_lanes(least, beyond > 0 ? Double2{} + Box::inf : low);
    }
    squared = std::min(least[0], least[1]);
    for (std::size_t i = slice.begin; i < slice.end; ++i)
        if (std::min(low_[i][0], low_[i][1]) < sure * squared)
            squared = std::min(squared, exactly(bounds_[i], point));
    return squared;
}

double CellSearch::exactly(const Bounds& bounds, const VectorPair& point) const {
    TwoTriangles two;
    for (std::size_t lane = 0; lane < 2; ++lane) {
        const auto& [a, b, c] = cut_.triangles[bounds.triangle[lane]];
        const Vec3& corner = mesh_.positions[a];
        two.put(lane, corner, mesh_.positions[b] - corner, mesh_.positions[c] - corner);
    }
    const Double2 squared = two.squared_distances({point[0], point[1], point[2]});
    return std::min(squared[0], squared[1]);
}

/// Loads the facets of a slot's cell, without those listed in the centre cell too.
void CellSearch::load(std::size_t slot) {
    const auto s = static_cast<std::int32_t>(slot);
    const VoxelCoord c{cell_[0] + s % 3 - 1, cell_[1] + s / 3 % 3 - 1, cell_[2] + s / 9 - 1};
    const Index cell = std::ranges::min(c) < 0 ? no_index : cells_.find(c);
    const std::size_t begin = bounds_.size();
    std::size_t lane = 0;
    const auto list = cell == no_index ? std::span<const Index>{} : cells_.facets(cell);
    for (Index f : list) {
        if (std::ranges::binary_search(facets_, f)) continue;
        for (Index t = cut_.first[f]; t < cut_.first[f + 1]; ++t, lane = 1 - lane) {
            if (lane == 0)
                bounds_.emplace_back().triangle = {t, t};
            else
                bounds_.back().triangle[1] = t;
        }
    }
    for (std::size_t i = begin; i < bounds_.size(); ++i) prepare(bounds_[i]);
    if (slot == centre) facets_ = list;
    around_[slot] = {true, begin, bounds_.size()};
}

void CellSearch::prepare(Bounds& bounds) const {
    const auto corners = [&](std::size_t k) {
        return VectorPair(mesh_.positions[cut_.triangles[bounds.triangle[0]][k]],
                          mesh_.positions[cut_.triangles[bounds.triangle[1]][k]]);
    };
    bounds.corner = corners(0);
    const VectorPair ab = corners(1) - bounds.corner, ac = corners(2) - bounds.corner, bc = ac - ab;
    const VectorPair normal = ab % ac;
    const Double2 area = normal | normal, bb = ab | ab, cc = ac | ac;
    const auto regular = area > least_sine * least_sine * bb * cc;
    const auto unit = [&](const VectorPair& way, Double2 squared) {
        return way * (regular ? 1 / root(squared) : Double2{});
    };
    bounds.normal = unit(normal, area);
    bounds.out[0] = unit(ab % bounds.normal, bb);
    bounds.out[1] = unit(bounds.normal % ac, cc);
    bounds.out[2] = unit(bc % bounds.normal, bc | bc);
    // For a degenerate triangle no bound applies: no point counts as beyond its sides.
    bounds.across = regular ? bounds.out[2] | ab : Double2{} - std::numeric_limits<double>::min();
}

} // namespace hsdm
