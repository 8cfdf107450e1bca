#include "hsdm/contour/dual_contour.hh"

#include "hsdm/contour/bar_lines.hh"
#include "hsdm/contour/bevels.hh"
#include "hsdm/contour/flat_corners.hh"
#include "hsdm/contour/flat_facets.hh"
#include "hsdm/contour/grid_signs.hh"
#include "hsdm/contour/move_to_creases.hh"
#include "hsdm/contour/odd_facets.hh"
#include "hsdm/contour/reach.hh"
#include "hsdm/contour/rims.hh"
#include "hsdm/contour/shared_corners.hh"
#include "hsdm/contour/spikes.hh"
#include "hsdm/contour/trim_crossings.hh"
#include "hsdm/contour/webs.hh"
#include "hsdm/contour/wide_holes.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/doublets.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/mesh/straight_corners.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// Extra vertices in the middle of mesh edges. Two links across one face that connect the same two vertices
/// would make one edge with four facets; a midpoint on all but the first keeps the edges apart.
class Midpoints {
public:
    Midpoints(const DualMesh& dual, const NormalSets& sets, PlacedVertices& vertices)
        : of_side_(dual.crossings.crossings.size() * (dual.links.crowded.empty() ? 0 : 4), no_index),
          count_(0) {
        const auto halve = [&](FacetSide side, const Vec3& middle) {
            of_side_[side.number()] = static_cast<Index>(vertices.positions.size());
            vertices.positions.push_back(middle);
            vertices.classes.push_back(VertexClass::smooth);
            vertices.voxel.push_back(sets.sets[dual.crossings.of(side).set].voxel);
            ++count_;
        };
        std::vector<std::array<Index, 2>> seen;
        // Does an earlier edge join the same two vertices as this side? If not, the side joins the edges
        // seen.
        const auto repeated = [&](FacetSide side) {
            const std::array<Index, 2> ends = dual.duals.ends(side);
            if (std::ranges::find(seen, ends) != seen.end()) return true;
            seen.push_back(ends);
            return false;
        };
        for (FacetSide side : dual.links.crowded) {
            if (side == no_side) {
                seen.clear();
                continue;
            }
            const Link& link = dual.links.of(side);
            const FacetSide twin = link.twin;
            const bool strip = link.strip() && dual.duals.ends(side) != dual.duals.ends(twin);
            const bool halved = repeated(side);
            if (twin == no_side || strip) {
                if (halved) halve(side, dual.crossing_position_of(side));
                if (strip && repeated(twin)) halve(twin, dual.crossing_position_of(twin));
            } else if (halved) {
                halve(side, 0.5 * (dual.crossing_position_of(side) + dual.crossing_position_of(twin)));
                of_side_[twin.number()] = mid(side);
            }
        }
    }

    Index mid(FacetSide side) const { return of_side_.empty() ? no_index : of_side_[side.number()]; }
    std::size_t count() const { return count_; }

private:
    std::vector<Index> of_side_; // or empty
    std::size_t count_;
};

/// Appends facets to a mesh from crossings, links and dual vertices.
class FacetBuilder {
public:
    FacetBuilder(const DualMesh& dual, const Midpoints& midpoints, const PlacedVertices& vertices,
                 PolygonMesh& mesh)
        : dual_(dual), midpoints_(midpoints), vertices_(vertices), mesh_(mesh) {}

    /// The facets round one grid edge: crossings first to end.
    void add_facets(Index first, Index end) {
        round_.clear();
        for (Index x = first; x < end; ++x) {
            gather(x);
            if (polygon_.size() == 4)
                round_.push_back({{polygon_[0], polygon_[1], polygon_[2], polygon_[3]}, 2});
            else
                mesh_.add_facet(polygon_);
        }
        for (Quad& quad : round_) quad.cut = crease_diagonal(quad.corners);
        for (std::size_t i = 0; i < round_.size(); ++i) keep_diagonals_apart(i);
        for (const Quad& quad : round_) add_quad(quad);
    }

    /// The strip of facets along a thin part's rim or over a bevel, between the vertices of its two sides;
    /// once per such link.
    void add_strips(Index x) {
        for (const FacetSide side : corners_of_facet(x)) {
            const Link& link = dual_.links.of(side);
            const FacetSide twin = link.twin;
            if (!link.strip() || side > twin) continue;
            const auto [from, to] = dual_.duals.ends(side);
            const auto [twin_from, twin_to] = dual_.duals.ends(twin);
            if (from == twin_from && to == twin_to) continue; // not cut: an ordinary edge
            polygon_.clear();
            add(from);
            add(midpoints_.mid(side));
            add(to);
            if (twin_to != to) add(twin_to);
            add(midpoints_.mid(twin));
            if (twin_from != from) add(twin_from);
            // The half-edge of x's facet runs along the side if x leaves; the strip runs the other way.
            if (dual_.crossings.crossings[x].leaving == side.ascends()) turn();
            mesh_.add_facet(polygon_);
        }
    }

private:
    void add(Index vertex) {
        if (vertex != no_index) polygon_.push_back(vertex);
    }

