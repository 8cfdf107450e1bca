#include "steps.hh"

#include "hsdm/contour/bar_lines.hh"
#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/patches.hh"
#include "hsdm/contour/trim_crossings.hh"
#include "hsdm/contour/webs.hh"

#include <algorithm>
#include <cmath>

namespace hsdm::figures {

PointCloud scan(const support::Solid& solid, std::size_t points) {
    support::SampleOptions options;
    options.points = points;
    return support::sample(solid, options);
}

Steps::Steps(const PointCloud& cloud, int depth)
    : octree(build_octree(cloud)),
      level(extract_level(octree, depth)),
      sets(build_normal_sets(octree, level)),
      related({}, level.voxel_size) {
    separate_patches(octree, level, related, sets);
    related = RelationTest({}, level.voxel_size, sets);
    voxel_size = level.voxel_size;
    grid = build_grid_points(level);
    move_to_bar_lines(grid, sets, related, h());
    local = group_local_sheets(grid, sets, related, h());
    extend_grid_points(grid, local, level);
    candidates = find_crossings(grid, local, sets, related, h());
    ask_points_at_bars(octree, level, grid, candidates);
    labelled = label_grid_signs(grid, local, sets, candidates, h());
    crossings = labelled;
    links = pair_crossings(grid, crossings, sets, related);
    for (int round = 0; round < 3 && trim_unsupported(crossings, links) > 0; ++round)
        links = pair_crossings(grid, crossings, sets, related);
    for (int round = 0; round < 3 && drop_tips(sets, related, links, crossings) > 0; ++round)
        links = pair_crossings(grid, crossings, sets, related);
    duals = build_dual_vertices(grid, crossings, links);
    open_all_webs(*this);
    placed = place_vertices(*this, sets, related);
    DualContour result = dual_contour(octree, level, sets);
    mesh = std::move(result.mesh);
    classes = std::move(result.classes);
}

Fine::Fine(const support::Solid& solid, std::size_t points, int deepest)
    : octree(build_octree(scan(solid, points))), depth(deepest) {
    const OctreeLevel level = extract_level(octree, depth);
    NormalSets sets = build_normal_sets(octree, level);
    separate_patches(octree, level, RelationTest({}, level.voxel_size), sets);
    mesh = dual_contour(octree, level, sets).mesh;
}

Vec2 Layer::grid_point(Index c) const {
    const VoxelCoord at = steps_.grid.coord(c);
    return {static_cast<double>(at[0]), static_cast<double>(at[1])};
}

std::vector<std::array<Vec2, 2>> Layer::section(const PolygonMesh& mesh, double height) const {
    return figures::section(mesh, (z_ + height) * steps_.h(), 1 / steps_.h());
}

std::vector<std::array<Vec2, 2>> section(const PolygonMesh& mesh, double z, double scale) {
    std::vector<std::array<Vec2, 2>> segments;
    std::vector<Vec2> cuts;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        cuts.clear();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec3 &a = mesh.positions[ring[i]], &b = mesh.positions[ring[(i + 1) % ring.size()]];
            if ((a[2] < z) == (b[2] < z)) continue;
            const Vec3 p = a + (b - a) * ((z - a[2]) / (b[2] - a[2]));
            cuts.push_back(Vec2(p[0], p[1]) * scale);
        }
        for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) segments.push_back({cuts[i], cuts[i + 1]});
    }
    return segments;
}

std::vector<Side> sides_of(const Steps& steps) {
    const GridPoints& grid = steps.grid;
    std::vector<Side> side(grid.size(), Side::unknown);
    std::vector<Index> open;
    const auto set = [&](Index c, Side s) {
        if (side[c] != Side::unknown) return;
        side[c] = s;
        open.push_back(c);
    };
    for (const Crossing& x : steps.labelled.crossings) {
        const auto around = steps.labelled.on_edge(x.edge);
        const Index lower = x.edge / 3, upper = grid.next[lower][x.edge % 3];
        set(lower, around.front().leaving ? Side::inside : Side::outside);
        if (upper != no_index) set(upper, around.back().leaving ? Side::outside : Side::inside);
    }
    const auto below = grid_points_below(grid);
    while (!open.empty()) {
        const Index c = open.back();
        open.pop_back();
        for (Index axis = 0; axis < 3; ++axis) {
            const Index up = grid.next[c][axis], down = below[c][axis];
            if (up != no_index && steps.labelled.on_edge(3 * c + axis).empty()) set(up, side[c]);
            if (down != no_index && steps.labelled.on_edge(3 * down + axis).empty()) set(down, side[c]);
        }
    }
    return side;
}

Figure figure_of(const Vec2& lo, const Vec2& hi, double scale, double legend_width) {
    constexpr double margin = 14;
    const Panel panel{{margin, margin}, lo, hi, scale};
    const Vec2 size = panel.size();
    return {Canvas(size[0] + legend_width + 3 * margin, size[1] + 2 * margin), panel,
            Vec2(size[0] + 2 * margin, margin)};
}

void draw_voxels(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer) {
    for (Index v = 0; v < steps.level.size(); ++v) {
        const VoxelCoord c = steps.level.coord(v);
        const Vec2 lo(static_cast<double>(c[0]), static_cast<double>(c[1]));
        if (!layer.has_voxel(v) || !panel.holds(lo + Vec2(0.5, 0.5), 0.5)) continue;
        canvas.rectangle(panel(lo + Vec2(0, 1)), panel(lo + Vec2(1, 0)),
                         {.stroke = "#b5b5b5", .fill = colour::faint});
    }
}

void draw_points(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer,
                 const std::string& fill) {
    std::vector<std::array<Vec2, 2>> dots;
    for (Index v = 0; v < steps.level.size(); ++v) {
        if (!layer.has_voxel(v)) continue;
        for (Index p = steps.level.first_point[v]; p < steps.level.first_point[v + 1]; ++p) {
            const Vec2 at = layer.flat(steps.octree.positions[p]);
            if (panel.holds(at, 0.1)) dots.push_back({panel(at), panel(at)});
        }
    }
    canvas.lines(dots, {.stroke = fill, .width = 3});
}

void draw_section(Canvas& canvas, const Panel& panel, std::span<const std::array<Vec2, 2>> segments,
                  const Style& style) {
    std::vector<std::array<Vec2, 2>> drawn;
    for (const auto& [a, b] : segments)
        if (panel.holds(a, 2) || panel.holds(b, 2)) drawn.push_back({panel(a), panel(b)});
    canvas.lines(drawn, style);
}

} // namespace hsdm::figures
