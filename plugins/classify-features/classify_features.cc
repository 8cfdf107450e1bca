// Marks the sharp edges of a mesh and classifies its vertices (section 3.3).

#include "hsdm/features/features.hh"
#include "hsdm/plugin.hh"

namespace {

std::string classify_features(hsdm::PolyMesh& mesh, const hsdm::PluginOptions& options) {
    options.allow({"crease-degrees", "corner-degrees", "confirmation-rounds"});
    hsdm::FeatureOptions features;
    features.crease_angle = options.angle("crease-degrees", features.crease_angle);
    features.corner_angle = options.angle("corner-degrees", features.corner_angle);
    features.confirmation_rounds = options.count("confirmation-rounds", features.confirmation_rounds);
    const hsdm::FeatureCounts found = hsdm::classify_features(mesh, features);
    return std::to_string(found.sharp_edges) + " sharp edges; vertices: "
           + std::to_string(found.smooth_vertices) + " smooth, " + std::to_string(found.edge_vertices)
           + " edge, " + std::to_string(found.corner_vertices) + " corner";
}

} // namespace

HSDM_PLUGIN(
    "classify-features", "marks sharp edges and classifies vertices as smooth, edge or corner",
    "crease-degrees (35): dihedral angle above which an edge is sharp; corner-degrees (60): turn of a "
    "crease that makes a corner; confirmation-rounds (3): 0 takes every dihedral angle at its word",
    classify_features)
