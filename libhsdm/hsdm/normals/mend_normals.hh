#pragma once
// Finds given normals whose signs contradict each other, and turns them to one side.

#include "hsdm/core/occurrences.hh"
#include "hsdm/normals/orient_normals.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// Counts of pairs of points next to each other in octree order that say something about signs.
struct NormalConsistency {
    std::size_t flat = 0, flat_opposed = 0; ///< on one plane; of these, with opposite normals
    Index first_opposed = no_index;         ///< a point of the first of the latter
    std::size_t creased = 0,
                creased_opposed = 0; ///< on two planes that meet; of these, out on one and in on the other
    std::size_t steep = 0; ///< whose normals agree while their chord rises clearly out of both planes

    /// More steep pairs than flat ones: the noise is perhaps not small against the spacing.
    bool rough() const { return steep > flat; }

    /// So many steep pairs that the given axes are no evidence of where the surface goes.
    bool askew() const;

    /// More contradictions than thin parts and outliers cause: ten pairs, and over 0.05 % of the flat or 15 %
    /// of the creased; these say nothing where axes are askew.
    bool doubtful() const;
    /// Sum of the two shares, or that of the flat pairs alone.
    double contradiction(bool creases_count) const;
    void operator+=(const NormalConsistency& other);
};

/// The pairs on one plane with opposite normals, and where the first of them is, relative to the octree's
/// origin. None as long as strays and thin parts may be to blame: of estimated normals there are next to none
/// where their sides are right, of given ones there are as many as doubtful() allows.
Occurrences doubtful_sides(const Octree& octree, const NormalConsistency& consistency, bool estimated);

/// Compares points, or 131,072 of them, with their two successors in octree order. O(n), parallel.
NormalConsistency check_normals(const Octree& octree);
/// The same where the spacing of the points is known (estimate_spacing).
NormalConsistency check_normals(const Octree& octree, double spacing);

/// The points that check_normals() looks at, of a cloud that is not in memory.
struct NormalSample {
    struct Point {
        Vec3 position, normal; ///< as the octree has them
    };
    std::vector<Point> points; ///< in octree order

    /// Is point `i` of a cloud of so many looked at?
    static bool holds(std::size_t i, std::size_t size);
    static std::size_t stride(std::size_t size); ///< from one to the next
    /// Of a cloud of `size`, one that is looked at; the sample has all of them.
    const Point& at(std::size_t i, std::size_t size) const;
};
/// The same of a sample of a cloud of `size` points of this spacing.
NormalConsistency check_normals(const NormalSample& sample, std::size_t size, double spacing);

/// Turns each normal to the side that told ones of its neighbours have, those most along it most.
void turn_to_neighbors(const std::vector<Vec3>& told, const Neighbors& neighbors, std::vector<Vec3>& normals);
/// Did turning leave more than half of the contradictions? Or did it double those at creases where these have
/// no say? Turned normals contradict each other there, too, but those of two sides of a wall near each other
/// do only once one of them faces in.
bool came_of_noise(const NormalConsistency& before, const NormalConsistency& after);

/// Turns the octree's normals to one side, in place; their axes stay. The evidence is that of orient_normals
/// with these options, for the given axes, or for those of the positions where the given ones lie askew;
/// where the shape leaves the side open (a sheet, a thin part), the side that most normals have is taken. If
/// that leaves more than half of the contradictions, these come from noise, and nothing is turned. Returns
/// how many normals were turned.
std::size_t mend_normals(Octree& octree, OrientOptions options = {});

} // namespace hsdm
