#pragma once
// What a reconstruction did and how long it took; the keys are the contract that scripts rely on.

#include "hsdm/types.hh"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hsdm {

struct Report {
    std::map<std::string, std::string> options; ///< as given or chosen, by their command-line names

    struct Input {
        std::string file;
        std::size_t points = 0, dropped_nonfinite = 0, merged_duplicates = 0;
        std::optional<std::size_t> first_nonfinite; ///< index in the cloud of the first point without
        bool has_normals = false;
        Box bbox;
        double spacing = 0; ///< mean distance between neighbouring points
    } input;

    struct Grid {
        std::string kind = "uniform";
        int depth = 0;
        double voxel_size = 0;
        std::size_t voxels = 0;
        std::vector<std::size_t> leaves_per_level; ///< index = level
        std::size_t sets = 0, balance_splits = 0, merged = 0;
        double max_error = 0;          ///< the bound an adaptive grid keeps; 0 for a uniform one
        std::size_t points_beyond = 0; ///< farther than that, from the finest surface already
    } grid;

    struct Mesh {
        std::size_t vertices = 0, edges = 0, faces = 0, triangles = 0, quads = 0, larger = 0;
        std::size_t components = 0, boundary_loops = 0, boundary_edges = 0;
        long euler = 0, genus = 0;
        bool closed = false;
    } mesh;

    struct Features {
        std::size_t sharp_edges = 0, smooth_vertices = 0, edge_vertices = 0, corner_vertices = 0;
    } features;

    struct Error {
        double points_to_mesh_max = 0, points_to_mesh_mean = 0, points_to_mesh_rms = 0;
        double normalised_max = 0; ///< max over the diagonal of the bounding box
        /// Of an adaptive grid: the mesh from the surface on the finest grid; 0 for a uniform one.
        double mesh_to_surface_max = 0, mesh_to_surface_mean = 0;
    } error;

    std::map<std::string, std::size_t> rejected; ///< by stage: what it refused, mended or split

    /// Of the input or the surface: what was there and is not in the mesh, and where the first of it was.
    struct Dropped {
        std::string what; ///< e.g. "points far from all others"
        std::size_t count = 0;
        Vec3 where{0, 0, 0}; ///< in the cloud's coordinates
    };
    std::vector<Dropped> dropped;

    struct Seconds {
        double read = 0, normals = 0, octree = 0, graph = 0, facets = 0, mesh = 0, features = 0, error = 0,
               write = 0, total = 0;
    } seconds;

    std::size_t peak_memory_bytes = 0;
    int threads = 0;
    std::string failure; ///< why there is no mesh (see reconstruct_levels); empty: there is one
};

/// The report as JSON text, keys as in the command's contract; what is not finite is left out.
std::string to_json(const Report& report);

} // namespace hsdm
