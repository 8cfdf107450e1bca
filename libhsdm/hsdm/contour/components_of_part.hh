#pragma once
// The components of a whole, of which each part knows its own facets.

#include "hsdm/contour/mesh_of_part.hh"

#include <span>

namespace hsdm {

/// What a part tells of its own facets, joined by shared vertices.
struct PartComponents {
    /// A vertex that facets of other parts have, too: in its voxel so many other vertices come before.
    struct Shared {
        std::uint64_t voxel; ///< its Morton code
        Index rank;
        Index component; ///< in `sizes`
    };
    std::size_t largest = 0;          ///< facets of the largest component, as far as it is the part's own
    std::vector<std::size_t> sizes{}; ///< own facets of each component that other parts may go on with
    std::vector<Shared> shared{};
};

/// `enough`: once a component has so many facets it does not matter how many more, and nothing else is told.
/// `code`: of a voxel. O(facets).
PartComponents components_of_part(const MeshOfPart& of, std::size_t enough,
                                  const std::function<std::uint64_t(Index)>& code);

/// Facets of the largest component of the whole, `enough` at most.
std::size_t largest_component(std::span<const PartComponents> parts, std::size_t enough);

} // namespace hsdm
