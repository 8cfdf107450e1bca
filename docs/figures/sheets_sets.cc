// Normal sets, their relations, local sheets and the sides of grid points.

#include "steps.hh"

#include <array>
#include <cmath>
#include <map>

namespace hsdm::figures {
namespace {

const Vec3 up(0, 0, 1);

/// By the side that a set faces.
const std::string& set_colour(const NormalSet& set) {
    static const std::array<std::string, 4> colours{colour::purple, colour::blue, colour::green,
                                                    colour::orange};
    const double turns = std::atan2(set.normal[1], set.normal[0]) / (2 * std::acos(-1.0)) + 1;
    return colours[static_cast<std::size_t>(std::lround(4 * turns)) % 4];
}

void draw_set_points(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer) {
    std::map<std::string, std::vector<std::array<Vec2, 2>>> dots;
    for (Index p = 0; p < steps.octree.size(); ++p) {
        const Index s = steps.sets.of_point[p];
        const Vec2 at = layer.flat(steps.octree.positions[p]);
        if (s == no_index || !layer.has_voxel(steps.sets.sets[s].voxel) || !panel.holds(at)) continue;
        dots[set_colour(steps.sets.sets[s])].push_back({panel(at), panel(at)});
    }
    for (const auto& [fill, points] : dots) canvas.lines(points, {.stroke = fill, .width = 3.4});
}

void draw_set(Canvas& canvas, const Panel& panel, const Layer& layer, const NormalSet& set, double length,
              const std::string& stroke) {
    const Vec2 at = layer.flat(set.centroid);
    const Vec2 normal(set.normal[0], set.normal[1]);
    canvas.arrow(panel(at), panel(at + length * normal), {.stroke = stroke, .width = 2});
    canvas.circle(panel(at), 5, {.stroke = colour::white, .width = 1.2, .fill = stroke});
}

/// A plate half a voxel thick, turned by 20 degrees.
support::Solid turned_plate() {
    return support::box({1, 0.065, 1}).placed(support::turned(up, 0.35));
}

/// A block with a wall on it: creases of both kinds and two sides.
support::Solid block_with_wall(double thickness) {
    const auto block = support::box({0.9, 0.3, 1});
    const auto wall = support::box({thickness, 0.75, 1}).placed(support::turned(up, 0, Vec3(0.1, 0.3, 0)));
    return (block | wall).placed(support::turned(up, 0.2));
}

bool are_beside(const VoxelCoord& a, const VoxelCoord& b) {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) <= 1;
}

bool are_adjacent(const VoxelCoord& a, const VoxelCoord& b) {
    return a[2] == b[2] && std::abs(a[0] - b[0]) <= 1 && std::abs(a[1] - b[1]) <= 1;
}

Style relation_style(Relation relation) {
    switch (relation) {
    case Relation::smooth:
        return {.stroke = colour::blue, .width = 2.5};
    case Relation::convex:
        return {.stroke = colour::red, .width = 2.5, .dash = "7 3"};
    case Relation::concave:
        return {.stroke = colour::green, .width = 2.5, .dash = "2 3"};
    case Relation::none:
        break;
    }
    return {.stroke = colour::grey, .width = 1, .dash = "1 3"};
}

void draw_relations_in(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer) {
    const auto& sets = steps.sets.sets;
    for (const Relation drawn : {Relation::none, Relation::smooth, Relation::convex, Relation::concave})
        for (std::size_t i = 0; i < sets.size(); ++i)
            for (std::size_t j = i + 1; j < sets.size(); ++j) {
                if (!layer.has_voxel(sets[i].voxel) || !layer.has_voxel(sets[j].voxel)) continue;
                const VoxelCoord a = steps.level.coord(sets[i].voxel), b = steps.level.coord(sets[j].voxel);
                if (!are_adjacent(a, b) || steps.related(sets[i], sets[j]) != drawn) continue;
                if (drawn == Relation::none && !are_beside(a, b)) continue;
                canvas.line(panel(layer.flat(sets[i].centroid)), panel(layer.flat(sets[j].centroid)),
                            relation_style(drawn));
            }
}

/// From a grid point towards each of its sheets, as far as the sheet is away there.
void draw_distances(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer, Index c) {
    for (const LocalSheet& sheet : steps.local.sheets_at(c)) {
        const double distance = sheet.distance / sheet.weight / steps.h();
        const Vec2 normal = Vec2(sheet.normal[0], sheet.normal[1]).normalized();
        const Vec2 from = layer.grid_point(c), to = from - distance * normal;
        const std::string& stroke = distance > 0 ? colour::red : colour::blue;
        canvas.line(panel(from), panel(to), {.stroke = stroke, .width = 1.5});
        const Vec2 along = Vec2(-normal[1], normal[0]) * 0.09;
        canvas.line(panel(to - along), panel(to + along), {.stroke = stroke, .width = 2.5});
    }
}

Style side_style(Side side) {
    if (side == Side::inside) return {.stroke = colour::black, .width = 1.2, .fill = colour::black};
    if (side == Side::outside) return {.stroke = colour::black, .width = 1.5, .fill = colour::white};
    return {.stroke = colour::grey, .width = 1, .fill = colour::pale};
}

} // namespace

