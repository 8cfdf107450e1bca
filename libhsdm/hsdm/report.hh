#pragma once
// What a reconstruction did and how long it took; the keys are the contract that scripts rely on.

#include "hsdm/types.hh"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hsdm {

/// What is measured of a mesh only where it is asked for.
struct MeshDetails {
    std::string digest;             ///< mesh_digest()
    double quad_share = 0,          ///< FacetShape::quad_share
        scaled_jacobian_median = 0, ///< FacetShape::scaled_jacobian_median
        scaled_jacobian_min = 0,    ///< FacetShape::scaled_jacobian_min
        edge_length_mean = 0;       ///< FacetShape::edge_length_mean
};

/// Counts, errors and times of one reconstruction. Lengths are in the cloud's units, times in seconds.
struct Report {
    std::map<std::string, std::string> options; ///< as given or chosen, by their command-line names

    /// The cloud.
    struct Input {
        std::string file;                           ///< set by the command, else empty
        std::vector<std::string> files;             ///< those that were joined, set by the command
        std::size_t points = 0,                     ///< with finite coordinates
            dropped_nonfinite = 0,                  ///< left out, as a coordinate was NaN or Inf
            merged_duplicates = 0;                  ///< equal to another in position and normal, counted once
        std::optional<std::size_t> first_nonfinite; ///< index in the cloud of the first point without
        bool has_normals = false;                   ///< given, whether used or not
        Box bbox;                                   ///< of the points that were not dropped
        double spacing = 0;                         ///< mean distance between neighbouring points
    } input;                                        ///< the cloud that was given

    /// The octree's level that the surface was made on.
    struct Grid {
        std::string kind = "uniform";              ///< or "adaptive"
        int depth = 0;                             ///< of the octree; an adaptive grid's finest level
        double voxel_size = 0;                     ///< edge of a voxel at that depth
        std::size_t voxels = 0;                    ///< that hold a point, at that depth
        std::vector<std::size_t> leaves_per_level; ///< index = level
        std::size_t sets = 0,          ///< normal sets of the extended method; of the basic one the voxels
            balance_splits = 0,        ///< leaves of an adaptive grid subdivided to balance the octree
            merged = 0;                ///< vertices of an adaptive grid's leaves that were merged into others
        double max_error = 0;          ///< the bound an adaptive grid keeps; 0 for a uniform one
        std::size_t points_beyond = 0; ///< farther than that, from the finest surface already
    } grid;                            ///< the level that was used

    /// Topology of the mesh; zero without ReconstructOptions::measure.
    struct Mesh {
        std::size_t vertices = 0,   ///< used by a facet
            edges = 0,              ///< each counted once
            faces = 0,              ///< facets, the sum of the next three
            triangles = 0,          ///< facets of three corners
            quads = 0,              ///< facets of four corners
            larger = 0;             ///< facets of five or more corners
        std::size_t components = 0, ///< connected across edges
            boundary_loops = 0,     ///< closed rows of boundary edges
            boundary_edges = 0;     ///< with one facet
        long euler = 0,             ///< V - E + F
            genus = 0;              ///< as Topology::genus()
        bool closed = false;        ///< no boundary edge
        /// Nothing unless measure_details() was called.
        std::optional<MeshDetails> details;
        /// Pairs of facets that pass through each other; nothing unless count_intersections() was called.
        std::optional<std::size_t> intersections;
    } mesh; ///< the resulting mesh

    /// Phase 3; zero without ReconstructOptions::classify.
    struct Features {
        std::size_t sharp_edges = 0, ///< edges with the status bit `feature`
            smooth_vertices = 0,     ///< vertices on no sharp edge
            edge_vertices = 0,       ///< vertices that a sharp line passes or ends at
            corner_vertices = 0;     ///< vertices where sharp lines meet or turn
    } features;                      ///< sharp edges and classes of vertices

    /// Distances of the points from the mesh, section 4; zero without ReconstructOptions::measure.
    struct Error {
        double points_to_mesh_max = 0, ///< one-sided Hausdorff distance
            points_to_mesh_mean = 0,   ///< mean distance
            points_to_mesh_rms = 0;    ///< root of the mean square
        double normalised_max = 0;     ///< max over the diagonal of the bounding box
        /// For an adaptive grid, distances of the mesh from the surface on the finest grid; 0 for a uniform
        /// grid.
        double mesh_to_surface_max = 0,
               mesh_to_surface_mean = 0; ///< the mean of the same
    } error;                             ///< how far the points are from it

