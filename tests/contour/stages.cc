#include "contour/stages.hh"

#include "hsdm/contour/bar_lines.hh"
#include "hsdm/contour/grid_signs.hh"
#include "hsdm/contour/trim_crossings.hh"

#include <algorithm>

namespace hsdm::support {
namespace {

template <class Test>
std::size_t sides_where(const Links& links, const Test& test) {
    std::size_t count = 0;
    for (const auto& sides : links.of_crossing)
        count += static_cast<std::size_t>(std::count_if(sides.begin(), sides.end(), test));
    return count;
}

} // namespace

Stages::Stages(const PointCloud& cloud, int depth, double cube_extent)
    : octree(build_octree(cloud, {.cube_extent = cube_extent})),
      level(extract_level(octree, depth)),
      sets(build_normal_sets(octree, level)),
      related({}, level.voxel_size) {
    voxel_size = level.voxel_size;
    grid = build_grid_points(level);
    move_to_bar_lines(grid, sets, related, h());
    LocalSheets local = group_local_sheets(grid, sets, related, h());
    extend_grid_points(grid, local, level);
    crossings = find_crossings(grid, local, sets, related, h());
    ask_points_at_bars(octree, level, grid, crossings);
    crossings = label_grid_signs(grid, beliefs_of_sheets(local, h()), sets, std::move(crossings), h());
    pair();
    place();
}

Stages::Stages(const Solid& solid, std::size_t points, int depth)
    : Stages(sample(solid, {.points = points}), depth) {}

void Stages::pair() {
    links = pair_crossings(grid, crossings, sets, related);
}

void Stages::place() {
    duals = build_dual_vertices(grid, crossings, sets, h(), links);
    vertices = place_vertices(*this, sets, related);
}

void Stages::trim() {
    while (trim_unsupported(crossings, links) > 0) pair();
    place();
}

Box Stages::voxel_of(FacetCorner corner) const {
    const Index edge = crossings.of(corner).edge;
    const unsigned octant = corner.octant(edge % 3);
    const VoxelCoord at = grid.coord(edge / 3);
    Box box;
    for (unsigned k = 0; k < 3; ++k) {
        box.lo[k] = (at[k] - (octant >> k & 1u ? 0 : 1)) * h();
        box.hi[k] = box.lo[k] + h();
    }
    return box;
}

Crossings without(const Crossings& crossings, const std::vector<std::uint8_t>& marked) {
    Crossings kept;
    for (Index edge = 0; edge + 1 < crossings.first.size(); ++edge) {
        for (Index x = crossings.first[edge]; x < crossings.first[edge + 1]; ++x)
            if (!marked[x]) kept.crossings.push_back(crossings.crossings[x]);
        kept.first.push_back(static_cast<Index>(kept.crossings.size()));
    }
    return kept;
}

std::size_t open_sides(const Links& links) {
    return sides_where(links, [](const Link& link) { return link.open(); });
}

std::size_t rim_sides(const Links& links) {
    return sides_where(links, [](const Link& link) { return link.rim; });
}

PointCloud flat_sheet(int points_along, double width, double z) {
    PointCloud cloud;
    const double step = 1.0 / (points_along - 1);
    for (int i = 0; i < points_along; ++i)
        for (int k = 0; k * step <= width + 1e-9; ++k) {
            cloud.positions.emplace_back(i * step, k * step, z);
            cloud.normals.emplace_back(0, 0, 1);
        }
    cloud.positions.emplace_back(0, 0, 0);
    cloud.normals.emplace_back(0, 0, 0);
    return cloud;
}

PointCloud random_cloud(std::size_t points, std::uint64_t seed) {
    Random random(seed);
    PointCloud cloud;
    for (std::size_t i = 0; i < points; ++i) {
        cloud.positions.emplace_back(random.uniform(), random.uniform(), random.uniform());
        cloud.normals.push_back(random.direction());
    }
    return cloud;
}

} // namespace hsdm::support
