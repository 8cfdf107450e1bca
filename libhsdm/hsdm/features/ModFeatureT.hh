#pragma once
// Decimation that keeps creases: a module for OpenMesh's decimaters.

#include "hsdm/features/feature_options.hh"
#include "hsdm/types.hh"

#include <OpenMesh/Core/Utils/Property.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>

#include <cstdint>

namespace hsdm {

/// Refuses the collapses that would harm the sharp edges marked on a mesh, and keeps the marks where edges
/// merge. A constraint (binary module), to be added beside one that has priorities:
///
///     OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
///     OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadrics;
///     hsdm::ModFeatureT<Mesh>::Handle features;
///     decimater.add(quadrics);
///     decimater.add(features);
///     decimater.module(features).set_options({.crease_angle = 0.7});
///     decimater.initialize();
///     decimater.decimate_to_faces(0, 10000);
///     mesh.garbage_collection();
///
/// Sharp edges are those with the status bit `feature`, set by FeatureClassifierT or by you. A vertex at the
/// end of one, where three meet, where two turn by more than `corner_angle`, of the class corner
/// (`hsdm_vertex_class`), or with the bit but on no marked edge stays where it is; other vertices of creases
/// move along their crease, those of the boundary along the boundary. No unmarked edge becomes sharper than
/// `crease_angle`, unless one beside it was before, and no facet loses its area. Of FeatureOptions the two
/// angles count. For meshes of triangles, with status bits of edges and vertices.
template <class MeshT>
class ModFeatureT : public OpenMesh::Decimater::ModBaseT<MeshT> {
public:
    DECIMATING_MODULE(ModFeatureT, MeshT, Feature)

    /// As decimaters call it.
    explicit ModFeatureT(MeshT& mesh) : Base(mesh, true), mesh_(mesh) {}

    /// Throws OptionError for an angle out of range.
    void set_options(const FeatureOptions& options);

    /// Looks the classes of vertices up; the decimater calls it.
    void initialize() override;
    /// LEGAL_COLLAPSE or ILLEGAL_COLLAPSE. O(valence).
    float collapse_priority(const CollapseInfo& collapse) override;
    /// Hands the marks of the edges that vanish to those that they become one with.
    void preprocess_collapse(const CollapseInfo& collapse) override;

private:
    struct Bend;

    bool is_marked(typename MeshT::HalfedgeHandle h) const;
    bool is_corner(typename MeshT::VertexHandle v) const;
    bool keeps_curve(const CollapseInfo& collapse) const;
    bool keeps_curves_apart(const CollapseInfo& collapse) const;
    Vec3 corner_at(typename MeshT::VertexHandle v) const;
    Vec3 normal_of(typename MeshT::FaceHandle f) const;
    Bend bend_before(const CollapseInfo& collapse) const;
    Bend bend_after(const CollapseInfo& collapse) const;

    MeshT& mesh_;
    FeatureOptions options_;
    OpenMesh::VPropHandleT<std::uint8_t> classes_;
    bool has_classes_ = false;
};

} // namespace hsdm

#include "hsdm/features/ModFeatureT_impl.hh"
