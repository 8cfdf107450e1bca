#pragma once
// Section 3.3 with the sets of section 3.4: which mesh edges are creases between two sheets and which only
// follow a bend. See docs/features.md.

#include "hsdm/contour/normal_sets.hh"
#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

struct SheetFeatures {
    FeatureHints hints;
    std::size_t sharp = 0;    ///< edges between two sheets that meet at an angle
    std::size_t smooth = 0;   ///< edges that fold the mesh where the surface bends smoothly
    std::size_t doubtful = 0; ///< would be smooth, but the cloud's normals contradict its positions
    /// Points of bends with normals in between, and those of them whose normals contradict positions nearby.
    std::size_t middle = 0, tilted = 0;
};

/// Hints as sheet_features() gives them before judge_normals(). Of part of a mesh, whose counts are added up
/// with others' first: edges count whose first facet is marked in `counted`, or all if that is empty.
SheetFeatures judge_edges(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                          const PolygonMesh& mesh, const FacetLinks& links, std::span<const Index> voxel,
                          double crease_angle, bool turned, std::span<const std::uint8_t> counted = {});

/// Takes smooth hints back where too many normals contradict the positions: smeared or noisy ones may be all
/// that bends.
void judge_normals(SheetFeatures& features);

/// Judges those edges of a 2-manifold that fold it by at least 0.7 of `crease_angle` (radians), by the points
/// around them: at a crease their normals are those of the two sheets, on a bend also directions in between.
/// `links` are the mesh's, `voxel` is the voxel of each vertex; `turned` says that the facets face against
/// the points' normals. Departs from section 3.3, which knows facets only. Boundary edges and edges without
/// points get no hint. O(folded edges), parallel; the result does not depend on the number of threads.
SheetFeatures sheet_features(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                             const PolygonMesh& mesh, const FacetLinks& links, std::span<const Index> voxel,
                             double crease_angle, bool turned = false);

} // namespace hsdm
