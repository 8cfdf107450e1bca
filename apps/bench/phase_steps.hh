// The phases of a reconstruction one by one, each a free function of the library: what `hsdm_bench phases`
// and hsdm_microbench time.
#pragma once

#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/dual_mesh.hh"
#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/mesh_types.hh"
#include "hsdm/point_cloud.hh"

#include <memory>
#include <optional>
#include <string>

namespace hsdm::bench {

/// A cloud on its way to a mesh, with normals, on a uniform grid: what every phase reads and makes.
struct Work {
    std::string points_file, mesh_file;
    int depth = 0;          ///< of the voxels
    double cube_extent = 0; ///< so that they are as large as wanted
    PointCloud cloud{};     ///< as read
    PointCloud spare{};     ///< the octree takes its normals
    Octree octree{};
    OctreeLevel level{};
    NormalSets raw_sets{}, sets{}; ///< before and after outliers are dropped and patches separated
    GridPoints corners{};          ///< of occupied voxels; dual.grid has those that sheets need beside them
    LocalSheets sheets{};
    Crossings candidates{}, spare_candidates{};
    Crossings signed_crossings{}; ///< before those beyond the end of the data are dropped
    DualMesh dual{};
    PlacedVertices vertices{};
    DualContour contour{};
    PolygonMesh mended{};              ///< its mesh, mended once more
    std::optional<FacetCells> cells{}; ///< of that
    FacetLinks links{};
    FeatureHints hints{};
    std::unique_ptr<PolyMesh> mesh{}; ///< OpenMesh's own cannot be moved
    double checksum = 0;              ///< of results that nobody else reads
};

/// A whole is made of its parts, and of what is left when these are taken off.
enum class Role { phase, part, whole };

/// One phase. Run in the order of phase_steps(), each has what it needs; after that any can be repeated.
struct Step {
    const char* name;             ///< as docs/performance.md calls it
    const char* function;         ///< of the library
    void (*prepare)(Work&);       ///< not timed: empties what is made and makes what is consumed; or null
    void (*run)(Work&);           ///< timed
    double (*bytes)(const Work&); ///< of the arrays that it reads and of those that it makes, each once
    Role role = Role::phase;
};

/// In the order of a run, from file to file.
const std::vector<Step>& phase_steps();

/// Voxels that hold so many points on average: a surface in general pose crosses 1.5 A / h^2 of them.
double voxel_for(double spacing, double points_per_voxel);

/// Writes a scan of a solid (solid_named), in general pose, to a file in the folder, and chooses the voxels.
Work make_work(const std::string& shape, std::size_t points, double points_per_voxel,
               const std::string& folder);

/// Seconds of one run of a step, prepared before. Callgrind writes what it counted meanwhile, under the
/// step's name.
double seconds_of(const Step& step, Work& work);

} // namespace hsdm::bench
