#include "hsdm/pipeline/choose_resolution.hh"

#include "hsdm/errors.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/pipeline/constants.hh"
#include "hsdm/pipeline/options.hh"

namespace hsdm {
namespace {

constexpr double widest_voxel =
    1 << 20; // extents of the cloud; all its points share eight voxels long before

int fit_voxels(double voxel_size, const PlacedPoints& points) {
    const VoxelCube cube = cube_of_voxels(voxel_size, points.octree.bounds.extent(), points.frame.unit());
    points.rearrange(cube);
    return cube.depth;
}

int depth_by_spacing(const ReconstructOptions& options, const PlacedPoints& points, Report& report) {
    const double spacing = report.input.spacing, unit = points.frame.unit();
    const auto voxel_of = [&](double spacings) {
        return choose_voxel(points.octree, spacing, points.noise, unit, spacings);
    };
    const VoxelChoice choice = voxel_of(spacings::spacings_per_voxel);
    report.options["resolution"] = choice.reason;
    const int depth = fit_voxels(choice.size, points);
    if (method_for(options) != Method::extended) return depth;
    if (voxel_of(resolution::adaptive_spacings).size >= choice.size) return depth;
    const Detail detail = points.detail(depth);
    if (!detail.cylinders && !detail.bends) return depth;
    const VoxelChoice finer =
        voxel_of(detail.cylinders ? resolution::adaptive_spacings : resolution::bent_spacings);
    const std::string voxel = text_of(choice.size * unit);
    report.options["resolution"] =
        finer.reason
        + (detail.cylinders ? ", as bores or rods are under two voxels of " + voxel + " wide"
                            : ", as the surface bends within voxels of " + voxel);
    return fit_voxels(finer.size, points);
}

} // namespace

VoxelCube cube_of_voxels(double voxel_size, double cloud_extent, double unit) {
    if (voxel_size > widest_voxel * cloud_extent)
        throw OptionError("voxel_size " + text_of(voxel_size * unit) + ": must be at most "
                          + text_of(widest_voxel * cloud_extent * unit)
                          + ", a million times the cloud's extent");
    VoxelCube cube{2 * voxel_size, 1};
    for (; cube.extent < cloud_extent && cube.depth < deepest_level; ++cube.depth) cube.extent *= 2;
    if (cube.extent < cloud_extent)
        throw OptionError("voxel_size " + text_of(voxel_size * unit) + ": must be at least "
                          + text_of(cloud_extent * unit / (1 << deepest_level))
                          + ", the cloud's extent over 2^16");
    return cube;
}

int choose_resolution(const ReconstructOptions& options, const PlacedPoints& points, Report& report) {
    if (options.depth) {
        report.options["depth"] = std::to_string(*options.depth);
        report.options["resolution"] = "as asked by depth";
        return *options.depth;
    }
    if (options.voxel_size) {
        report.options["voxel-size"] = text_of(*options.voxel_size);
        report.options["resolution"] = "as asked by voxel size";
        return fit_voxels(*options.voxel_size / points.frame.unit(), points);
    }
    if (options.max_error) { // as fine as two spacings only where the error needs it
        const DepthChoice choice = choose_depth(points.octree, report.input.spacing,
                                                resolution::adaptive_spacings, points.frame.unit());
        report.options["resolution"] = choice.reason;
        return choice.depth;
    }
    return depth_by_spacing(options, points, report);
}

} // namespace hsdm
