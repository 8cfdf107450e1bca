#pragma once
// A mesh and how far points are from it, as an element of a page that its viewer reads (docs/page.md).

#include "page.hh"

#include "hsdm/types.hh"

#include <vector>

namespace hsdm::command {

/// How points deviate from a mesh, in their units; positive: on the side that normals point to.
struct DeviationFigures {
    std::size_t points = 0; ///< that are counted here
    std::size_t strays = 0; ///< farther than any point that the mesh was made of: left out of all else
    double mean = 0;        ///< signed
    double spread = 0;      ///< standard deviation
    double rms = 0;         ///< root mean square
    double highest = 0, lowest = 0;      ///< signed; 0 if no point is on that side
    double median = 0, p95 = 0, p99 = 0; ///< of the magnitudes
    std::vector<Vec3> farthest;          ///< a few points far off, far from each other, the farthest first
    std::vector<double> farthest_deviations; ///< of these, signed
};

/// The element, and the figures of what it holds.
struct MeshElement {
    std::string html;
    DeviationFigures figures;
};

/// As mesh_element().
MeshElement describe_mesh(const std::string& id, const PageContent& content);

} // namespace hsdm::command
