// The balanced octree over a fine mesh, the clusters of its leaves, and the bound that the result keeps.

#include "steps.hh"

#include "hsdm/simplify/clusters.hh"
#include "hsdm/simplify/planar_patches.hh"
#include "hsdm/simplify/simplify.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace hsdm::figures {
namespace {

const Vec3 up(0, 0, 1);
constexpr double planes_share = 0.35, patch_share = 0.5; // as in simplify.cc
const Style fine_style{.stroke = colour::black, .width = 1};

/// A block with a hole through it, extruded along z.
support::Solid drilled_block() {
    const auto hole = support::cylinder(0.2, 2).placed(support::turned(up, 0, Vec3(0.2, 0.02, 0)));
    return (support::box({1, 0.7, 0.5}) - hole).placed(support::turned(up, 0.2));
}

/// A block with a hollow: flat ground beside ground that bends two ways.
support::Solid hollow_block() {
    const auto ball = support::sphere(0.24).placed(support::turned(up, 0, Vec3(0.25, 0.3, 0)));
    return (support::box({1, 0.7, 0.7}) - ball).placed(support::turned(up, 0.2));
}

/// The octree's cells and clusters for an error, before it is balanced.
struct Cells {
    CellTree tree;
    std::vector<ClusterLevel> clusters;

    Cells(const Fine& fine, double max_error)
        : tree(build_cell_tree(fine.mesh.positions, fine.octree.extent, fine.depth)) {
        const PlanarPatches patches = find_planar_patches(fine.mesh, patch_share * max_error);
        const double tolerance = planes_share * max_error;
        clusters = build_clusters(fine.mesh, tree, vertex_planes(fine.mesh, patches, tolerance), tolerance);
    }

