// Vertices: of thin parts, at creases and corners, and of creases just outside their voxel.

#include "solid_view.hh"
#include "steps.hh"

#include "hsdm/mesh/vertex_class.hh"

#include <array>
#include <cmath>

namespace hsdm::figures {
namespace {

const Vec3 up(0, 0, 1);
const Style section_style{.stroke = colour::orange, .width = 2.5};
const Style before_style{.stroke = colour::red, .width = 1.5, .dash = "6 3"};
const Style voxel_style{.stroke = "#b5b5b5", .fill = colour::faint};

/// Thinner than a voxel, its rim in the panel.
support::Solid thin_plate() {
    return support::box({1, 0.05, 1}).placed(support::turned(up, 0.3));
}

/// By the side that the normal of the vertex's first corner shows.
Style side_style(const Steps& steps, Index v) {
    const Crossing& x = steps.crossings.of(steps.duals.corners_of(v).front());
    return {.stroke = colour::black, .width = 1.2, .fill = x.normal[1] > 0 ? colour::blue : colour::red};
}

void draw_plane(Canvas& canvas, const Panel& panel, const Vec2& at, const Vec2& normal, double reach) {
    const Vec2 along(-normal[1], normal[0]);
    canvas.line(panel(at - reach * along), panel(at + reach * along),
                {.stroke = colour::blue, .width = 1.5, .dash = "5 3"});
}

const std::string& class_colour(VertexClass of) {
    if (of == VertexClass::corner) return colour::red;
    return of == VertexClass::edge ? colour::yellow : colour::blue;
}

Style class_style(VertexClass of) {
    return {.stroke = colour::black, .width = 1.2, .fill = class_colour(of)};
}

/// The mean of a chain's crossings: where a vertex would lie without planes.
Vec3 mean_crossing(const Steps& steps, Index v) {
    Vec3 sum(0, 0, 0);
    const auto corners = steps.duals.corners_of(v);
    for (FacetCorner corner : corners) sum += steps.crossing_position_of(corner);
    return sum / static_cast<double>(corners.size());
}

/// Of a crease's vertices in a layer: the planes of their crossings, and the mean of these.
void draw_crease_vertices(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer) {
    for (Index v = 0; v < steps.duals.size(); ++v) {
        if (!layer.has_voxel(steps.placed.voxel[v])) continue;
        const bool is_edge = steps.placed.classes[v] != VertexClass::smooth;
        for (FacetCorner corner : steps.duals.corners_of(v)) {
            const Crossing& x = steps.crossings.of(corner);
            if (!is_edge || !layer.has_crossing(x)) continue;
            draw_plane(canvas, panel, layer.crossing(x), Vec2(x.normal[0], x.normal[1]).normalized(), 0.75);
        }
    }
    for (Index v = 0; v < steps.duals.size(); ++v) {
        if (!layer.has_voxel(steps.placed.voxel[v])) continue;
        if (steps.placed.classes[v] != VertexClass::smooth)
            canvas.circle(panel(layer.flat(mean_crossing(steps, v))), 4,
                          {.stroke = colour::grey, .width = 1.5, .fill = colour::white});
        canvas.circle(panel(layer.flat(steps.placed.positions[v])), 5, class_style(steps.placed.classes[v]));
    }
    for (const Crossing& x : steps.crossings.crossings)
        if (layer.has_crossing(x))
            canvas.circle(panel(layer.crossing(x)), 3, {.stroke = colour::none, .fill = colour::sky});
}

support::Solid turned_box() {
    return support::box({0.9, 0.8, 1.2}).placed(support::turned(up, 0.22));
}

/// Every vertex that the viewer sees, by its class.
void draw_classes(Canvas& canvas, const SolidView& view, const Steps& steps) {
    for (Index v : view.seen_vertices(steps.mesh)) {
        const VertexClass of = steps.classes[v];
        canvas.circle(view(steps.mesh.positions[v]), of == VertexClass::smooth ? 2.2 : 3.6,
                      {.stroke = colour::black, .width = 0.7, .fill = class_colour(of)});
    }
}

/// A crease vertex that moved out of its voxel: which vertex of the mesh it became.
struct Moved {
    const PlacedVertices::OnCrease* crease;
    Index vertex;
};

std::vector<Moved> moved_vertices(const Steps& steps) {
    std::vector<Moved> found;
    for (const auto& crease : steps.placed.on_creases)
        for (Index v = 0; v < steps.mesh.vertex_count(); ++v)
            if ((steps.mesh.positions[v] - crease.position).norm() < 0.02 * steps.h())
                found.push_back({&crease, v});
    return found;
}

/// Seen along a crease, in voxels: its two sheets are lines.
struct AlongCrease {
    Vec3 x, y, z;

