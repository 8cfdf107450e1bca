#include "hsdm/normals/normals.hh"

#include <algorithm>

namespace hsdm {

NormalsReport make_normals(Octree& octree, const NormalsOptions& options) {
    const Neighbors neighbors = find_neighbors(octree, options.neighbors);
    EstimatedNormals estimate = estimate_normals(octree, neighbors, options.estimate);
    NormalsReport report;
    report.orientation = orient_normals(octree, neighbors, estimate, options.orient);
    settle_normals(octree, neighbors, estimate);
    report.noise = estimate.noise;
    report.bent = estimate.bent.size();
    report.missing = static_cast<std::size_t>(std::count_if(estimate.normals.begin(), estimate.normals.end(),
                                                            [](const Vec3& n) { return n.sqrnorm() == 0; }));
    octree.normals = std::move(estimate.normals);
    return report;
}

} // namespace hsdm
