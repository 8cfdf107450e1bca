// Crossings on grid edges, their pairs across grid faces, and what the end of the data takes back.

#include "steps.hh"

#include <array>
#include <cmath>

namespace hsdm::figures {
namespace {

const Style clipped{.stroke = colour::red, .width = 2};
const Style standing{.stroke = colour::white, .width = 1, .fill = colour::blue};
const Style vertex_style{.stroke = colour::black, .width = 1.2, .fill = colour::orange};

void draw_grid(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer) {
    std::vector<std::array<Vec2, 2>> edges;
    for (Index c = 0; c < steps.grid.size(); ++c)
        for (Index axis = 0; axis < 2; ++axis) {
            const Index next = steps.grid.next[c][axis];
            if (layer.has_grid_point(c) && next != no_index)
                edges.push_back({panel(layer.grid_point(c)), panel(layer.grid_point(next))});
        }
    canvas.lines(edges, {.stroke = "#b5b5b5", .width = 1});
}

void draw_normal(Canvas& canvas, const Panel& panel, const Layer& layer, const Crossing& x, double length,
                 const Style& style) {
    const Vec2 at = layer.crossing(x), normal(x.normal[0], x.normal[1]);
    canvas.arrow(panel(at), panel(at + length * normal), style);
}

/// A wedge whose two long sides meet at 60 degrees: each plane runs on beyond the crease.
support::Solid turned_wedge() {
    return support::wedge(0.7, 0.95, 1.3).placed(support::turned(Vec3(0, 0, 1), 2.5));
}

/// Joins across the faces of the lower plane, each drawn once.
void draw_joins(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer) {
    const auto& crossings = steps.crossings.crossings;
    for (Index x = 0; x < crossings.size(); ++x)
        for (const Link& link : steps.links.of_crossing[x]) {
            if (link.open() || link.twin.crossing() < x) continue;
            const Crossing& other = steps.crossings.of(link.twin);
            if (!layer.has_crossing(crossings[x]) || !layer.has_crossing(other)) continue;
            canvas.line(panel(layer.crossing(crossings[x])), panel(layer.crossing(other)),
                        {.stroke = colour::blue, .width = 2});
        }
}

/// The part of each facet that runs through the layer, from vertex to vertex.
void draw_facets(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer) {
    for (Index x = 0; x < steps.crossings.crossings.size(); ++x) {
        if (!layer.has_crossing(steps.crossings.crossings[x])) continue;
        const unsigned axis = steps.crossings.crossings[x].edge % 3;
        for (const FacetSide side : corners_of_facet(x)) {
            if ((side.octant(axis) & 4) == 0 || (side.next().octant(axis) & 4) == 0) continue;
            canvas.line(panel(layer.flat(steps.placed.positions[steps.duals.from(side)])),
                        panel(layer.flat(steps.placed.positions[steps.duals.to(side)])),
                        {.stroke = colour::orange, .width = 3});
        }
    }
}

/// A round patch of a plane, nearly level: open all round.
PointCloud round_patch() {
    PointCloud cloud;
    support::Random random(3);
    const Vec3 normal = Vec3(0.06, 0.04, 1).normalized();
    while (cloud.size() < 2600) {
        const Vec3 p(2 * random.uniform() - 1, 2 * random.uniform() - 1, 0);
        if (p.norm() > 1) continue;
        cloud.positions.push_back({p[0], p[1], 0.11 - 0.06 * p[0] - 0.04 * p[1]});
        cloud.normals.push_back(normal);
    }
    return cloud;
}

bool has_edge(const Crossings& crossings, Index edge) {
    return edge + 1 < crossings.first.size() && !crossings.on_edge(edge).empty();
}

} // namespace

Canvas draw_crossings() {
    const Steps steps(scan(turned_wedge(), 30000), 3);
    const Layer layer(steps, 4);
    auto [canvas, panel, legend] = figure_of({-1.1, -1.1}, {7.1, 6.1}, 66, 245);
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    draw_voxels(canvas, panel, steps, layer);
    draw_grid(canvas, panel, steps, layer);
    draw_section(canvas, panel, layer.section(steps.mesh), {.stroke = colour::orange, .width = 3});
    const auto& all = steps.candidates.crossings.crossings;
    for (std::size_t x = 0; x < all.size(); ++x) {
        if (!layer.has_crossing(all[x])) continue;
        const bool stands = has_edge(steps.labelled, all[x].edge) && steps.candidates.standing[x] != 0;
        if (stands) {
            draw_normal(canvas, panel, layer, all[x], 0.35, {.stroke = colour::blue, .width = 1.6});
            canvas.circle(panel(layer.crossing(all[x])), 5, standing);
        } else {
            draw_normal(canvas, panel, layer, all[x], 0.35, {.stroke = colour::red, .width = 1.6});
            canvas.cross(panel(layer.crossing(all[x])), 5, clipped);
        }
    }
    canvas.end_clip();
    const std::array<Entry, 6> entries{
        Entry{.text = "Crossings of grid edges"},
        {Entry::Mark::dot, standing, "crossing on the solid", 5},
        {Entry::Mark::arrow, {.stroke = colour::blue, .width = 1.6}, "normal of its sheet"},
        {Entry::Mark::cross, clipped, "beyond the crease: dropped", 5},
        {Entry::Mark::line, {.stroke = colour::orange, .width = 3}, "the mesh in the end"},
        {Entry::Mark::square, {.stroke = "#b5b5b5", .fill = colour::faint}, "voxel that holds points", 7}};
    canvas.legend(legend, entries);
    return canvas;
}

Canvas draw_pairs() {
    const Steps steps(scan(support::cylinder(0.25, 1.07), 30000), 3);
    const Layer layer(steps, 4);
    auto [canvas, panel, legend] = figure_of({-0.1, -0.1}, {4.1, 4.1}, 105, 265);
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    draw_voxels(canvas, panel, steps, layer);
    draw_grid(canvas, panel, steps, layer);
    draw_facets(canvas, panel, steps, layer);
    draw_joins(canvas, panel, steps, layer);
    for (const Crossing& x : steps.crossings.crossings)
        if (layer.has_crossing(x)) canvas.circle(panel(layer.crossing(x)), 5, standing);
    for (Index v = 0; v < steps.duals.size(); ++v)
        if (layer.has_voxel(steps.placed.voxel[v]))
            canvas.square(panel(layer.flat(steps.placed.positions[v])), 5, vertex_style);
    canvas.end_clip();
    const std::array<Entry, 8> entries{
        Entry{.text = "In the lower face of the layer"},
        {Entry::Mark::dot, standing, "crossing: a facet", 5},
        {Entry::Mark::line, {.stroke = colour::blue, .width = 2}, "join of two across a face:"},
        {.text = "a mesh edge through it", .size = 0},
        Entry{.text = "In the voxels of the layer"},
        {Entry::Mark::square, vertex_style, "vertex, one for each chain", 5},
        {Entry::Mark::line, {.stroke = colour::orange, .width = 3}, "side of a facet"},
        {Entry::Mark::square, {.stroke = "#b5b5b5", .fill = colour::faint}, "voxel that holds points", 7}};
    canvas.legend(legend, entries);
    return canvas;
}

Canvas draw_border() {
    const Steps steps(round_patch(), 4);
    auto [canvas, panel, legend] = figure_of({7.7, 7.7}, {16.8, 16.8}, 54, 265);
    const Panel& at = panel; // a binding cannot be captured
    const auto flat = [&](const Vec3& p) { return at(Vec2(p[0], p[1]) / steps.h()); };
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    for (std::size_t f = 0; f < steps.mesh.facet_count(); ++f) {
        std::vector<Vec2> corners;
        for (Index v : steps.mesh.facet(f)) corners.push_back(flat(steps.mesh.positions[v]));
        canvas.polygon(corners, {.stroke = colour::orange, .width = 1.5, .fill = "#fdf1d6"});
    }
    std::vector<std::array<Vec2, 2>> dots;
    for (const Vec3& p : steps.octree.positions)
        if (at.holds(Vec2(p[0], p[1]) / steps.h())) dots.push_back({flat(p), flat(p)});
    canvas.lines(dots, {.stroke = colour::grey, .width = 2.6});
    for (const Crossing& x : steps.labelled.crossings) {
        const Vec2 place = flat(crossing_position(steps.grid, x, steps.h()));
        if (has_edge(steps.crossings, x.edge))
            canvas.circle(place, 4.5, standing);
        else
            canvas.cross(place, 4.5, clipped);
    }
    canvas.end_clip();
    const std::array<Entry, 6> entries{
        Entry{.text = "Seen from above"},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::grey}, "points", 2},
        {Entry::Mark::dot, standing, "crossing that stays", 4.5},
        {Entry::Mark::cross, clipped, "beyond the data: taken back", 4.5},
        {Entry::Mark::square, {.stroke = colour::orange, .width = 1.5, .fill = "#fdf1d6"}, "facet", 7},
        {.text = "Each crossing is a facet.", .size = 0}};
    canvas.legend(legend, entries);
    return canvas;
}

} // namespace hsdm::figures
