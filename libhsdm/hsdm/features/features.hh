#pragma once
// Phase 3 on a reconstruction's mesh (section 3.3). For meshes of your own type: FeatureClassifierT,
// AnisotropicNormalSmootherT, AnisotropicSmootherT, FeatureSubdividerT.

#include "hsdm/features/feature_options.hh"
#include "hsdm/features/subdivision.hh"
#include "hsdm/features/vertex_smoothing.hh"
#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/mesh_types.hh"

#include <string>

namespace hsdm {

/// Marks sharp edges, classifies vertices and gives each its one to three normals: see FeatureClassifierT.
/// Hints overrule the dihedral test where they say something, except at locked edges. Throws OptionError,
/// Error if the hints are not one per side of the mesh's facets.
FeatureCounts classify_features(PolyMesh& mesh, const FeatureOptions& options = {},
                                const FeatureHints& hints = {});

/// Smooths normals within the sharp edges marked, `options.rounds` times, and sets the standard vertex
/// normals: see AnisotropicNormalSmootherT. Returns the number of facets whose normal still turned.
std::size_t smooth_normals(PolyMesh& mesh, const NormalSmoothingOptions& options = {});

/// Moves vertices along filtered normals; sharp edges marked, corners and the boundary are kept: see
/// AnisotropicSmootherT. Throws OptionError.
VertexSmoothingResult smooth_vertices(PolyMesh& mesh, const VertexSmoothingOptions& options = {});

/// Divides facets, with sharp edges marked and the boundary as creases: see FeatureSubdividerT. Throws
/// OptionError.
SubdivisionCounts subdivide(PolyMesh& mesh, const SubdivisionOptions& options = {});

/// Marks the edges that the classes and normals of their vertices tell of, on a mesh where no edge is marked,
/// as of a file that holds `hsdm_vertex_class`, `hsdm_normal_count` and `hsdm_normals` but no status bits:
/// both ends are on a crease, and of the normals at one of them another is nearest to either facet's.
/// O(edges).
void mark_edges_by_normals(PolyMesh& mesh);

/// The features as text: a line `x y z x y z` for each sharp edge, then a line `c x y z` for each corner, in
/// the mesh's order, less `shift`; doubles in the fewest digits that read back to the same bits. Empty before
/// classify_features.
std::string feature_lines(const PolyMesh& mesh, const Vec3& shift = Vec3(0, 0, 0));

} // namespace hsdm