    AlongCrease(const PlacedVertices::OnCrease& crease, double h)
        : z((crease.normals[0] % crease.normals[1]).normalized()) {
        if (z[2] < 0) z = -z;
        x = (Vec3(1, 0, 0) - z * z[0]).normalized();
        y = z % x;
        for (Vec3* axis : {&x, &y, &z}) *axis /= h;
    }
    Vec3 operator()(const Vec3& p) const { return {x | p, y | p, z | p}; }
    PolygonMesh operator()(PolygonMesh mesh) const {
        for (Vec3& p : mesh.positions) p = (*this)(p);
        return mesh;
    }
};

void draw_voxel_along(Canvas& canvas, const Panel& panel, const AlongCrease& view, const Steps& steps,
                      Index voxel) {
    const VoxelCoord c = steps.level.coord(voxel);
    const auto corner = [&](unsigned bits) {
        const Vec3 lower(c[0], c[1], c[2]), step(bits & 1u, bits >> 1 & 1u, bits >> 2);
        const Vec3 p = view((lower + step) * steps.h());
        return panel({p[0], p[1]});
    };
    for (unsigned bits = 0; bits < 8; ++bits)
        for (unsigned axis = 1; axis < 8; axis *= 2)
            if ((bits & axis) == 0)
                canvas.line(corner(bits), corner(bits | axis), {.stroke = colour::grey, .width = 1.2});
}

/// How far a vertex was off its crease.
double offset(const Steps& steps, const Moved& moved) {
    const auto& [one, other] = moved.crease->normals;
    const Vec3 along = (one % other).normalized();
    const Vec3 way = moved.crease->position - steps.placed.positions[moved.crease->dual];
    return (way - along * (way | along)).norm();
}

/// The one that moved farthest to a crease that runs up.
Moved farthest_moved(const Steps& steps, const std::vector<Moved>& moved) {
    return *std::ranges::max_element(moved, {}, [&](const Moved& m) {
        const auto& [one, other] = m.crease->normals;
        return std::abs((one % other).normalized()[2]) > 0.9 ? offset(steps, m) : -1;
    });
}

} // namespace

Canvas draw_thin_part() {
    const Steps steps(scan(thin_plate(), 20000), 3);
    const Layer layer(steps, 4);
    auto [canvas, panel, legend] = figure_of({4.4, 0.9}, {8.1, 3.1}, 130, 245);
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    draw_voxels(canvas, panel, steps, layer);
    draw_section(canvas, panel, layer.section(steps.mesh), section_style);
    for (Index v = 0; v < steps.duals.size(); ++v)
        if (layer.has_voxel(steps.placed.voxel[v]))
            canvas.circle(panel(layer.flat(steps.placed.positions[v])), 6, side_style(steps, v));
    canvas.end_clip();
    const std::array<Entry, 5> entries{
        Entry{.text = "One layer of voxels"},
        {Entry::Mark::dot, {.width = 1.2, .fill = colour::blue}, "vertex of the upper side", 6},
        {Entry::Mark::dot, {.width = 1.2, .fill = colour::red}, "vertex of the lower side", 6},
        {Entry::Mark::line, section_style, "the mesh"},

        {Entry::Mark::square, voxel_style, "voxel that holds points", 7}};
    canvas.legend(legend, entries);
    return canvas;
}

Canvas draw_placing() {
    const Steps steps(scan(turned_box(), 30000), 3);
    const Layer layer(steps, 4);
    auto [canvas, panel, legend] = figure_of({3.9, 3.3}, {7.9, 7.3}, 88, 620);
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    draw_voxels(canvas, panel, steps, layer);
    draw_section(canvas, panel, layer.section(steps.mesh), {.stroke = colour::orange, .width = 6});
    draw_crease_vertices(canvas, panel, steps, layer);
    canvas.end_clip();

    const Steps turned(scan(turned_box().placed(support::turned(Vec3(1, 0.4, 0), 0.4)), 30000), 3);
    const SolidView view(turned.mesh.positions, Vec3(0.8, 0.6, 0.55), legend + Vec2(10, 10), 330);
    view.draw(canvas, turned.mesh, [](std::size_t) { return std::string("#ececec"); },
              {.stroke = colour::grey, .width = 0.7});
    draw_classes(canvas, view, turned);
    const std::array<Entry, 8> entries{
        Entry{.text = "Vertices"},
        {Entry::Mark::dot, class_style(VertexClass::smooth), "smooth: on one sheet", 4.5},
        {Entry::Mark::dot, class_style(VertexClass::edge), "edge: where two meet", 4.5},
        {Entry::Mark::dot, class_style(VertexClass::corner), "corner: where three meet", 4.5},
        {Entry::Mark::dot,
         {.stroke = colour::grey, .width = 1.5, .fill = colour::white},
         "mean of its crossings",
         4},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::sky}, "crossing", 3},
        {Entry::Mark::line, {.stroke = colour::blue, .width = 1.5, .dash = "5 3"}, "its plane"},
        {Entry::Mark::line, {.stroke = colour::orange, .width = 6}, "the mesh"}};
    canvas.legend(legend + Vec2(390, 0), entries);
    return canvas;
}