    /// The other way round from the same corner: turned normals leave a facet's triangles as they are.
    void turn() { std::reverse(polygon_.begin() + 1, polygon_.end()); }

    Vec3 triangle_normal(Index a, Index b, Index c) const {
        const auto& p = vertices_.positions;
        return (p[b] - p[a]) % (p[c] - p[a]);
    }

    struct Quad {
        std::array<Index, 4> corners;
        std::size_t cut; // along the diagonal from this corner, 0 or 1; 2: not cut
    };

    void gather(Index x) {
        polygon_.clear();
        for (const FacetCorner corner : corners_of_facet(x)) {
            const Index before = dual_.duals.to(corner.previous()), after = dual_.duals.from(corner);
            add(before);
            if (after != before) add(after);
            add(midpoints_.mid(corner));
        }
        if (!dual_.crossings.crossings[x].leaving) turn();
    }

    /// Where a crease runs along a quad's diagonal, the quad is cut there: the paper's refinement triangles.
    /// Returns the diagonal's first corner, 2 for none. Folds of less than 30 degrees are left: round parts a
    /// voxel or two thick have them.
    std::size_t crease_diagonal(const std::array<Index, 4>& q) const {
        for (std::size_t d = 0; d < 2; ++d) {
            const Index a = q[d], b = q[d + 1], c = q[d + 2], e = q[(d + 3) % 4];
            if (vertices_.classes[a] == VertexClass::smooth || vertices_.classes[c] == VertexClass::smooth)
                continue;
            const Vec3 n0 = triangle_normal(a, b, c), n1 = triangle_normal(a, c, e);
            const Vec3 m0 = triangle_normal(b, c, e), m1 = triangle_normal(b, e, a);
            const double fold = (n0 | n1) / std::max(n0.norm() * n1.norm(), 1e-300);
            const double other = (m0 | m1) / std::max(m0.norm() * m1.norm(), 1e-300);
            if (fold <= angles::smooth && other <= angles::smooth) return d;
        }
        return 2;
    }

    static bool has_diagonal(const std::array<Index, 4>& q, std::size_t d, const std::array<Index, 4>& r) {
        const auto is = [&](std::size_t i) {
            return (r[i] == q[d] && r[i + 2] == q[d + 2]) || (r[i] == q[d + 2] && r[i + 2] == q[d]);
        };
        return is(0) || is(1);
    }

    /// Two facets round one grid edge may share two opposite corners; if both had that diagonal, cut or
    /// implied, it would be an edge of four triangles. Then the second facet is cut along its other diagonal;
    /// if only one has a crease there, the one without is.
    void keep_diagonals_apart(std::size_t i) {
        for (std::size_t j = 0; j < round_.size(); ++j)
            for (std::size_t d = 0; d < 2 && j != i; ++d) {
                if (!has_diagonal(round_[i].corners, d, round_[j].corners)) continue;
                const bool mine = round_[i].cut == d, first = i < j;
                const bool theirs =
                    round_[j].cut < 2 && has_diagonal(round_[j].corners, round_[j].cut, round_[i].corners);
                if (mine ? theirs && !first : theirs || !first) round_[i].cut = 1 - d;
            }
    }

    void add_quad(const Quad& quad) {
        const auto& q = quad.corners;
        if (quad.cut == 2) {
            mesh_.add_facet(q);
            return;
        }
        const std::size_t d = quad.cut;
        const std::array<Index, 3> t0{q[d], q[d + 1], q[d + 2]}, t1{q[d], q[d + 2], q[(d + 3) % 4]};
        mesh_.add_facet(t0);
        mesh_.add_facet(t1);
    }

    const DualMesh& dual_;
    const Midpoints& midpoints_;
    const PlacedVertices& vertices_;
    PolygonMesh& mesh_;
    std::vector<Index> polygon_;
    std::vector<Quad> round_;
};

