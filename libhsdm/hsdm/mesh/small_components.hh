#pragma once
// Connected components that are too small to be a part.

#include "hsdm/core/occurrences.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/polygon_mesh.hh"

#include <algorithm>

namespace hsdm {

struct SplinterOptions {
    /// most facets of a splinter: ten quads round two grid points, each cut in two; larger components are a
    /// part
    std::size_t most_facets = splinters::most_facets;
    /// the same for a component with a border; larger ones are a piece of the surface
    std::size_t most_open = splinters::most_open;
    /// the same for a closed component whose mean thickness is less than `flat`, in the mesh's units; larger
    /// ones are a plate
    std::size_t most_flat = splinters::most_flat;
    double flat = 0;
    /// In the mesh's units, where sheets are layers of one surface. What is closed, thinner (twice its volume
    /// over its area) and within the box of the component with the most area, but for that length, is layers
    /// of it, whatever its number of facets: if it faces the other way (no scanner sees into a cavity), or if
    /// its area times `least_ratio` is at most that. 0: nothing is.
    double layers = 0;
    /// In the mesh's units squared: components that would be splinters beside a larger one go beside any if
    /// their area is less, as no points can tell of them. 0: none does.
    double least_area = 0;
    /// least ratio of the facets of the largest component to those of a splinter
    double least_ratio = splinters::least_ratio;
    /// facets of the largest component, where the mesh is part of one that has it; 0: as it is in the mesh
    std::size_t largest = 0;

    /// Beside a component of so many facets all splinters go.
    std::size_t enough() const {
        return static_cast<std::size_t>(least_ratio) * std::max({most_facets, most_open, most_flat});
    }
};

/// Removes the components (facets joined by shared vertices) that are splinters beside the largest one: a few
/// facets on their own beside a surface of many. Vertices stay. Returns the number of facets removed, and
/// where. O(facets), parallel.
Occurrences drop_splinters(PolygonMesh& mesh, const SplinterOptions& options = {});

/// Does a closed component face against the one with the most area, as the wall of a cavity does? O(facets),
/// parallel in parts.
bool has_cavity(const PolygonMesh& mesh);

/// Removes closed cavities of the component with the most area, if it is closed and theirs times
/// splinters::least_ratio is at most its, with the hints of their sides. Vertices stay. Returns the number of
/// facets removed, and where. O(facets * cavities).
Occurrences drop_cavities(PolygonMesh& mesh, FeatureHints& hints);

struct SmallComponentOptions {
    double least_facets = 0; ///< smaller components go
    double least_share = 0;  ///< of the largest component's area, in [0, 1]: 1 keeps that one alone
};

struct SmallComponents {
    std::size_t components = 0; ///< removed
    Occurrences facets;
};

/// Which components are smaller than asked for.
struct SmallComponentFacets {
    std::size_t components = 0;       ///< of these
    std::vector<std::uint8_t> facets; ///< per facet, 1 if it is of one of them, else 0
};

/// Finds the components that are smaller than asked for; never the largest by area. O(facets), parallel in
/// parts.
SmallComponentFacets find_small_components(const PolygonMesh& mesh, const SmallComponentOptions& options);

/// Removes the components that are smaller than asked for, with the hints of their sides. Vertices stay, and
/// so does the largest component by area. O(facets), parallel in parts.
SmallComponents drop_small_components(PolygonMesh& mesh, FeatureHints& hints,
                                      const SmallComponentOptions& options);

} // namespace hsdm
