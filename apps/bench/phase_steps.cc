#include "phase_steps.hh"

#include "benchmarks.hh"

#include "hsdm/contour/bar_lines.hh"
#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/flat_facets.hh"
#include "hsdm/contour/grid_signs.hh"
#include "hsdm/contour/handles.hh"
#include "hsdm/contour/outlier_sets.hh"
#include "hsdm/contour/patches.hh"
#include "hsdm/contour/sheet_features.hh"
#include "hsdm/contour/spikes.hh"
#include "hsdm/contour/trim_crossings.hh"
#include "hsdm/contour/webs.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/features/features.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/mesh/doublets.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/normals/mend_normals.hh"
#include "hsdm/normals/outliers.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/reconstruct.hh"
#include "support/named_solid.hh"
#include "support/sample.hh"

#include <cmath>
#include <filesystem>
#include <numeric>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS_AT(name)
#endif

namespace hsdm::bench {
namespace {

template <class T>
double size_of(const std::vector<T>& values) {
    return static_cast<double>(values.size() * sizeof(T));
}
template <class... Arrays>
double bytes_of(const Arrays&... arrays) {
    return (0.0 + ... + size_of(arrays));
}
double bytes_of(const OctreeLevel& level) {
    return bytes_of(level.codes, level.first_point);
}
double bytes_of(const NormalSets& sets) {
    return bytes_of(sets.sets, sets.first, sets.of_point, sets.apart, sets.first_apart);
}
double bytes_of(const GridPoints& grid) {
    return bytes_of(grid.codes, grid.voxels, grid.next);
}
double bytes_of(const LocalSheets& sheets) {
    return bytes_of(sheets.sheet_of, sheets.sheets, sheets.first_member, sheets.first_sheet);
}
double bytes_of(const Crossings& crossings) {
    return bytes_of(crossings.crossings, crossings.first);
}
double bytes_of(const Links& links) {
    return bytes_of(links.of_crossing, links.crowded);
}
double bytes_of(const DualVertices& duals) {
    return bytes_of(duals.corners, duals.first, duals.of_corner, duals.open);
}
double bytes_of(const PlacedVertices& vertices) {
    return bytes_of(vertices.positions, vertices.classes, vertices.directions, vertices.voxel,
                    vertices.is_clamped);
}
double bytes_of(const PolygonMesh& mesh) {
    return bytes_of(mesh.positions, mesh.normals, mesh.corners, mesh.first);
}
double bytes_of(const FacetLinks& links) {
    return bytes_of(links.accepted, links.facet, links.twin, links.vertex, links.source, links.side_out,
                    links.open_in);
}
/// Points and connectivity; a half-edge is its vertex, face, next and previous one.
double bytes_of(const PolyMesh& mesh) {
    const auto vertex = sizeof(PolyMesh::Point) + sizeof(Index), half_edge = 4 * sizeof(Index);
    return static_cast<double>(mesh.n_vertices() * vertex + mesh.n_halfedges() * half_edge
                               + mesh.n_faces() * sizeof(Index));
}
double size_of_file(const std::string& path) {
    return static_cast<double>(std::filesystem::file_size(path));
}

RelationTest relation_of(const Work& w) {
    return RelationTest({}, w.level.voxel_size, w.sets);
}

// Reading and phase 1

void read(Work& w) {
    w.cloud = read_points(w.points_file).cloud;
}
void make_octree(Work& w) {
    w.octree = build_octree_taking_normals(w.spare, {.cube_extent = w.cube_extent});
}
void check_sides(Work& w) {
    w.checksum += static_cast<double>(check_normals(w.octree).flat);
    w.checksum += static_cast<double>(drop_outliers_by_normals(w.octree).count);
}
double points_and_normals(const Work& w) {
    return bytes_of(w.octree.codes, w.octree.positions, w.octree.normals);
}
void find_spacing(Work& w) {
    w.checksum += estimate_spacing(w.octree);
}
void make_level(Work& w) {
    w.level = extract_level(w.octree, w.depth);
}

// Sets

void make_sets(Work& w) {
    w.raw_sets = build_normal_sets(w.octree, w.level);
}
void part_sets(Work& w) {
    const RelationTest related({}, w.level.voxel_size);
    drop_outlier_sets(w.level, related, w.sets);
    separate_patches(w.octree, w.level, related, w.sets);
}

// Grid points, crossings, signs, links, vertices

void make_grid(Work& w) {
    w.corners = build_grid_points(w.level);
}
void move_points(Work& w) {
    move_to_bar_lines(w.dual.grid, w.sets, relation_of(w), w.level.voxel_size);
}
void make_sheets(Work& w) {
    w.sheets = group_local_sheets(w.dual.grid, w.sets, relation_of(w), w.level.voxel_size);
    extend_grid_points(w.dual.grid, w.sheets, w.level);
}
void make_crossings(Work& w) {
    w.candidates = find_crossings(w.dual.grid, w.sheets, w.sets, relation_of(w), w.level.voxel_size);
    ask_points_at_bars(w.octree, w.level, w.dual.grid, w.candidates);
}
void make_signs(Work& w) {
    const double h = w.level.voxel_size;
    w.signed_crossings = label_grid_signs(w.dual.grid, beliefs_of_sheets(w.sheets, h), w.sets,
                                          std::move(w.spare_candidates), h);
}
void make_links(Work& w) {
    const RelationTest related = relation_of(w);
    const auto pair = [&] { w.dual.links = pair_crossings(w.dual.grid, w.dual.crossings, w.sets, related); };
    pair();
    for (int i = 0; i < enough_rounds && trim_unsupported(w.dual.crossings, w.dual.links) > 0; ++i) pair();
    for (int i = 0; i < enough_rounds && drop_tips(w.sets, related, w.dual.links, w.dual.crossings) > 0; ++i)
        pair();
}
void make_vertices(Work& w) {
    w.dual.duals =
        build_dual_vertices(w.dual.grid, w.dual.crossings, w.sets, w.level.voxel_size, w.dual.links);
    w.checksum += static_cast<double>(open_all_webs(w.sets, w.level.voxel_size, w.dual));
}
void place(Work& w) {
    w.vertices = place_vertices(w.dual, w.sets, relation_of(w));
    extend_borders(w.dual, w.sets, w.vertices);
}
void relax(Work& w) {
    relax_vertices(w.octree, w.level, w.dual, {}, w.vertices);
}
void contour(Work& w) {
    w.contour = dual_contour(w.octree, w.level, w.sets);
}

// What dual_contour does once there are facets, on the mesh that it returns: its last pass over each, which
// finds nothing to mend

void copy_mesh(Work& w) {
    w.mended = w.contour.mesh;
    w.mended.origin.resize(w.mended.vertex_count());
    std::iota(w.mended.origin.begin(), w.mended.origin.end(), Index(0));
}
void find_handles(Work& w) {
    std::optional<FacetLinks> links; // found here, as for what comes after
    w.checksum +=
        static_cast<double>(cut_handles(w.octree, w.level, w.sets, w.contour.voxel, w.mended, links).cut);
}
void find_holes(Work& w) {
    w.checksum += static_cast<double>(fill_holes(w.mended, {.max_edges = holes::most_edges}).closed);
}
void find_doublets(Work& w) {
    const auto is_smooth = [&](Index v) { return w.contour.classes[v] == VertexClass::smooth; };
    w.checksum += static_cast<double>(merge_doublets(w.mended, is_smooth));
}
void find_nonmanifold(Work& w) {
    w.checksum += static_cast<double>(make_manifold(w.mended).degenerate);
}
void find_small(Work& w) {
    w.checksum += static_cast<double>(drop_splinters(w.mended).count);
    w.checksum += static_cast<double>(collapse_flat_facets(w.octree.origin, w.mended));
}
void find_spikes(Work& w) {
    w.checksum += static_cast<double>(draw_in_spikes(w.octree, w.level, w.contour.voxel, w.mended));
}
void make_cells(Work& w) {
    w.cells.emplace(w.mended, w.level.voxel_size);
}
void find_intersections(Work& w) {
    const double h = w.level.voxel_size;
    UntangleOptions options = DualContourOptions{}.untangle;
    options.reach *= h, options.nearby *= h;
    w.checksum += static_cast<double>(untangle(w.mended, options, &*w.cells).before);
}
double mended_mesh(const Work& w) {
    return bytes_of(w.mended);
}
double mended_and_points(const Work& w) {
    return bytes_of(w.mended) + bytes_of(w.octree.positions);
}

// The mesh

void link(Work& w) {
    w.links = link_facets(w.contour.mesh);
}
void hint(Work& w) {
    w.hints = sheet_features(w.octree, w.level, w.sets, w.contour.mesh, w.links, w.contour.voxel,
                             ReconstructOptions().crease_angle)
                  .hints;
}
void measure_error(Work& w) {
    w.checksum += points_to_mesh_by_cells(w.octree.positions, w.contour.mesh, *w.contour.cells).mean;
}
void count(Work& w) {
    w.checksum += static_cast<double>(measure_connectivity(w.contour.mesh, w.links).euler);
}
void make_mesh(Work& w) {
    to_mesh(w.contour.mesh, w.links, *w.mesh);
}
void empty_mesh(Work& w) {
    w.mesh = std::make_unique<PolyMesh>();
}
void classify(Work& w) {
    FeatureOptions options;
    options.write_normals = false; // as reconstruct() does: smooth_normals writes them
    classify_features(*w.mesh, options, w.hints);
    smooth_normals(*w.mesh);
}
void write(Work& w) {
    write_mesh(w.mesh_file, to_polygons(*w.mesh), MeshFormat::ply);
}

double whole_contour(const Work& w) {
    return points_and_normals(w) + bytes_of(w.level) + bytes_of(w.sets) + bytes_of(w.contour.mesh)
           + bytes_of(w.contour.classes, w.contour.voxel);
}

std::vector<Step> steps_before_contour() {
    return {
        {"reading", "read_points", [](Work& w) { w.cloud = {}; }, read,
         [](const Work& w) {
             return size_of_file(w.points_file) + bytes_of(w.cloud.positions, w.cloud.normals);
         }},
        {"octree", "build_octree", [](Work& w) { w.octree = {}, w.spare = w.cloud; }, make_octree,
         [](const Work& w) {
             return bytes_of(w.cloud.positions, w.cloud.normals) + points_and_normals(w)
                    + bytes_of(w.octree.source);
         }},
        {"check of normals", "check_normals, drop_outliers_by_normals", nullptr, check_sides,
         points_and_normals},
        {"spacing", "estimate_spacing", nullptr, find_spacing,
         [](const Work& w) { return bytes_of(w.octree.codes); }},
        {"voxels", "extract_level", [](Work& w) { w.level = {}; }, make_level,
         [](const Work& w) { return bytes_of(w.octree.codes) + bytes_of(w.level); }},
        {"sets", "build_normal_sets", [](Work& w) { w.raw_sets = {}; }, make_sets,
         [](const Work& w) {
             return bytes_of(w.octree.positions, w.octree.normals) + bytes_of(w.level) + bytes_of(w.raw_sets);
         }},
        {"patches", "drop_outlier_sets, separate_patches", [](Work& w) { w.sets = w.raw_sets; }, part_sets,
         [](const Work& w) {
             return bytes_of(w.level) + bytes_of(w.sets.sets, w.sets.first, w.sets.apart, w.sets.first_apart);
         }},
    };
}

std::vector<Step> steps_of_contour() {
    return {
        {"grid points", "build_grid_points", [](Work& w) { w.corners = {}; }, make_grid,
         [](const Work& w) { return bytes_of(w.level.codes) + bytes_of(w.corners); }},
        {"bars", "move_to_bar_lines", [](Work& w) { w.dual = {}, w.dual.grid = w.corners; }, move_points,
         [](const Work& w) { return bytes_of(w.dual.grid) + bytes_of(w.sets.sets, w.sets.first); }},
        {"sheets", "group_local_sheets, extend_grid_points",
         [](Work& w) { w.sheets = {}, w.dual.grid = w.corners, move_points(w); }, make_sheets,
         [](const Work& w) {
             return bytes_of(w.dual.grid) + bytes_of(w.sets.sets, w.sets.first) + bytes_of(w.sheets);
         }},
        {"crossings", "find_crossings, ask_points_at_bars", [](Work& w) { w.candidates = {}; },
         make_crossings,
         [](const Work& w) {
             return bytes_of(w.dual.grid) + bytes_of(w.sheets) + bytes_of(w.sets.sets)
                    + bytes_of(w.candidates);
         }},
        {"signs", "label_grid_signs",
         [](Work& w) { w.signed_crossings = {}, w.spare_candidates = w.candidates; }, make_signs,
         [](const Work& w) {
             return bytes_of(w.dual.grid) + bytes_of(w.sheets) + bytes_of(w.candidates)
                    + bytes_of(w.signed_crossings);
         }},
        {"links", "pair_crossings, trim_unsupported, drop_tips",
         [](Work& w) {
             w.dual.links = {}, w.dual.crossings = w.signed_crossings, w.dual.voxel_size = w.level.voxel_size;
         },
         make_links,
         [](const Work& w) {
             return bytes_of(w.dual.grid) + bytes_of(w.dual.crossings) + bytes_of(w.dual.links);
         }},
        {"vertices", "build_dual_vertices, open_all_webs", [](Work& w) { w.dual.duals = {}; }, make_vertices,
         [](const Work& w) {
             return bytes_of(w.dual.crossings) + bytes_of(w.dual.links) + bytes_of(w.dual.duals);
         }},
        {"placing", "place_vertices, extend_borders", [](Work& w) { w.vertices = {}; }, place,
         [](const Work& w) {
             return bytes_of(w.dual.crossings) + bytes_of(w.dual.duals) + bytes_of(w.sets.sets)
                    + bytes_of(w.vertices);
         }},
        {"relaxing", "relax_vertices", place, relax,
         [](const Work& w) {
             return bytes_of(w.octree.positions) + bytes_of(w.dual.crossings) + bytes_of(w.dual.duals)
                    + bytes_of(w.vertices) + bytes_of(w.vertices.positions);
         }},
    };
}

std::vector<Step> steps_of_mending() {
    return {
        {"handles", "cut_handles", copy_mesh, find_handles,
         [](const Work& w) { return bytes_of(w.mended) + bytes_of(w.sets.sets); }},
        {"holes", "fill_holes", copy_mesh, find_holes, mended_mesh},
        {"doublets", "merge_doublets", copy_mesh, find_doublets, mended_mesh},
        {"2-manifold", "make_manifold", copy_mesh, find_nonmanifold, mended_mesh},
        {"splinters", "drop_splinters, collapse_flat_facets", copy_mesh, find_small, mended_mesh},
        {"spikes", "draw_in_spikes", copy_mesh, find_spikes, mended_and_points},
        {"cells", "FacetCells",
         [](Work& w) {
             copy_mesh(w);
             w.cells.reset();
         },
         make_cells, mended_mesh},
        {"intersections", "untangle", nullptr, find_intersections, mended_mesh},
    };
}

std::vector<Step> steps_after_contour() {
    return {
        {"twins of sides", "link_facets", [](Work& w) { w.links = {}; }, link,
         [](const Work& w) { return bytes_of(w.contour.mesh) + bytes_of(w.links); }},
        {"sheet features", "sheet_features", [](Work& w) { w.hints = {}; }, hint,
         [](const Work& w) {
             return bytes_of(w.contour.mesh) + bytes_of(w.links.twin) + bytes_of(w.hints.sides);
         }},
        {"error", "points_to_mesh_by_cells", nullptr, measure_error,
         [](const Work& w) { return bytes_of(w.octree.positions) + bytes_of(w.contour.mesh); }},
        {"topology", "measure_connectivity", nullptr, count,
         [](const Work& w) { return bytes_of(w.contour.mesh.first, w.links.twin, w.links.facet); }},
        {"half-edge mesh", "to_mesh", empty_mesh, make_mesh,
         [](const Work& w) { return bytes_of(w.contour.mesh) + bytes_of(w.links) + bytes_of(*w.mesh); }},
        {"features", "classify_features, smooth_normals",
         [](Work& w) {
             empty_mesh(w);
             make_mesh(w);
         },
         classify, [](const Work& w) { return bytes_of(*w.mesh); }},
        {"writing", "write_mesh", nullptr, write,
         [](const Work& w) { return bytes_of(*w.mesh) + size_of_file(w.mesh_file); }},
    };
}

} // namespace

const std::vector<Step>& phase_steps() {
    static const std::vector<Step> steps = [] {
        std::vector<Step> all = steps_before_contour();
        const auto add_parts = [&](std::vector<Step> parts) {
            for (Step& part : parts) part.role = Role::part;
            all.insert(all.end(), parts.begin(), parts.end());
        };
        add_parts(steps_of_contour());
        all.push_back({"facets, whole", "dual_contour", [](Work& w) { w.contour = {}; }, contour,
                       whole_contour, Role::whole});
        add_parts(steps_of_mending());
        const std::vector<Step> after = steps_after_contour();
        all.insert(all.end(), after.begin(), after.end());
        return all;
    }();
    return steps;
}

double voxel_for(double spacing, double points_per_voxel) {
    constexpr double voxels_per_area = 1.5;
    return spacing * std::sqrt(points_per_voxel * voxels_per_area);
}

Work make_work(const std::string& shape, std::size_t points, double points_per_voxel,
               const std::string& folder) {
    const support::Solid solid = support::in_general_pose(support::solid_named(shape));
    Work work{.points_file = folder + "/points.ply", .mesh_file = folder + "/mesh.ply"};
    const PointCloud cloud = support::sample(solid, {.points = points});
    support::write_ply(work.points_file, cloud);
    const Octree octree = build_octree(cloud);
    work.cube_extent = voxel_for(estimate_spacing(octree), points_per_voxel);
    for (; work.cube_extent < octree.extent; ++work.depth) work.cube_extent *= 2;
    return work;
}

double seconds_of(const Step& step, Work& work) {
    if (step.prepare) step.prepare(work);
    CALLGRIND_ZERO_STATS; // these two do nothing where callgrind does not look on
    const double start = now();
    step.run(work);
    const double seconds = now() - start;
    CALLGRIND_DUMP_STATS_AT(step.name);
    return seconds;
}

} // namespace hsdm::bench