    std::map<std::string, std::size_t> rejected; ///< by stage: what it refused, mended or split

    /// Parts of the input or the surface that are not in the mesh, and where the first of them was.
    struct Dropped {
        std::string what;      ///< e.g. "points far from all others"
        std::size_t count = 0; ///< > 0
        Vec3 where{0, 0, 0};   ///< in the cloud's coordinates
    };
    std::vector<Dropped> dropped; ///< in the order of the stages

    /// What the surface may be wrong for, and where: docs/quality.md#warnings.
    struct Warning {
        std::string what;    ///< of what there are `how_much`, e.g. "pairs of facets that pass ..."
        Vec3 where{0, 0, 0}; ///< the first of them, in the cloud's coordinates
        double how_much = 0; ///< > 0
    };
    std::vector<Warning> warnings; ///< in the order of the stages; empty: nothing is known to be doubtful

    /// A boundary loop that was left when small ones were closed, as far as they were to be; with
    /// Holes::complete all that the surface had before, with automatic those of slits.
    struct Loop {
        Vec3 where{0, 0, 0};    ///< a vertex of it, in the cloud's coordinates
        std::size_t edges = 0;  ///< of the loop
        double length = 0;      ///< of them all
        bool completed = false; ///< of the surface before it was completed; else of the mesh
    };
    /// The completed ones first, then those of the mesh, which are left out without
    /// ReconstructOptions::measure.
    std::vector<Loop> loops;

    /// A stage that the mesh went through afterwards.
    struct Stage {
        std::string call;    ///< as it was asked for, `name:key=value,...`
        std::string summary; ///< one line: what it did
        double seconds = 0;  ///< how long it took
    };
    /// In their order, set by the command; with any, `mesh`, `features` and `error` are of the mesh they
    /// leave.
    std::vector<Stage> stages;

    /// The file that the mesh was written to.
    struct Written {
        std::string format;              ///< "stl"
        std::string units;               ///< "mm", or empty: not given
        bool text_for_precision = false; ///< STL as text, since floats would move vertices too far
        double moved_by_floats = 0;      ///< of STL: how far they would, over the diagonal
        Vec3 shift{0, 0, 0};             ///< what its coordinates are less than the cloud's
        bool by_all_ranks = false;       ///< each of them wrote a part of it
    };
    std::optional<Written> written; ///< set by the command

    /// Wall-clock time.
    struct Seconds {
        double read = 0,  ///< set by the command
            normals = 0,  ///< and noise, outliers, points moved onto their surface
            octree = 0,   ///< phase 1, and its level
            graph = 0,    ///< phase 2a: connectivity graph, or normal sets
            facets = 0,   ///< phase 2b, and an adaptive grid
            mesh = 0,     ///< half-edge mesh
            features = 0, ///< phase 3
            error = 0,    ///< Error and Mesh
            write = 0,    ///< set by the command
            total = 0;    ///< all of it; of reconstruct_levels() by level, phase 1 with the first
    } seconds;            ///< how long it took

    /// One of several processes that made and wrote the mesh together.
    struct Rank {
        std::size_t points = 0,     ///< of the part of space that it worked on
            tiles = 0;              ///< that it made
        double seconds = 0,         ///< of its work
            seconds_waited = 0;     ///< for others and for what they sent, beside these
        std::size_t bytes_sent = 0, ///< to others
            peak_memory_bytes = 0,  ///< of the whole process so far
            scratch_bytes = 0;      ///< the same of what was on disk at once
    };
    std::vector<Rank> ranks; ///< set by hsdm-mpi; by their numbers

    std::size_t peak_memory_bytes = 0; ///< of the whole process so far
    std::size_t scratch_bytes = 0,     ///< in tiles: the same of what was on disk at once
        scratch_bytes_written = 0;     ///< and of all that was written there
    int threads = 0;                   ///< at most so many threads worked
    std::string failure;               ///< why there is no mesh (see reconstruct_levels); empty: there is one
};

/// How uneven the work of ranks is: the most seconds over their mean, from 1 on; 1 if there are none.
double imbalance_of(const std::vector<Report::Rank>& ranks);

/// The report as JSON text, keys as in the command's contract; what is not finite is left out.
std::string to_json(const Report& report);

} // namespace hsdm
