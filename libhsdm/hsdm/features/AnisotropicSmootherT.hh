#pragma once
// Smoothing of positions that keeps creases, on any OpenMesh mesh.

#include "hsdm/features/vertex_smoothing.hh"

namespace hsdm {

/// Moves the vertices of a noisy mesh so that its facets face along filtered normals, none of which is
/// averaged across a sharp edge:
///
///     hsdm::AnisotropicSmootherT<Mesh> smoother(mesh);
///     smoother.initialize({.max_drift = 0.05});
///     hsdm::VertexSmoothingResult result = smoother.smooth();
///
/// Sharp edges are those with the status bit `feature`, set by FeatureClassifierT or by you; their vertices
/// come to lie on the planes of both sides, so that creases become straight. What stays to the last bit: the
/// boundary, locked vertices, those of the class corner (`hsdm_vertex_class`), where three sharp edges meet
/// or two turn by more than `corner_angle`, and those with the bit `feature` but on no such edge. Links and
/// properties stay; normals that the mesh has are computed again. Method and sources: vertex_smoothing.hh.
/// Holds the mesh's status bits while it lives: request them yourself to keep them.
template <class Mesh>
class AnisotropicSmootherT {
public:
    /// Keeps a reference: the mesh must outlive it. Requests the attributes it works with.
    explicit AnisotropicSmootherT(Mesh& mesh);
    ~AnisotropicSmootherT();
    AnisotropicSmootherT(const AnisotropicSmootherT&) = delete;
    AnisotropicSmootherT& operator=(const AnisotropicSmootherT&) = delete;

    /// Throws OptionError for an option out of range.
    void initialize(const VertexSmoothingOptions& options = {});

    /// Does the rounds asked for; drift counts from where the vertices are when it begins. Throws
    /// std::logic_error before initialize. O(corners) a round, parallel; the same bits for any number of
    /// threads.
    VertexSmoothingResult smooth();

private:
    Mesh& mesh_;
    VertexSmoothingOptions options_;
    bool is_initialized_ = false;
};

} // namespace hsdm

#include "hsdm/features/AnisotropicSmootherT_impl.hh"
