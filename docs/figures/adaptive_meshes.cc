// Vertices that go: collapses by planes and by distance, and facets cut and joined anew.

#include "solid_view.hh"
#include "steps.hh"

#include "hsdm/simplify/collapse_by_distance.hh"
#include "hsdm/simplify/collapse_by_planes.hh"
#include "hsdm/simplify/leaf_doublets.hh"
#include "hsdm/simplify/mesh_checks.hh"
#include "hsdm/simplify/planar_patches.hh"
#include "hsdm/simplify/remesh_by_flips.hh"

#include <array>
#include <map>
#include <utility>

namespace hsdm::figures {
namespace {

constexpr double planes_share = 0.35, patch_share = 0.5, drop_share = 1.75; // as in the library

/// A cube whose corners a sphere cuts off: flat faces, creases that bend, and ground that bends two ways.
support::Solid round_cube() {
    return support::box({1, 1, 1}) & support::sphere(0.62);
}

/// What becomes of the fine mesh, one step after the other. In a run the leaves' mesh stands in its place.
struct Decimation {
    Fine fine;
    PolygonMesh by_planes; ///< triangles
    PolygonMesh remeshed;
    PolygonMesh by_distance;

    explicit Decimation(double share) : fine(round_cube(), 40000, 4) {
        const double error = share * fine.octree.bounds.diagonal(), tolerance = planes_share * error;
        MeshChecks checks(fine.mesh, nullptr, fine.octree.positions, error, 0.5 * fine.h(), tolerance);
        const PlanarPatches patches = find_planar_patches(fine.mesh, patch_share * error);
        std::vector<PlaneCollapse> collapses;
        const std::vector<double> tolerances(fine.mesh.vertex_count(), tolerance);
        by_planes = kept(collapse_by_planes(
            CollapsingMesh(fine.mesh), vertex_planes(fine.mesh, patches, tolerance), tolerances, collapses));
        remeshed = by_planes;
        remesh(remeshed, checks, Diagonals::may_flip);
        const CollapsingMesh undropped(remeshed);
        const auto drops =
            find_distance_collapses(undropped, checks.distances().to_fine(), drop_share * tolerance);
        by_distance = kept(
            collapse_by_distance(undropped, drops, std::vector<std::uint8_t>(remeshed.vertex_count(), 1)));
        remesh(by_distance, checks, Diagonals::stay);
    }

private:
    static PolygonMesh kept(CollapsedMesh collapsed) {
        drop_replaced(collapsed.mesh, collapsed.stands_for);
        return std::move(collapsed.mesh);
    }
    static void remesh(PolygonMesh& mesh, MeshChecks& checks, Diagonals diagonals) {
        const std::vector<std::uint8_t> settled(mesh.vertex_count(), 0);
        remesh_by_flips(mesh, checks.envelope(), settled, diagonals);
    }
};

using Edge = std::pair<Index, Index>;

/// Edges of a mesh, either way round, and the corners that follow them in their facets.
std::map<Edge, std::vector<Index>> edges_of(const PolygonMesh& mesh) {
    std::map<Edge, std::vector<Index>> edges;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            edges[{std::min(a, b), std::max(a, b)}].push_back(ring[(i + 2) % ring.size()]);
        }
    }
    return edges;
}

/// Edges of a convex solid's mesh that face the viewer.
bool is_seen(const SolidView& view, const PolygonMesh& mesh, const Edge& edge, const Vec3& centre) {
    return view.faces(mesh.positions[edge.first] - centre)
           && view.faces(mesh.positions[edge.second] - centre);
}

Edge across(const std::vector<Index>& opposite) {
    return std::minmax(opposite.front(), opposite.back());
}

const std::string ground = "#ececec";
const Style edge_style{.stroke = "#555555", .width = 0.9};
const Style flipped_style{.stroke = colour::red, .width = 2.4};
const Style joined_style{.stroke = colour::blue, .width = 2, .dash = "3 3"};

/// Edges of `before` that `after` has not, and the diagonals laid the other way.
void mark_changes(Canvas& canvas, const SolidView& left, const SolidView& right, const PolygonMesh& before,
                  const PolygonMesh& after, const Vec3& centre) {
    const auto old_edges = edges_of(before), new_edges = edges_of(after);
    for (const auto& [edge, opposite] : old_edges) {
        if (new_edges.contains(edge) || !is_seen(left, before, edge, centre)) continue;
        const bool is_flipped = new_edges.contains(across(opposite));
        canvas.line(left(before.positions[edge.first]), left(before.positions[edge.second]),
                    is_flipped ? flipped_style : joined_style);
    }
    for (const auto& [edge, opposite] : new_edges)
        if (!old_edges.contains(edge) && is_seen(right, after, edge, centre))
            canvas.line(right(after.positions[edge.first]), right(after.positions[edge.second]),
                        flipped_style);
}

void draw_named(Canvas& canvas, const SolidView& view, const PolygonMesh& mesh, const Vec2& at,
                const std::string& name) {
    view.draw(
        canvas, mesh, [](std::size_t) { return ground; }, edge_style);
    canvas.text(at, name + ": " + std::to_string(mesh.facet_count()) + " facets", 13, "middle");
}

const Vec3 towards(0.9, 0.55, 0.65);

} // namespace

Canvas draw_collapses() {
    const Decimation steps(0.006);
    Canvas canvas(930, 340);
    const std::array<std::pair<const PolygonMesh*, std::string>, 3> shown{
        std::pair{&steps.fine.mesh, "the fine mesh"}, std::pair{&steps.remeshed, "collapsed by planes"},
        std::pair{&steps.by_distance, "then by distance"}};
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const double left = 14 + 305.0 * static_cast<double>(i);
        const SolidView view(steps.fine.mesh.positions, towards, {left, 14}, 290);
        draw_named(canvas, view, *shown[i].first, {left + 145, 328}, shown[i].second);
    }
    return canvas;
}

Canvas draw_flips() {
    const Decimation steps(0.006);
    Canvas canvas(965, 400);
    const auto& positions = steps.fine.mesh.positions;
    const SolidView left(positions, towards, {14, 14}, 345), right(positions, towards, {374, 14}, 345);
    draw_named(canvas, left, steps.by_planes, {186, 385}, "before");
    draw_named(canvas, right, steps.remeshed, {546, 385}, "after");
    const Vec3 centre = 0.5 * steps.fine.octree.bounds.size();
    mark_changes(canvas, left, right, steps.by_planes, steps.remeshed, centre);
    const std::array<Entry, 3> entries{Entry{.text = "Diagonals"},
                                       {Entry::Mark::line, flipped_style, "laid the other way"},
                                       {Entry::Mark::line, joined_style, "gone: inside a quad now"}};
    canvas.legend({745, 14}, entries);
    return canvas;
}

} // namespace hsdm::figures
