#pragma once
// Solids whose sharp edges are known, and how many of them a mesh has.

#include "hsdm/mesh_types.hh"
#include "support/segment.hh"
#include "support/solid.hh"

#include <vector>

namespace hsdm::support {

using Lines = std::vector<Segment>;

/// `blunt`: the edges that are asked for; `all`: these and the others.
struct EdgedSolid {
    Solid solid;
    double area;
    Lines blunt, all;
};

/// prism(sides, 1, 1): its edges along z are the blunt ones.
EdgedSolid edged_prism(int sides);

/// A bar of 1 x 1 x 1 whose four edges along x are cut off by faces of a width, which turn from one of the
/// sides beside them by an angle, in radians, and from the other by what is left of a right angle. Blunt are
/// the edges of these faces.
EdgedSolid chamfered_bar(double width, double turn);

/// A bar of 1 x 1 x 1 whose four edges along x are rounded by a radius. Blunt are the lines in the middle of
/// its fillets, which are no edges, without their ends.
EdgedSolid filleted_bar(double radius);

/// The same turned and shifted as a whole.
EdgedSolid placed(const EdgedSolid& one, const Pose& pose);

/// Edges of a mesh that fold it by more than an angle, in radians.
Lines folds(const PolyMesh& mesh, double angle);

/// Edges of a mesh that are marked as sharp.
Lines marked(const PolyMesh& mesh);

/// Share of the length of `these` that is near one of `those`.
double share_near(const Lines& these, const Lines& those, double tolerance);

} // namespace hsdm::support