    /// The leaf of a fine vertex and the cluster it is in there.
    struct Place {
        std::size_t level;
        Index cell, cluster;
    };
    Place place_of(Index v) const {
        Place place{static_cast<std::size_t>(tree.depth()), tree.of_vertex[v], v};
        while (place.level > 0) {
            const Index parent = tree.levels[place.level].parent[place.cell];
            if (!tree.levels[place.level - 1].whole[parent]) break;
            place.cluster = clusters[place.level].parent[place.cluster];
            place.cell = parent;
            --place.level;
        }
        return place;
    }
    double size(std::size_t level) const { return tree.extent / static_cast<double>(1u << level); }
};

/// Per level, cell and its least corner: leaves that a plane of constant z cuts.
struct CutLeaf {
    std::size_t level;
    Index cell;
    Vec2 corner;
};
std::vector<CutLeaf> leaves_at(const Cells& cells, double z) {
    std::vector<CutLeaf> found;
    for (std::size_t level = 0; level < cells.tree.levels.size(); ++level)
        for (Index c = 0; c < cells.tree.levels[level].codes.size(); ++c) {
            const VoxelCoord at = morton_decode(cells.tree.levels[level].codes[c]);
            const double size = cells.size(level);
            if (!cells.tree.is_leaf(static_cast<int>(level), c)) continue;
            const int moved = 1 << level; // CellTree::code_at moves positions by a whole cube
            if (static_cast<int>(std::floor(z / size)) == at[2] - moved)
                found.push_back({level, c, Vec2((at[0] - moved) * size, (at[1] - moved) * size)});
        }
    return found;
}

const std::string& level_colour(std::size_t level) {
    static const std::array<std::string, 7> colours{colour::white, colour::white, "#e3f1fb", "#b9dcf3",
                                                    "#7fbde6",     "#4a97cc",     "#2a6fa3"};
    return colours[std::min(level, colours.size() - 1)];
}

/// `before`: where it was not subdivided yet.
void draw_leaves_of(Canvas& canvas, const Panel& panel, const Cells& cells, const CellTree& before,
                    double z) {
    std::vector<CutLeaf> made;
    for (const CutLeaf& leaf : leaves_at(cells, z)) {
        const double size = cells.size(leaf.level);
        canvas.rectangle(panel(leaf.corner + Vec2(0, size)), panel(leaf.corner + Vec2(size, 0)),
                         {.stroke = colour::grey, .width = 0.8, .fill = level_colour(leaf.level)});
        if (!before.is_leaf(static_cast<int>(leaf.level), leaf.cell)) made.push_back(leaf);
    }
    for (const CutLeaf& leaf : made) {
        const double size = cells.size(leaf.level);
        const Vec2 inset(1.6, 1.6);
        canvas.rectangle(panel(leaf.corner + Vec2(0, size)) + inset,
                         panel(leaf.corner + Vec2(size, 0)) - inset, {.stroke = colour::red, .width = 2});
    }
}

/// Vertices near the plane: those of leaves, by cluster.
const std::string& cluster_colour(std::size_t i) {
    static const std::array<std::string, 4> colours{colour::blue, colour::red, colour::green, colour::purple};
    return colours[i % colours.size()];
}

void draw_clusters_of(Canvas& canvas, const Panel& panel, const Fine& fine, const Cells& cells, double z) {
    std::map<std::pair<std::size_t, Index>, std::vector<Index>> of_leaf;
    for (Index v = 0; v < fine.mesh.vertex_count(); ++v) {
        const Cells::Place place = cells.place_of(v);
        auto& known = of_leaf[{place.level, place.cell}];
        if (std::ranges::find(known, place.cluster) == known.end()) known.push_back(place.cluster);
    }
    for (auto& [leaf, clusters] : of_leaf) std::ranges::sort(clusters);
    const auto fill = [&](const Cells::Place& place) {
        const auto& known = of_leaf[{place.level, place.cell}];
        const auto found = std::ranges::find(known, place.cluster);
        return cluster_colour(static_cast<std::size_t>(found - known.begin()));
    };
    for (Index v = 0; v < fine.mesh.vertex_count(); ++v) {
        const Vec3& p = fine.mesh.positions[v];
        if (std::abs(p[2] - z) > 0.5 * fine.h() || !panel.holds({p[0], p[1]}, 0.01)) continue;
        const Cells::Place place = cells.place_of(v);
        const Vec3& q = cells.clusters[place.level].positions[place.cluster];
        const Vec2 from = panel({p[0], p[1]}), to = panel({q[0], q[1]});
        canvas.line(from, to, {.stroke = fill(place), .width = 0.8, .opacity = 0.5});
        canvas.circle(from, 3, {.stroke = colour::none, .fill = fill(place)});
        canvas.square(to, 5.5, {.stroke = colour::black, .width = 1.2, .fill = fill(place)});
    }
}

Panel panel_at(const Vec2& corner, const Vec2& lo, const Vec2& hi, double scale) {
    return {corner, lo, hi, scale};
}

void draw_bound_in(Canvas& canvas, const Panel& panel, const Fine& fine, double share,
                   const std::string& name) {
    const double error = share * fine.octree.bounds.diagonal(), z = 0.5 * fine.octree.bounds.size()[2];
    const AdaptiveMesh coarse =
        simplify(fine.mesh, fine.octree.positions, fine.octree.extent, fine.depth, {.max_error = error});
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    const auto surface = section(fine.mesh, z, 1), result = section(coarse.mesh, z, 1);
    draw_section(canvas, panel, surface, {.stroke = "#cfe6f5", .width = 2 * error * panel.scale});
    draw_section(canvas, panel, surface, fine_style);
    draw_section(canvas, panel, result, {.stroke = colour::red, .width = 2.2});
    for (const auto& segment : result)
        for (const Vec2& end : segment)
            canvas.circle(panel(end), 3, {.stroke = colour::none, .fill = colour::red});
    canvas.end_clip();
    const Vec2 below(0.5 * panel.size()[0], panel.size()[1] + 18);
    canvas.text(panel.corner + below, name + std::to_string(coarse.mesh.facet_count()) + " facets", 13,
                "middle");
}

} // namespace