/// The facets round all crossed grid edges, then the strips at rims and the caps of dual vertices.
PolygonMesh facets_of(const DualMesh& dual, const Midpoints& midpoints, const PlacedVertices& vertices) {
    const std::vector<Crossing>& crossings = dual.crossings.crossings;
    const std::size_t chunks = chunk_count(crossings.size(), chunks::usual);
    std::vector<PolygonMesh> parts(2 * chunks); // facets, then strips
    const auto goes_on = [&](std::size_t x) {   // of the edge of the crossing before?
        return x > 0 && x < crossings.size() && crossings[x].edge == crossings[x - 1].edge;
    };
    for_chunks(crossings.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        FacetBuilder builder(dual, midpoints, vertices, parts[chunk]);
        for (std::size_t first = begin, next; first < end; first = next) {
            for (next = first + 1; goes_on(next);) ++next;
            if (!goes_on(first)) builder.add_facets(static_cast<Index>(first), static_cast<Index>(next));
        }
        FacetBuilder strip_builder(dual, midpoints, vertices, parts[chunks + chunk]);
        for (auto x = static_cast<Index>(begin); x < end; ++x) strip_builder.add_strips(x);
    });
    PolygonMesh mesh;
    append_facets(mesh, parts);
    for (const std::vector<Index>& cap : dual.duals.caps) mesh.add_facet(cap);
    return mesh;
}

/// Per vertex, the value of the vertex that it originated from.
template <class T>
std::vector<T> of_origins(const std::vector<T>& values, const std::vector<Index>& origin) {
    std::vector<T> result = unwritten_vector<T>(origin.size());
    for_each_index(result.size(), chunks::light, [&](Index i) { result[i] = values[origin[i]]; });
    return result;
}

/// While vertices are split or dropped, classes and voxels are kept per original vertex; from here on per
/// vertex.
void settle_origins(DualContour& result) {
    result.classes = of_origins(result.classes, result.mesh.origin);
    result.voxel = of_origins(result.voxel, result.mesh.origin);
    result.mesh.origin = std::vector<Index>();
}

/// Collapses the edges; returns how many vertices were merged into another that way.
std::size_t merge_corners(std::span<const EdgeCollapse> edges, PolygonMesh& mesh,
                          std::vector<VertexClass>& classes) {
    const std::vector<std::uint8_t> collapsed = collapse_edges(mesh, edges);
    for (std::size_t i = 0; i < collapsed.size(); ++i)
        if (collapsed[i]) classes[mesh.origin[edges[i].to]] = VertexClass::corner;
    const auto count = static_cast<std::size_t>(std::ranges::count(collapsed, 1));
    if (count > 0) remove_isolated_vertices(mesh);
    return count;
}

MeshOfPart part_of_whole(const DualContourOptions& options, const DualContour& result) {
    return {result.mesh, [&](Index v) { return result.voxel[result.mesh.origin[v]]; }, options.part};
}

/// `stage`: the first time or the second.
Occurrences leave_out_splinters(const OctreeLevel& level, const DualContourOptions& options,
                                std::size_t stage, DualContour& result) {
    SplinterOptions splinters = options.splinters;
    const double h = level.voxel_size;
    splinters.flat *= h, splinters.layers *= h, splinters.least_area *= h * h;
    if (options.part.is_part()) {
        splinters.largest = options.largest[stage];
        result.components[stage] = components_of_part(part_of_whole(options, result), splinters.enough(),
                                                      [&](Index voxel) { return level.codes[voxel]; });
    }
    return drop_splinters(result.mesh, splinters);
}

/// May it be that the whole has no component beside which all splinters go?
bool may_be_small(const DualContourOptions& options, const PartComponents& part) {
    return options.part.is_part() && part.largest < options.splinters.enough();
}

/// Closes holes within the limits that no gap of the sampling leaves open. A loop that goes on beyond what a
/// part knows stays open: what it is made of is told with more around it.
void close_holes(const Octree& octree, const OctreeLevel& level, const DualContourOptions& options,
                 DualContour& result) {
    const double h = level.voxel_size;
    const auto voxel_of = [&](Index v) { return result.voxel[result.mesh.origin[v]]; };
    FillHolesOptions holes = options.holes;
    const bool are_limited = std::isfinite(holes.max_diameter);
    holes.max_diameter *= h;
    holes.stays_open = [&](std::span<const Index> loop) {
        if (options.part.is_part() && !are_limited) {
            const auto near = std::ranges::count_if(loop, options.part.is_near, voxel_of);
            result.looked_far |= near > 0 && near < std::ssize(loop);
            if (near < std::ssize(loop)) return true;
        }
        const HoleMiddle middle = middle_of_hole(octree, level, result.voxel, result.mesh, loop);
        if (!(middle.missing_points > holes::least_missing)) return false;
        if (diameter_of(result.mesh, loop) > options.widest_free * h) return true;
        if (!options.part.is_part()) result.wide_holes.add({1, middle.position});
        return false;
    };
    if (!result.links) result.links = link_facets(result.mesh);
    result.holes = fill_holes(result.mesh, *result.links, holes);
}

