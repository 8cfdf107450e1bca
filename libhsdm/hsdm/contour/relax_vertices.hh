#pragma once
// Moves vertices along the surface so that facets become more square.

#include "hsdm/contour/place_vertices.hh"
#include "hsdm/core/constants.hh"

namespace hsdm {

struct RelaxOptions {
    /// >= 0: rounds of moves within the sheet
    int rounds = repeats::few;
    /// (0, 1]: share of the way to the mean of the neighbours in a round
    double step = relaxation::step;
    bool fit = true; ///< after that, move the sheet towards the points
    /// Marks the voxels that are added up to judge the fit of a whole of which this is part, or empty: then
    /// it is judged here. Per voxel.
    std::span<const std::uint8_t> part_of_whole{};
    bool go_back = false; ///< of part of a whole: it was judged, and all vertices go back
};

/// Moves smooth vertices within their sheet towards the mean of their neighbours and vertices of a crease
/// along it; none leaves its voxel. Corners, borders and crease vertices beside a clamped vertex stay (beside
/// it the facets between, which are off the surface, would grow). At its new place a smooth vertex gets the
/// mean height of the vertices around as they were placed. Then smooth vertices rise or sink, twice, until
/// the facets, not the vertices alone, lie amid the points (PointFit::rises). Where after the first of the
/// two steps a voxel's points are a tenth farther from the facets than as placed, its vertices go back; all
/// do if the sum over all points grew. Voxels with points that stand out then are left in `vertices`
/// (far). Of a part of a whole they do if go_back says so; the sums of its
/// voxels are left in `vertices` (misfit_placed, misfit_moved). O(rounds * crossings), parallel; the same for
/// any number of threads. Throws OptionError.
void relax_vertices(const Octree& octree, const OctreeLevel& level, const DualMesh& mesh,
                    const RelaxOptions& options, PlacedVertices& vertices);

/// Moves smooth border vertices outwards, within their sheet and voxel, to where the points of the voxel's
/// own set end: evenly spread points reach sqrt(3) standard deviations from their mean. O(dual vertices),
/// parallel.
void extend_borders(const DualMesh& mesh, const NormalSets& sets, PlacedVertices& vertices);

} // namespace hsdm
