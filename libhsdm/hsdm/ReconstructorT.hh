#pragma once
// The reconstruction for OpenMesh users: the vertices of a mesh go in, a surface comes out in the same mesh.

#include "hsdm/reconstruct.hh"

namespace hsdm {

/// Takes the vertices of any OpenMesh mesh as the scanned points and replaces the mesh by the surface
/// reconstructed from them, in the mesh's own traits; a triangle mesh gets its polygons cut.
///
///     hsdm::ReconstructorT<Mesh> reconstructor(mesh);
///     reconstructor.initialize({.depth = 7});
///     hsdm::Report report = reconstructor.reconstruct();
///
/// Points, normals and colours are read where the mesh keeps them; only if it has deleted vertices, or
/// numbers other than float, double and colours in bytes, are they copied first. Faces the mesh had are not
/// looked at. Vertex normals count as the scanner's if the mesh has them and one of them is not zero; vertex
/// colours count as the scanner's if the mesh has them, and come out as means. The mesh's properties stay,
/// with the values that OpenMesh gives new elements; the results'
/// (`hsdm_vertex_class`, `hsdm_normal_count`, `hsdm_normals` ...) are added, and normals, colours and status
/// bits are set where the mesh has these attributes: request them to get them. Other standard attributes that
/// it has are zero. Float traits hold seven digits: shift coordinates far from the origin before.
template <class Mesh>
class ReconstructorT {
public:
    /// Keeps a reference: the mesh must outlive it. Nothing happens to it yet.
    explicit ReconstructorT(Mesh& mesh) : mesh_(mesh) {}
    ReconstructorT(const ReconstructorT&) = delete;
    ReconstructorT& operator=(const ReconstructorT&) = delete;

    /// The options are checked when they are used.
    void initialize(const ReconstructOptions& options = {});

    /// Throws std::logic_error before initialize; OptionError, Error and Cancelled as hsdm::reconstruct does,
    /// then with the mesh as it was.
    Report reconstruct();

private:
    bool has_normals() const;
    bool can_be_viewed() const;
    PointView view() const;
    PointCloud copied() const;

    Mesh& mesh_;
    ReconstructOptions options_;
    bool is_initialized_ = false;
};

/// Replaces the content of `to` by that of `from`, element for element; see ReconstructorT for what of it
/// arrives. `from` has no deleted elements; if `to` is a triangle mesh, triangles only. O(elements).
template <class Mesh>
void copy_mesh(const PolyMesh& from, Mesh& to);

} // namespace hsdm

#include "hsdm/ReconstructorT_impl.hh"
