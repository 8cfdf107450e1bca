#include "support/sample.hh"

#include "hsdm/errors.hh"

#include <fstream>

namespace hsdm::support {
namespace {

SurfacePoint boundary_point(const Solid& solid, Random& random) {
    SurfacePoint point;
    for (int tries = 0; tries < 100000; ++tries)
        if (solid.sample(random, point)) return point;
    throw std::invalid_argument("the solid is empty or hides nearly all of its primitives");
}

/// Tilts a unit vector by a normal deviate in a random tangent direction.
Vec3 tilted(const Vec3& n, double deviation, Random& random) {
    const Vec3 side = n % random.direction();
    if (side.norm() < 1e-9) return n;
    const double angle = deviation * random.gauss();
    return n * std::cos(angle) + side.normalized() * std::sin(angle);
}

void add_outliers(PointCloud& cloud, const SampleOptions& options, Random& random) {
    const Box box = cloud.bounds();
    const Vec3 margin = box.size() * 0.1;
    const auto count = static_cast<std::size_t>(options.outliers * static_cast<double>(options.points));
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t replaced = random.below(cloud.size());
        for (unsigned k = 0; k < 3; ++k)
            cloud.positions[replaced][k] = random.uniform(box.lo[k] - margin[k], box.hi[k] + margin[k]);
        if (options.normals) cloud.normals[replaced] = random.direction();
    }
}

} // namespace

PointCloud sample(const Solid& solid, const SampleOptions& options) {
    Random random(options.seed);
    PointCloud cloud;
    cloud.positions.reserve(options.points);
    if (options.normals) cloud.normals.reserve(options.points);
    for (std::size_t i = 0; i < options.points; ++i) {
        const SurfacePoint point = boundary_point(solid, random);
        const double offset = options.position_noise > 0 ? options.position_noise * random.gauss() : 0;
        cloud.positions.push_back(point.position + point.normal * offset);
        if (options.normals)
            cloud.normals.push_back(
                options.normal_noise > 0 ? tilted(point.normal, options.normal_noise, random) : point.normal);
    }
    if (options.outliers > 0) add_outliers(cloud, options, random);
    return cloud;
}

void write_ply(const std::string& path, const PointCloud& cloud) {
    std::ofstream file(path, std::ios::binary);
    if (!file) throw Error(path, "cannot be opened for writing; check the folder and its permissions");
    file << "ply\nformat binary_little_endian 1.0\nelement vertex " << cloud.size() << '\n';
    for (const char* name : {"x", "y", "z"}) file << "property double " << name << '\n';
    if (cloud.has_normals())
        for (const char* name : {"nx", "ny", "nz"}) file << "property double " << name << '\n';
    file << "end_header\n";
    const auto put = [&file](const Vec3& v) {
        file.write(reinterpret_cast<const char*>(v.data()), 3 * sizeof(double));
    };
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        put(cloud.positions[i]);
        if (cloud.has_normals()) put(cloud.normals[i]);
    }
    file.flush();
    if (!file) throw Error(path, "could not be written; check that the disk is not full");
}

} // namespace hsdm::support
