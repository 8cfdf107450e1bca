#pragma once
// Phase 3, section 3.3, Fig. 10: smoothing of normals that never averages across a sharp edge.

#include "hsdm/features/feature_options.hh"
#include "hsdm/features/normal_filter.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <vector>

namespace hsdm {

/// Smooths the normals of a mesh, not its points. Sharp edges are those with the status bit `feature`, set by
/// FeatureClassifierT or by you; facet normals are averaged among facets that no sharp edge separates, with
/// weights by area and similarity, then every vertex takes one to three normals from its sectors.
///
///     hsdm::AnisotropicNormalSmootherT<Mesh> smoother(mesh);
///     smoother.initialize();
///     smoother.smooth(3);
///
/// Results: the vertex properties `hsdm_normals` and `hsdm_normal_count`, which stay on the mesh, and the
/// standard vertex normals: a smooth vertex's normal, the mean of theirs on edge and corner vertices. A
/// locked facet keeps its normal and lends it to its neighbours; a locked vertex keeps its standard normal.
/// The smoother holds the mesh's status bits and vertex normals while it lives: request them yourself to keep
/// them.
template <class Mesh>
class AnisotropicNormalSmootherT {
public:
    /// Keeps a reference: the mesh must outlive it. Requests the attributes it works with.
    explicit AnisotropicNormalSmootherT(Mesh& mesh);
    ~AnisotropicNormalSmootherT();
    AnisotropicNormalSmootherT(const AnisotropicNormalSmootherT&) = delete;
    AnisotropicNormalSmootherT& operator=(const AnisotropicNormalSmootherT&) = delete;

    /// Takes the facets' normals from the mesh's points. To be called again after points, facets or feature
    /// bits have changed. Throws OptionError for an option out of range.
    void initialize(const NormalSmoothingOptions& options = {});

    /// Does so many rounds more and writes the vertices' normals; smooth(2) twice is smooth(4). Returns the
    /// number of facets whose normal still turned in the last round (0: settled, or no round asked for).
    /// Throws std::logic_error before initialize, OptionError for a negative number. O(corners) per round,
    /// parallel; the result depends neither on the number of threads nor on the order of facets.
    std::size_t smooth(int rounds);

private:
    void read_facets();

    Mesh& mesh_;
    NormalSmoothingOptions options_;
    bool is_initialized_ = false;
    FacetNeighbours neighbours_;
    std::vector<double> area_;
    std::vector<Vec3> normals_; ///< per facet, as smoothed so far
};

} // namespace hsdm

#include "hsdm/features/AnisotropicNormalSmootherT_impl.hh"
