#pragma once
// Small pieces of one sheet, within which the relative signs of normals are certain: patches instead of
// points are oriented.

#include "hsdm/normals/agglomerate.hh"
#include "hsdm/normals/estimate_normals.hh"

namespace hsdm {

struct Patches {
    std::vector<Index> of_point;     ///< per point, its patch; no_index for points without a normal
    std::vector<std::int8_t> sign;   ///< per point, +1 or -1: its normal relative to its patch's
    std::vector<Vec3> centroids;     ///< per patch, relative to the octree's origin
    std::vector<Vec3> normals;       ///< per patch, unit, of either sign
    std::vector<Index> counts;       ///< per patch, points
    std::vector<std::int32_t> sides; ///< per patch, of these, those with its sign less the others

    std::size_t size() const { return counts.size(); }
};

/// Joins the points of a leaf that lie flat beside each other to patches. O(n), parallel.
Patches build_patches(const Octree& octree, const Neighbors& neighbors, const EstimatedNormals& estimate);

/// Evidence between patches, from the pairs of neighbouring points: positive where the patches' normals
/// point to the same side of the surface. For a pair with the chord d between them it is
/// n_i . n_j - 2 (n_i . d)(n_j . d) / d^2: one normal against the other's mirror image in the plane halfway.
/// That is right on every circular arc, convex or concave, hence across creases, round rims and between the
/// two sides of a plate or a slit. O(n), parallel.
std::vector<SignedEdge> patch_evidence(const Octree& octree, const Neighbors& neighbors,
                                       const EstimatedNormals& estimate, const Patches& patches);
/// The same by the pairs of which the first point is of the leaves from `begin` to `end`.
std::vector<SignedEdge> patch_evidence(const Octree& octree, const Neighbors& neighbors,
                                       const EstimatedNormals& estimate, const Patches& patches,
                                       std::size_t begin, std::size_t end);

/// Per patch, whether a sheet lies close in front of it, by the evidence of neighbouring points (1), and
/// behind it (2). O(n), parallel.
std::vector<std::uint8_t> sheets_beside(const Octree& octree, const Neighbors& neighbors,
                                        const EstimatedNormals& estimate, const Patches& patches);

/// Evidence as that of patch_evidence, if no sheet had another behind it: as the angle of the chord says
/// however near the points are, and of parallel points none says that they are opposite. Two sheets beside
/// each other are then layers of one surface, as scans that do not register show it. O(n), parallel.
std::vector<SignedEdge> layer_evidence(const Octree& octree, const Neighbors& neighbors,
                                       const EstimatedNormals& estimate, const Patches& patches);
/// The same by the pairs of which the first point is of the leaves from `begin` to `end`.
std::vector<SignedEdge> layer_evidence(const Octree& octree, const Neighbors& neighbors,
                                       const EstimatedNormals& estimate, const Patches& patches,
                                       std::size_t begin, std::size_t end);

} // namespace hsdm
