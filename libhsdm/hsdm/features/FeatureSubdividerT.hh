#pragma once
// Subdivision with creases on any OpenMesh mesh.

#include "hsdm/features/inherited_values.hh"
#include "hsdm/features/subdivision.hh"

namespace hsdm {

/// Divides every facet of a mesh by Loop's scheme (triangles) or Catmull's and Clark's (polygons), with sharp
/// edges and the boundary as creases:
///
///     hsdm::FeatureSubdividerT<Mesh> subdivider(mesh);
///     subdivider.initialize({.rounds = 2});
///     hsdm::SubdivisionCounts counts = subdivider.divide();
///
/// Sharp edges are those with the status bit `feature`, set by FeatureClassifierT or by you. By the number of
/// them and of boundary edges that meet in a vertex it is smooth (none), a dart (one), on a crease (two) or a
/// corner, which stays: more, a turn by more than `corner_angle`, the class corner (`hsdm_vertex_class`), the
/// status bit `locked`, or `feature` where no such edge leads. Creases and boundaries are curves that depend
/// on themselves alone. Scheme and sources: subdivision.hh.
///
/// Vertices, and one part of each edge and facet, keep their numbers; the other parts inherit all properties.
/// The parts of sharp edges are sharp, their new vertices of the class edge. Other properties of new
/// vertices: InheritedValues. What else the mesh has on edges inside the facets that are divided begins as
/// OpenMesh makes it. Normals that the mesh has are computed again. Deleted elements are removed first, which
/// numbers the others anew. Holds the mesh's status bits while it lives: request them yourself to keep them.
template <class Mesh>
class FeatureSubdividerT {
public:
    /// Keeps a reference: the mesh must outlive it. Requests the attributes it works with.
    explicit FeatureSubdividerT(Mesh& mesh);
    ~FeatureSubdividerT();
    FeatureSubdividerT(const FeatureSubdividerT&) = delete;
    FeatureSubdividerT& operator=(const FeatureSubdividerT&) = delete;

    /// Throws OptionError for an option out of range, and for Catmull's and Clark's scheme on a mesh that can
    /// hold triangles only.
    void initialize(const SubdivisionOptions& options = {});

    /// Does the rounds asked for. Throws std::logic_error before initialize, OptionError for Loop's scheme on
    /// a mesh with other facets than triangles, and for more rounds than OpenMesh has numbers for. O(facets
    /// made); the same bits for any number of threads.
    SubdivisionCounts divide();

private:
    void write(const HalfEdges& before, const Refinement& after);
    void write_links(const HalfEdges& mesh);
    void inherit_vertices(const HalfEdges& before, const HalfEdges& after);
    void inherit_edges(std::size_t edges_before);
    void mark_vertex(std::size_t v, bool on_crease);

    Mesh& mesh_;
    SubdivisionOptions options_;
    bool is_initialized_ = false;
};

} // namespace hsdm

#include "hsdm/features/FeatureSubdividerT_impl.hh"
