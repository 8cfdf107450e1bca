#include "hsdm/stages/feature_stages.hh"

#include "hsdm/features/features.hh"

namespace hsdm {

std::string classify_stage(PolyMesh& mesh, const PluginOptions& options) {
    FeatureOptions features;
    features.crease_angle = options.angle("crease-degrees", features.crease_angle);
    features.corner_angle = options.angle("corner-degrees", features.corner_angle);
    features.confirmation_rounds = options.count("confirmation-rounds", features.confirmation_rounds);
    const FeatureCounts found = classify_features(mesh, features);
    return std::to_string(found.sharp_edges) + " sharp edges; vertices: "
           + std::to_string(found.smooth_vertices) + " smooth, " + std::to_string(found.edge_vertices)
           + " edge, " + std::to_string(found.corner_vertices) + " corner";
}

std::string smooth_normals_stage(PolyMesh& mesh, const PluginOptions& options) {
    NormalSmoothingOptions smoothing;
    smoothing.rounds = options.count("rounds", smoothing.rounds);
    smoothing.similarity_angle = options.angle("similarity-degrees", smoothing.similarity_angle);
    const std::size_t turning = smooth_normals(mesh, smoothing);
    return std::to_string(smoothing.rounds) + " rounds; normals of " + std::to_string(turning) + " of "
           + std::to_string(mesh.n_faces()) + " facets still turn";
}

} // namespace hsdm
