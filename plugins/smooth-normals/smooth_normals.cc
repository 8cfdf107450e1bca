// Smooths the normals of a mesh without averaging across the sharp edges marked on it (section 3.3, Fig. 10).

#include "hsdm/features/features.hh"
#include "hsdm/plugin.hh"

namespace {

std::string smooth_normals(hsdm::PolyMesh& mesh, const hsdm::PluginOptions& options) {
    options.allow({"rounds", "similarity-degrees"});
    hsdm::NormalSmoothingOptions smoothing;
    smoothing.rounds = options.count("rounds", smoothing.rounds);
    smoothing.similarity_angle = options.angle("similarity-degrees", smoothing.similarity_angle);
    const std::size_t turning = hsdm::smooth_normals(mesh, smoothing);
    return std::to_string(smoothing.rounds) + " rounds; normals of " + std::to_string(turning) + " of "
           + std::to_string(mesh.n_faces()) + " facets still turn";
}

} // namespace

HSDM_PLUGIN("smooth-normals", "smooths normals between sharp edges; run classify-features first",
            "rounds (3); similarity-degrees (20): normals that differ by more hardly count", smooth_normals)
