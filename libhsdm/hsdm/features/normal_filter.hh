#pragma once
// Anisotropic smoothing of facet normals (section 3.3, Fig. 10), on flat arrays.

#include "hsdm/types.hh"

#include <vector>

namespace hsdm {

/// Facets and their neighbours across edges that are not sharp: those of facet f are neighbour[first[f]] ..
/// neighbour[first[f + 1]]; no_index where the edge is sharp or on the boundary.
struct FacetNeighbours {
    std::vector<Index> first{0};
    std::vector<Index> neighbour;
};

/// One round: every normal becomes the mean of itself and its neighbours', weighted by exp(-d^2 / 2 s^2), d
/// the distance of the unit normals and s = `similarity_angle` in radians, and by area; a larger neighbour
/// counts at most twice the facet itself, or a huge side would bend the narrow facets along its rim. Reads
/// the old normals only (Jacobi), so the order of facets plays no part. A facet without neighbours or area
/// keeps its normal. Returns how many normals turned by more than `settled_angle` radians. O(facets),
/// parallel.
std::size_t filter_normals(const FacetNeighbours& neighbours, const std::vector<double>& area,
                           double similarity_angle, double settled_angle, std::vector<Vec3>& normals);

} // namespace hsdm
