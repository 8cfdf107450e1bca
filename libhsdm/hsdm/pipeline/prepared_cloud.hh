#pragma once
// Phase 1 of a reconstruction: a cloud's frame, its octree and what has been found out about it.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/contour/normal_sets.hh"
#include "hsdm/normals/mend_normals.hh"
#include "hsdm/normals/smooth_points.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/pipeline/choose_resolution.hh"
#include "hsdm/pipeline/input_cloud.hh"
#include "hsdm/pipeline/phases.hh"

#include <optional>

namespace hsdm {

/// Phase 1 with its report.
class PreparedCloud {
public:
    PreparedCloud(InputCloud& input, const ReconstructOptions& options, const Phases& phases);

    /// Estimates normals if the method needs them and the cloud has none or they are not wanted.
    void provide_normals(const PointView& cloud, const Phases& phases);

    /// Removes outliers, gives scattered normals the axes of the positions, turns normals to one side if
    /// their signs contradict each other, and measures the noise where there seems to be much.
    void check_given_normals(const PointView& cloud, const Phases& phases);

    /// Chooses the depth that the options ask for or that spacing and noise suggest, with a cube that fits;
    /// enters it in the report.
    int choose_resolution(const ReconstructOptions& options);

    /// Moves the points onto their surface if the noise is not small compared with the voxels of this depth,
    /// where it would decide topology. Less noisy clouds stay as they are, because that keeps creases
    /// crisper. Points already moved for their normals have little noise left.
    void smooth_for_depth(int depth, const Phases& phases);

    /// The voxels of a depth, and their normal sets if choose_resolution() has made these. To be called once.
    OctreeLevel take_level(int depth, std::optional<NormalSets>& sets);

    /// The scanners of the cloud that are sure, relative to the octree's origin.
    Viewpoints viewpoints_of(const PointView& cloud) const;

    /// Have points been moved from their positions in the cloud, or might smooth_for_depth() still move them?
    bool has_moved() const { return moved_; }
    bool may_move() const { return noise_ > 0; }
    /// Did points take the sides of layers of one surface?
    bool has_layers() const { return has_layers_; }

    /// Frees the codes; to be called when the last level is taken.
    void release_codes() { octree.codes = std::vector<MortonCode>(); }
    /// Frees where points stand in the cloud, unless they have moved or scanners, colours or scalars of
    /// theirs are asked for later; to be called when the last level is taken.
    void release_sources(const PointView& cloud);
    /// Frees the normals; to be called when the last facets are made.
    void release_normals() { octree.normals = std::vector<Vec3>(); }

    CloudFrame frame;
    Octree octree;
    Report report; // lengths and box in the octree's units until the end

private:
    /// What asks for finer voxels than those of this depth.
    Detail detail(int depth);

    /// Enters outliers in the report, and measures spacing and size again, because outliers make a cloud look
    /// sparser and larger.
    void note_outliers(const Occurrences& outliers);

    /// Enters what normals contradict each other.
    void warn_of_sides(const NormalConsistency& consistency, bool estimated);

    /// Measures the noise of positions where normals say that there may be much.
    void measure_noise(const NormalConsistency& consistency);

    /// Gives scattered normals other axes, and turns those that contradict each other.
    void correct_normals(bool scattered, const PointView& cloud);

    /// What the cloud knows of its scanners, relative to the octree's origin.
    OrientOptions orientation_of(const PointView& cloud) const;

    void note_smoothing(const SmoothReport& smoothed);

    /// What detail() made, as long as it holds.
    struct Looked {
        OctreeLevel level;
        NormalSets sets;
    };
    std::optional<Looked> looked_;
    std::size_t far_away_ = 0; // points removed first, by drop_far_outliers
    double noise_ = 0;         // standard deviation of the noise, if it is large
    bool moved_ = false;       // have points been moved because of it?
    bool has_layers_ = false;
};

} // namespace hsdm