/// Anew, after facets have changed.
void count_intersections(DualContour& result) {
    const SelfIntersections found = find_self_intersections(result.mesh);
    result.intersections.after = found.triangle_pairs;
    if (found.triangle_pairs > 0)
        result.intersections.first = result.mesh.positions[result.mesh.facet(found.facet_pairs[0][0])[0]];
}

/// Builds the facets; returns the edges to collapse to corners. Grid points, crossings and dual vertices, the
/// largest part of the memory, are freed at the end.
std::vector<EdgeCollapse> build_facets(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                                       const DualContourOptions& options, std::vector<Index>& far,
                                       DualContour& result) {
    const double h = level.voxel_size;
    const RelationTest related(options.relation, h, sets);
    DualMesh dual;
    dual.voxel_size = h;
    dual.grid = build_grid_points(level);
    result.grid_points_moved = move_to_bar_lines(dual.grid, sets, related, h);
    dual.crossings = [&] {
        LocalSheets local = group_local_sheets(dual.grid, sets, related, h);
        extend_grid_points(dual.grid, local, level);
        Crossings candidates = find_crossings(dual.grid, local, sets, related, h, options.crossing);
        ask_points_at_bars(octree, level, dual.grid, candidates);
        std::vector<double> beliefs = beliefs_of_sheets(local, h);
        local = LocalSheets();
        return label_grid_signs(dual.grid, std::move(beliefs), sets, std::move(candidates), h,
                                options.all_round);
    }();
    const auto pair = [&] { dual.links = pair_crossings(dual.grid, dual.crossings, sets, related); };
    pair();
    for (int round = 0;
         round < enough_rounds && trim_unsupported(dual.crossings, dual.links, options.all_round) > 0;
         ++round)
        pair();
    for (int round = 0; round < enough_rounds && drop_tips(sets, related, dual.links, dual.crossings) > 0;
         ++round)
        pair();
    const auto cut_into_vertices = [&] {
        mark_bevels(dual.grid, dual.crossings, sets, h, dual.links);
        dual.duals = build_dual_vertices(dual.grid, dual.crossings, sets, h, dual.links);
    };
    cut_into_vertices();
    result.webs_opened = open_all_webs(sets, h, dual);
    if (result.webs_opened > 0) cut_into_vertices(); // what partners changed lead over
    release(dual.grid.next);
    PlacedVertices vertices = place_vertices(dual, sets, related);
    dual.grid = GridPoints(); // crossings are found by the voxels of vertices from here on
    release(dual.crossings.first);
    extend_borders(dual, sets, vertices);
    relax_vertices(octree, level, dual, options.relax, vertices);
    draw_in_rims(octree, level, sets, dual, vertices);
    separate_sides(dual, vertices.positions);
    std::vector<EdgeCollapse> to_corners = shared_corners(dual, vertices);

    const Midpoints midpoints(dual, sets, vertices);
    result.mesh = facets_of(dual, midpoints, vertices);
    result.mesh.positions = std::move(vertices.positions);
    if (move_to_creases(result.mesh, h, vertices) > 0) { // quads may fold elsewhere
        vertices.positions = std::move(result.mesh.positions);
        result.mesh = PolygonMesh(); // frees it before the second one is built
        result.mesh = facets_of(dual, midpoints, vertices);
        result.mesh.positions = std::move(vertices.positions);
    }
    result.mesh.origin = indices_below(result.mesh.vertex_count());
    result.classes = std::move(vertices.classes);
    result.voxel = std::move(vertices.voxel);
    result.midpoints = midpoints.count();
    result.beyond_crease = dual.crossings.dropped_beyond_crease;
    result.settled = dual.crossings.settled;
    result.trimmed = dual.crossings.trimmed;
    result.tips = dual.crossings.tips;
    result.clamped = vertices.clamped;
    result.misfit_placed = vertices.misfit_placed;
    result.misfit_moved = vertices.misfit_moved;
    far = std::move(vertices.far);
    return to_corners;
}

UntangleOptions untangle_options(const DualContourOptions& options, double voxel_size) {
    UntangleOptions result = options.untangle;
    result.reach *= voxel_size;
    result.nearby *= voxel_size;
    return result;
}