Canvas draw_creases_outside() {
    const auto upright = support::box({0.9, 0.8, 1.2}).placed(support::turned(up, 0.34));
    const Steps steps(scan(upright.placed(support::turned(Vec3(1, 0.3, 0), 0.15)), 40000), 3);
    const std::vector<Moved> moved = moved_vertices(steps);
    const Moved shown = farthest_moved(steps, moved);
    const AlongCrease view(*shown.crease, steps.h());
    PolygonMesh before = steps.mesh;
    for (const auto& [crease, vertex] : moved)
        before.positions[vertex] = steps.placed.positions[crease->dual];
    const Vec3 from = view(steps.placed.positions[shown.crease->dual]), to = view(shown.crease->position);

    const Vec2 middle(to[0], to[1]), reach(0.36, 0.22);
    auto [canvas, panel, legend] = figure_of(middle - reach, middle + reach, 640, 260);
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    draw_voxel_along(canvas, panel, view, steps, steps.placed.voxel[shown.crease->dual]);
    draw_section(canvas, panel, section(view(steps.mesh), to[2], 1), section_style);
    draw_section(canvas, panel, section(view(before), from[2], 1), before_style);
    canvas.circle(panel({from[0], from[1]}), 5, {.width = 1.2, .fill = colour::red});
    canvas.circle(panel({to[0], to[1]}), 5, {.width = 1.2, .fill = colour::orange});
    canvas.end_clip();
    const Vec2 bar = panel.corner + Vec2(14, panel.size()[1] - 14);
    canvas.line(bar, bar + Vec2(0.1 * panel.scale, 0), {.width = 3});
    canvas.text(bar - Vec2(0, 8), "0.1 voxels");
    const std::array<Entry, 6> entries{
        Entry{.text = "One vertex of a crease"},
        {Entry::Mark::dot, {.width = 1.2, .fill = colour::red}, "kept in its voxel", 5},
        {Entry::Mark::dot, {.width = 1.2, .fill = colour::orange}, "moved to its crease", 5},
        {Entry::Mark::line, before_style, "the mesh before, cut there"},
        {Entry::Mark::line, section_style, "the mesh after, cut there"},
        {Entry::Mark::line, {.stroke = colour::grey, .width = 1.2}, "edge of the voxel"}};
    canvas.legend(legend, entries);
    return canvas;
}

} // namespace hsdm::figures
