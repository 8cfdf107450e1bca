#pragma once
// Hole elimination (sections 3.2.2 and 3.4.2) on any OpenMesh mesh.

#include "hsdm/mesh/fill_holes.hh"

namespace hsdm {

/// Closes the boundary loops of a mesh that are within the limits, by facets over their own vertices.
///
///     hsdm::HoleFillerT<Mesh> filler(mesh);
///     filler.initialize({.max_edges = 20});
///     hsdm::FillHolesCounts counts = filler.fill();
///
/// What is there stays as it is, with all its properties; new elements come last. Triangle meshes get
/// triangles, whatever `quads` says. Where the mesh touches itself at a vertex, facets that OpenMesh cannot
/// link are left out and their loop counts as refused.
template <class Mesh>
class HoleFillerT {
public:
    /// Keeps a reference: the mesh must outlive it.
    explicit HoleFillerT(Mesh& mesh) : mesh_(mesh) {}
    HoleFillerT(const HoleFillerT&) = delete;
    HoleFillerT& operator=(const HoleFillerT&) = delete;

    /// Throws OptionError for an option out of range.
    void initialize(const FillHolesOptions& options = {});

    /// Throws std::logic_error before initialize. O(facets), and as fill_holes() for the loops.
    FillHolesCounts fill();

private:
    PolygonMesh polygons() const;

    Mesh& mesh_;
    FillHolesOptions options_;
    bool is_initialized_ = false;
};

} // namespace hsdm

#include "hsdm/features/HoleFillerT_impl.hh"
