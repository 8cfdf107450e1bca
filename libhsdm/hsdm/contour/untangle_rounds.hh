#pragma once
// Rounds of moving vertices of facets that intersect others.

#include "hsdm/contour/tangled_part.hh"
#include "hsdm/contour/untangle.hh"
#include "hsdm/spatial/self_intersections.hh"

namespace hsdm {

/// Moves vertices of a tangled part, a round at a time.
class UntangleRounds {
public:
    UntangleRounds(TangledPart& around, const UntangleOptions& options)
        : part_(around.part), around_(around), options_(options), start_(part_.positions) {
        find();
    }

    /// What intersects now.
    const SelfIntersections& found() const { return found_; }
    const std::vector<Vec3>& start() const { return start_; }

    /// Moves the vertices of intersecting facets towards the mean of their neighbours.
    void move();

private:
    void find() { found_ = find_self_intersections(part_); }

    PolygonMesh& part_;
    const TangledPart& around_;
    const UntangleOptions& options_;
    const std::vector<Vec3> start_;
    SelfIntersections found_;
};

/// Changes facets of the part where they intersect, as mend_tangles(); `left` is what still does. Returns how
/// many changes were made.
std::size_t mend_part(TangledPart& around, SelfIntersections& left);

} // namespace hsdm
