#pragma once
// A part for the figures of docs/features.md, and a mesh seen with its marks.

#include "canvas.hh"
#include "solid_view.hh"

#include "hsdm/mesh_types.hh"

#include <functional>
#include <string>
#include <vector>

namespace hsdm::figures {

/// A slice of a shaft: creases that are straight, and round ones, which meet in eight corners.
PolyMesh slice();
/// The same with noise of a seventh of an edge on all vertices but corners.
PolyMesh noisy_slice();

std::vector<Vec3> places_of(const PolyMesh& mesh);

/// Where a panel `left` pixels from the left shows what fits the frame.
SolidView marked_view(const std::vector<Vec3>& frame, double left);

/// A mesh with its marked edges and a name under it; marks that do not face the viewer are left out. Without
/// `fill` facets are grey.
void draw_marked(Canvas& canvas, const PolyMesh& mesh, const std::vector<Vec3>& frame, double left,
                 const std::string& name, const std::function<std::string(std::size_t)>& fill = {});

} // namespace hsdm::figures
