#include "hsdm/stages/feature_stages.hh"

#include "hsdm/features/features.hh"

#include <iomanip>
#include <sstream>

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

std::string smooth_stage(PolyMesh& mesh, const PluginOptions& options) {
    VertexSmoothingOptions smoothing;
    smoothing.rounds = options.count("rounds", smoothing.rounds);
    smoothing.normal_rounds = options.count("normal-rounds", smoothing.normal_rounds);
    smoothing.position_rounds = options.count("position-rounds", smoothing.position_rounds);
    smoothing.similarity_angle = options.angle("similarity-degrees", smoothing.similarity_angle);
    smoothing.corner_angle = options.angle("corner-degrees", smoothing.corner_angle);
    if (options.has("max-drift")) smoothing.max_drift = options.number("max-drift", 0);
    smoothing.max_drift_share = options.number("max-drift-share", smoothing.max_drift_share);
    smoothing.max_volume_change = options.number("max-volume-change", smoothing.max_volume_change);
    const VertexSmoothingResult result = smooth_vertices(mesh, smoothing);
    std::ostringstream line;
    line << std::setprecision(3) << result.moved << " of " << mesh.n_vertices() << " vertices moved, by "
         << result.drift_mean << " on average, at most " << result.drift_max << "; volume "
         << std::setprecision(6) << result.volume_before << " to " << result.volume_after << "; "
         << result.refused << " facets kept from turning over"
         << (result.taken_back > 0
                 ? ", " + std::to_string(result.taken_back) + " vertices back where they were"
                 : "")
         << (result.volume_bound_met ? "; ended at max-volume-change" : "");
    return line.str();
}

std::string subdivide_stage(PolyMesh& mesh, const PluginOptions& options) {
    SubdivisionOptions division;
    const std::string scheme = options.text("scheme", "auto");
    for (const auto one : {SubdivisionScheme::loop, SubdivisionScheme::catmull_clark})
        if (scheme == name_of(one)) division.scheme = one;
    division.rounds = options.count("rounds", division.rounds);
    division.corner_angle = options.angle("corner-degrees", division.corner_angle);
    const SubdivisionCounts counts = subdivide(mesh, division);
    return std::to_string(counts.facets_before) + " facets divided into "
           + std::to_string(counts.facets_after) + " by " + std::string(name_of(counts.scheme)) + "; "
           + std::to_string(counts.sharp_edges) + " sharp edges, " + std::to_string(counts.corners)
           + " corners kept";
}

} // namespace hsdm