Canvas draw_leaves() {
    const Fine fine(hollow_block(), 80000, 6);
    Cells cells(fine, 0.0008 * fine.octree.extent);
    const CellTree before = cells.tree;
    balance(cells.tree);
    const double z = 0.5 * fine.octree.bounds.size()[2];
    auto [canvas, panel, legend] = figure_of({-0.01, -0.01}, {1.13, 0.99}, 520, 235);
    draw_leaves_of(canvas, panel, cells, before, z);
    draw_section(canvas, panel, section(fine.mesh, z, 1), {.stroke = colour::black, .width = 1.5});
    std::vector<Entry> entries{{.text = "Leaves that a plane cuts"}};
    for (std::size_t level = 2; level <= 5; ++level)
        entries.push_back({Entry::Mark::square,
                           {.stroke = colour::grey, .width = 0.8, .fill = level_colour(level)},
                           "level " + std::to_string(level),
                           7});
    entries.push_back({Entry::Mark::square, {.stroke = colour::red, .width = 2}, "made by balancing", 6});
    entries.push_back({Entry::Mark::line, {.stroke = colour::black, .width = 1.5}, "the fine mesh"});
    canvas.legend(legend, entries);
    return canvas;
}

Canvas draw_clusters() {
    const Fine fine(support::box({1, 0.12, 1}).placed(support::turned(up, 0.25)), 60000, 6);
    Cells cells(fine, 0.008 * fine.octree.extent);
    balance(cells.tree);
    const double z = 0.55 * fine.octree.bounds.size()[2];
    auto [canvas, panel, legend] = figure_of({-0.02, -0.02}, {1.02, 0.4}, 640, 260);
    canvas.begin_clip(panel.corner, panel.corner + panel.size());
    for (const CutLeaf& leaf : leaves_at(cells, z)) {
        const double size = cells.size(leaf.level);
        canvas.rectangle(panel(leaf.corner + Vec2(0, size)), panel(leaf.corner + Vec2(size, 0)),
                         {.stroke = colour::grey, .width = 1.2, .fill = colour::faint});
    }
    draw_section(canvas, panel, section(fine.mesh, z, 1), fine_style);
    draw_clusters_of(canvas, panel, fine, cells, z);
    canvas.end_clip();
    const std::array<Entry, 6> entries{
        Entry{.text = "Clusters of a leaf"},
        {Entry::Mark::square, {.stroke = colour::grey, .width = 1.2, .fill = colour::faint}, "leaf", 7},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::blue}, "fine vertices of a cluster", 3},
        {Entry::Mark::dot, {.stroke = colour::none, .fill = colour::red}, "of the next one in this leaf", 3},
        {Entry::Mark::square, {.width = 1.2, .fill = colour::blue}, "where its one vertex lies", 5.5},
        {Entry::Mark::line, fine_style, "the fine mesh"}};
    canvas.legend(legend, entries);
    return canvas;
}

Canvas draw_error_bound() {
    const Fine fine(drilled_block(), 60000, 6);
    Canvas canvas(870, 345);
    const Vec2 lo(0.42, 0.2), hi(1.05, 0.78);
    draw_bound_in(canvas, panel_at({14, 14}, lo, hi, 510), fine, 0.02, "E = 2 % of the diagonal: ");
    draw_bound_in(canvas, panel_at({350, 14}, lo, hi, 510), fine, 0.005, "E = 0.5 %: ");
    const std::array<Entry, 4> entries{
        Entry{.text = "A section"},
        {Entry::Mark::line, fine_style, "the fine mesh"},
        {Entry::Mark::line, {.stroke = "#cfe6f5", .width = 12}, "within E of it"},
        {Entry::Mark::line, {.stroke = colour::red, .width = 2.2}, "the result"}};
    canvas.legend({690, 14}, entries);
    return canvas;
}

} // namespace hsdm::figures
