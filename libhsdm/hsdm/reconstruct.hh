#pragma once
// The whole method, Figure 1: cloud -> octree -> graph -> facets -> mesh -> features.

#include "hsdm/mesh_types.hh"
#include "hsdm/point_view.hh"
#include "hsdm/report.hh"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hsdm {

struct PointFile;

/// How facets are made of the points of a level.
enum class Method {
    automatic, ///< the better one: extended
    basic,     ///< sections 3.1 to 3.3, positions only
    extended,  ///< section 3.4, with normals, given or estimated
};
/// Where normals of points come from.
enum class NormalSource {
    automatic, ///< the cloud's, if it has some, else estimated
    given,     ///< the cloud's; an error if it has none
    estimate,  ///< from the positions, whether the cloud has some or not
};
/// Which boundary loops are closed. A loop that could be closed only by folding stays open.
enum class Holes {
    automatic, ///< those that are small against the sampling, or slits as narrow as these
    keep,      ///< none
    close,     ///< all, over their own vertices
    complete,  ///< all, by the surface that is missing (extended method; the basic one closes)
};
/// What vertices stand for.
enum class Grid {
    automatic, ///< adaptive with max_error, else uniform
    uniform,   ///< one vertex per voxel and sheet
    adaptive,  ///< leaves of a balanced octree as large as the error allows
};

/// A bound on the distance between surface and points.
struct MaxError {
    double value = 0;         ///< > 0
    bool of_diagonal = false; ///< a share of the bounding box's diagonal, else the cloud's units
};

/// How small a component may be: of fewer facets, or of less than a share of the area of the largest one.
struct MinComponent {
    double value = 0;        ///< facets, >= 0; or a share in [0, 1]: 1 keeps the largest component alone
    bool of_largest = false; ///< a share of the largest component's area, else a number of facets
};

/// What a reconstruction is to do; the defaults suit most scans. Lengths are in the cloud's units.
struct ReconstructOptions {
    /// Resolution: at most one of the three; by default the voxel follows from the points' spacing and
    /// noise (choose_voxel), finer where bores are narrow or the surface bends within it.
    std::optional<int> depth{};         ///< octree depth over the bounding cube, [1, 16]
    std::optional<double> voxel_size{}; ///< edge of a voxel in the cloud's units, > 0: kept exactly, the
                                        ///< bounding cube grows to the next power of two of it
    /// Adaptive: the octree goes as deep as the points' spacing carries and is subdivided only where the
    /// surface would be farther than this from the points. Without it an adaptive grid keeps a tenth of a
    /// voxel.
    std::optional<MaxError> max_error{};
    Grid grid = Grid::automatic;                    ///< uniform or adaptive
    Method method = Method::automatic;              ///< basic or extended
    NormalSource normals = NormalSource::automatic; ///< given or estimated; the basic method uses none
    Holes holes = Holes::automatic;                 ///< which are closed
    /// Sheets less than a voxel apart that face the same way are layers of one surface, as misregistered
    /// scans leave them (extended method; see NormalSetOptions).
    bool merge_layers = false;
    /// Components smaller than this are dropped; by default none is, however small.
    std::optional<MinComponent> min_component{};
    /// Each vertex gets its confidence in [0, 1], `hsdm_confidence`: the share of the surface within a voxel
    /// of it that points show, 0 where it was completed, about a half at a border (extended method).
    bool confidence = false;
    double trim = 0; ///< [0, 1]: facets of less confidence are cut off at the end; 0: none
    double crease_angle =
        0.61;                 ///< radians, (0, pi): dihedral angle above which an edge is sharp (35 degrees)
    int normal_smoothing = 3; ///< rounds of anisotropic normal smoothing, >= 0 (section 3.3)
    int threads = 0; ///< at most this many, and no more than TBB may use: as many as there are cores, or
                     ///< as tbb::global_control says; 0: all of these. The result does not depend on it
    /// Results that are not needed can be left out; together these take a third of the time. The facets are
    /// the same.
    bool classify = true;       ///< phase 3: sharp edges and classes of vertices; else the mesh has none
    bool vertex_normals = true; ///< phase 3, where there are classes: smoothed normals of vertices
    bool measure = true;     ///< the report's error and mesh; else zero, but a bound is checked all the same
    std::string debug_dir{}; ///< if set, the phases of Fig. 3 (voxels, graph, facets) are written to dN in
                             ///< it, N the depth
    /// Called on the thread that called, before each phase and while it runs some twenty times a second;
    /// `done` in [0, 1]. Return false to cancel. Must not reconstruct itself.
    std::function<bool(const char* phase, double done)> progress{};
};

/// A surface and how it came about.
struct Reconstruction {
    PolyMesh mesh; ///< with the `hsdm_...` properties and status bits, in the cloud's coordinates
    Report report; ///< in the cloud's units
};

/// Throws OptionError for options that fit no cloud. What follows here does so too, before any work.
void check_options(const ReconstructOptions& options);
/// The same for reconstruct_levels().
void check_options(const ReconstructOptions& options, int first_depth, int last_depth);

/// Throws OptionError for an option out of range, also of this cloud's (voxel_size), Error for a cloud
/// without a surface in it or whose arrays do not fit together, Cancelled.
Reconstruction reconstruct(const PointCloud& cloud, const ReconstructOptions& options = {});
/// The same of points in the caller's own arrays, which are read where they are, coordinates that are not
/// finite skipped; with the same numbers, the same bits. Throws as check_view() too.
Reconstruction reconstruct(const PointView& cloud, const ReconstructOptions& options = {});
/// The same in less memory, by a third for given normals: each array of a cloud that is moved is freed as
/// soon as nobody asks for it. What is left of the cloud is unspecified, whatever is thrown.
Reconstruction reconstruct(PointCloud&& cloud, const ReconstructOptions& options = {});
/// The same of the cloud of a file; the report tells what reading left out of it, as by note_reading().
Reconstruction reconstruct(PointFile&& file, const ReconstructOptions& options = {});

/// One octree, one mesh per level first_depth .. last_depth (section 3.2.3, Fig. 9). A level that fails,
/// since no facet comes out of it or the memory ends, does not stop the others: its result has an empty mesh
/// and the reason in report.failure. Throws as reconstruct() does; what the last level failed of, if all do.
std::vector<Reconstruction> reconstruct_levels(const PointCloud& cloud, int first_depth, int last_depth,
                                               const ReconstructOptions& options = {});
/// The same of the caller's own arrays.
std::vector<Reconstruction> reconstruct_levels(const PointView& cloud, int first_depth, int last_depth,
                                               const ReconstructOptions& options = {});
/// The same in less memory, as reconstruct() of a cloud that is moved.
std::vector<Reconstruction> reconstruct_levels(PointCloud&& cloud, int first_depth, int last_depth,
                                               const ReconstructOptions& options = {});
/// The same of the cloud of a file, as reconstruct() of one.
std::vector<Reconstruction> reconstruct_levels(PointFile&& file, int first_depth, int last_depth,
                                               const ReconstructOptions& options = {});

/// For who reconstructs from a file's arrays: points that the file marks as withheld go to the front of
/// Report::dropped, those without coordinates into Input::dropped_nonfinite, and what columns were taken for
/// into `options`, as "columns", and what not all of several files have, as "left_out". Once for each report.
void note_reading(const PointFile& file, Report& report);

} // namespace hsdm
