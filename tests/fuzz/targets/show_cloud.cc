#include "fuzz/targets/show_cloud.hh"

#include <fstream>
#include <iomanip>
#include <numbers>
#include <sstream>

namespace hsdm::fuzz {
namespace {

std::string words_of(const ReconstructOptions& options) {
    std::ostringstream words;
    words << std::setprecision(17);
    if (options.depth) words << " --depth " << *options.depth;
    if (options.voxel_size) words << " --voxel-size " << *options.voxel_size;
    if (options.max_error) {
        const bool share = options.max_error->of_diagonal;
        words << " --max-error " << options.max_error->value * (share ? 100 : 1) << (share ? "%" : "");
    }
    words << " --grid " << std::array{"auto", "uniform", "adaptive"}[static_cast<std::size_t>(options.grid)]
          << " --method " << std::array{"auto", "basic", "extended"}[static_cast<std::size_t>(options.method)]
          << " --normals "
          << std::array{"auto", "given", "estimate"}[static_cast<std::size_t>(options.normals)] << " --holes "
          << std::array{"auto", "keep", "close"}[static_cast<std::size_t>(options.holes)];
    if (options.merge_layers) words << " --merge-layers";
    if (options.min_component) {
        const bool share = options.min_component->of_largest;
        words << " --min-component " << options.min_component->value * (share ? 100 : 1)
              << (share ? "%" : "");
    }
    words << " --crease-degrees " << options.crease_angle * 180 / std::numbers::pi << " --smoothing "
          << options.normal_smoothing;
    if (!options.classify) words << " classify=false";
    if (!options.vertex_normals) words << " vertex_normals=false";
    if (!options.measure) words << " measure=false";
    return words.str();
}

} // namespace

void show_cloud(const std::string& path, const PointCloud& cloud, const ReconstructOptions& options) {
    std::ofstream file(path);
    file << std::setprecision(17) << "ply\nformat ascii 1.0\ncomment" << words_of(options) << '\n';
    if (cloud.sensor)
        file << "element camera 1\nproperty double view_px\nproperty double view_py\nproperty double "
                "view_pz\n";
    file << "element vertex " << cloud.size() << '\n';
    for (const char* name : {"x", "y", "z"}) file << "property double " << name << '\n';
    if (cloud.has_normals())
        for (const char* name : {"nx", "ny", "nz"}) file << "property double " << name << '\n';
    if (!cloud.colors.empty())
        for (const char* name : {"red", "green", "blue", "alpha"}) file << "property uchar " << name << '\n';
    for (const Scalar& scalar : cloud.scalars)
        file << "property double " << (scalar.is_label ? "label" : "scalar") << " was " << scalar.name
             << '\n';
    file << "end_header\n";
    if (cloud.sensor) file << *cloud.sensor << '\n';
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        file << cloud.positions[i];
        if (cloud.has_normals()) file << ' ' << cloud.normals[i];
        if (!cloud.colors.empty())
            for (unsigned channel : cloud.colors[i]) file << ' ' << channel;
        for (const Scalar& scalar : cloud.scalars) file << ' ' << scalar.values[i];
        file << '\n';
    }
}

} // namespace hsdm::fuzz