Canvas draw_sets() {
    const Steps steps(scan(turned_plate(), 12000), 3);
    const Layer layer(steps, 4);
    auto [canvas, panel, legend] = figure_of({2.9, 0.7}, {8.1, 3.9}, 95, 245);
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    draw_voxels(canvas, panel, steps, layer);
    draw_set_points(canvas, panel, steps, layer);
    for (const NormalSet& set : steps.sets.sets)
        if (layer.has_voxel(set.voxel))
            draw_set(canvas, panel, layer, set, 0.3, colour::darkened(set_colour(set), 0.6));
    canvas.end_clip();
    const std::array<Entry, 7> entries{
        Entry{.text = "One layer of voxels"},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::blue}, "points of one side", 2.5},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::orange}, "points of the other", 2.5},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::purple}, "points of the rim", 2.5},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::black}, "a set: its centroid", 5},
        {Entry::Mark::arrow, {.width = 2}, "and its mean normal"},
        {Entry::Mark::square, {.stroke = "#b5b5b5", .fill = colour::faint}, "voxel that holds points", 7}};
    canvas.legend(legend, entries);
    return canvas;
}

Canvas draw_relations() {
    const Steps steps(scan(block_with_wall(0.07), 30000), 3);
    const Layer layer(steps, 4);
    auto [canvas, panel, legend] = figure_of({-0.1, -0.1}, {8.1, 8.1}, 62, 225);
    draw_voxels(canvas, panel, steps, layer);
    draw_relations_in(canvas, panel, steps, layer);
    for (const NormalSet& set : steps.sets.sets)
        if (layer.has_voxel(set.voxel)) draw_set(canvas, panel, layer, set, 0.28, colour::black);
    const std::array<Entry, 6> entries{
        Entry{.text = "Relation of two sets"},
        {Entry::Mark::line, relation_style(Relation::smooth), "smooth: one sheet"},
        {Entry::Mark::line, relation_style(Relation::convex), "convex crease"},
        {Entry::Mark::line, relation_style(Relation::concave), "concave crease"},
        {Entry::Mark::line, relation_style(Relation::none), "none"},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::black}, "a set and its normal", 5}};
    canvas.legend(legend, entries);
    return canvas;
}

Canvas draw_signs() {
    const Steps steps(scan(block_with_wall(0.22), 30000), 3);
    const Layer layer(steps, 4);
    auto [canvas, panel, legend] = figure_of({0.6, 1.6}, {7.4, 7.4}, 74, 235);
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    draw_voxels(canvas, panel, steps, layer);
    draw_section(canvas, panel, layer.section(steps.mesh), {.stroke = colour::grey, .width = 1.5});
    const std::vector<Side> sides = sides_of(steps);
    const auto has_sheet = [&](Index c) {
        return c + 1 < steps.local.first_sheet.size() && !steps.local.sheets_at(c).empty();
    };
    for (Index c = 0; c < steps.grid.size(); ++c)
        if (layer.has_grid_point(c) && has_sheet(c)) draw_distances(canvas, panel, steps, layer, c);
    for (Index c = 0; c < steps.grid.size(); ++c)
        if (layer.has_grid_point(c) && has_sheet(c))
            canvas.circle(panel(layer.grid_point(c)), 5, side_style(sides[c]));
    canvas.end_clip();
    const std::array<Entry, 7> entries{
        Entry{.text = "Sides of grid points"},
        {Entry::Mark::dot, side_style(Side::inside), "inside the solid", 5},
        {Entry::Mark::dot, side_style(Side::outside), "outside", 5},
        {Entry::Mark::line, {.stroke = colour::blue, .width = 2}, "so far below a local sheet"},
        {Entry::Mark::line, {.stroke = colour::red, .width = 2}, "so far above a local sheet"},
        {Entry::Mark::line, {.stroke = colour::grey, .width = 1.5}, "the mesh in the end"},
        {Entry::Mark::square, {.stroke = "#b5b5b5", .fill = colour::faint}, "voxel that holds points", 7}};
    canvas.legend(legend, entries);
    return canvas;
}

} // namespace hsdm::figures