/// Facets have changed, if any.
bool forget_links(std::size_t count, DualContour& result) {
    if (count > 0) result.links.reset();
    return count > 0;
}

void untangle_whole(const Vec3& origin, double h, const DualContourOptions& options, DualContour& result) {
    const UntangleOptions how = untangle_options(options, h);
    result.cells.emplace(result.mesh, h);
    result.intersections = untangle(result.mesh, how, &*result.cells);
    if (result.intersections.after > 0) {
        // Long facets meet others farther off, too; parts of a whole add up what is near moved ones.
        const bool mends = result.intersections.pairs <= untangling::most_pairs;
        const UntangleCounts merged =
            mend_tangles(result.mesh, how.nearby, mends ? std::numeric_limits<std::size_t>::max() : 0);
        result.intersections.moved += merged.moved;
        result.intersections.after = merged.after;
        result.intersections.first = merged.first;
        if (forget_links(merged.moved, result)) remove_isolated_vertices(result.mesh);
    }
    if (result.intersections.moved > 0) {
        result.cells.reset();
        if (forget_links(collapse_flat_facets(origin, result.mesh), result)) count_intersections(result);
    }
}

/// The same of part of a level.
void untangle_share(const Vec3& origin, double h, const DualContourOptions& options, DualContour& result) {
    const MeshOfPart part = part_of_whole(options, result);
    result.cells.emplace(result.mesh, h);
    bool moved = false;
    result.tangles =
        untangle_part(result.mesh, part, untangle_options(options, h), options.tangles, *result.cells, moved);
    if (!moved) return;
    result.cells.reset();
    result.links.reset();
    remove_isolated_vertices(result.mesh);
    collapse_flat_facets(origin, result.mesh);
    if (options.tangles.weighed && result.tangles.near) result.tangles.left = own_intersections(part);
}

} // namespace

DualContour dual_contour(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                         const DualContourOptions& options) {
    DualContour result;
    const double h = level.voxel_size;
    std::vector<Index> far;
    const std::vector<EdgeCollapse> to_corners = build_facets(octree, level, sets, options, far, result);
    result.corners_merged = merge_corners(to_corners, result.mesh, result.classes);
    result.splinters = leave_out_splinters(level, options, 0, result);
    // Links and splinters are found once, for as long as facets stay as they are.
    bool edited = false;
    const auto changed = [&](std::size_t count) {
        if (count > 0) result.links.reset(), edited = true;
        return count;
    };
    const HandleCounts handles =
        cut_handles(octree, level, sets, result.voxel, result.mesh, result.links, options.part);
    result.handles_cut = handles.cut, result.looked_far = handles.looked_far;
    edited |= result.handles_cut > 0;
    if (options.fill) {
        close_holes(octree, level, options, result);
        changed(result.holes.closed);
    }
    result.doublets = changed(merge_doublets(
        result.mesh, [&](Index v) { return result.classes[result.mesh.origin[v]] == VertexClass::smooth; }));
    if (!result.links || !is_manifold(result.mesh, *result.links)) {
        result.manifold = make_manifold(result.mesh);
        changed(1);
    }
    if (edited || may_be_small(options, result.components[0])) {
        const Occurrences more = leave_out_splinters(level, options, 1, result);
        changed(more.count);
        result.splinters.add(more);
    } else {
        result.components[1] = result.components[0];
    }
    if (result.splinters.count > 0) remove_isolated_vertices(result.mesh);
    result.drawn_in = draw_in_spikes(octree, level, result.voxel, result.mesh);
    result.reached = reach_points(octree, level, result.voxel, far, result.mesh);
    // After all that decides topology by numbers of facets, so that it is the same either way.
    if (options.better_quads)
        result.flat_corners =
            changed(collapse_flat_corners(sheets::plane_error * h, result.classes, result.mesh));
    result.straight = changed(drop_straight_vertices(sheets::plane_error * h, result.mesh));
    if (result.straight > 0) remove_isolated_vertices(result.mesh);
    if (options.better_quads) {
        // first, as their triangles may become quads with others
        result.quads_cut = changed(cut_doubtful_quads(result.mesh));
        result.facets_recut = changed(recut_odd_facets(sheets::plane_error * h, result.classes, result.mesh));
    }
    changed(collapse_flat_facets(octree.origin, result.mesh));
    if (options.part.is_part())
        untangle_share(octree.origin, h, options, result);
    else
        untangle_whole(octree.origin, h, options, result);
    settle_origins(result);
    return result;
}

} // namespace hsdm
