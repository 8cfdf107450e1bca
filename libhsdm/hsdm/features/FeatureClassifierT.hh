#pragma once
// Phase 3, section 3.3: the dihedral test and the classes of vertices (Fig. 11), on any OpenMesh mesh.

#include "hsdm/features/feature_options.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/types.hh"

#include <vector>

namespace hsdm {

/// Finds the sharp edges of a mesh and classifies its vertices. Works on triangle and polygon meshes with any
/// traits; warped facets are judged by their Newell normals.
///
///     hsdm::FeatureClassifierT<Mesh> classifier(mesh);
///     classifier.initialize({.crease_angle = 0.7});
///     hsdm::FeatureCounts found = classifier.classify();
///
/// Results: the status bit `feature` on sharp edges and on edge and corner vertices; the vertex properties
/// `hsdm_vertex_class`, `hsdm_normal_count` and `hsdm_normals`, which stay on the mesh. The classifier holds
/// the mesh's vertex, edge and face status while it lives: request edge and vertex status yourself to keep
/// the bits. Boundary edges have no dihedral angle and are never sharp; nor is an edge at a facet without
/// area. Edges above the crease angle are confirmed on smoothed normals, see FeatureOptions. A locked edge
/// keeps its feature bit and counts as sharp if it is set; a locked vertex keeps its bit.
template <class Mesh>
class FeatureClassifierT {
public:
    /// Keeps a reference: the mesh must outlive it. Requests the attributes it works with.
    explicit FeatureClassifierT(Mesh& mesh);
    ~FeatureClassifierT();
    FeatureClassifierT(const FeatureClassifierT&) = delete;
    FeatureClassifierT& operator=(const FeatureClassifierT&) = delete;

    /// Throws OptionError for an option out of range.
    void initialize(const FeatureOptions& options = {});

    /// Marks and classifies the mesh as it is now. Throws std::logic_error before initialize. O(corners),
    /// parallel; the result does not depend on the number of threads.
    FeatureCounts classify();

private:
    void mark_candidates(const std::vector<Vec3>& facet_normals);
    std::vector<unsigned char> facets_near_candidates() const;
    void confirm(const std::vector<Vec3>& areas, const std::vector<Vec3>& facet_normals);
    std::size_t count_sharp_edges() const;
    void classify_vertices(const std::vector<Vec3>& facet_normals, FeatureCounts& counts);

    Mesh& mesh_;
    FeatureOptions options_;
    bool is_initialized_ = false;
};

} // namespace hsdm

#include "hsdm/features/FeatureClassifierT_impl.hh"
