#pragma once
// Handles that no point speaks for: what the links of a grid face left of a web over a gap or a tunnel
// through a wall, by the mesh alone.

#include "hsdm/contour/mesh_of_part.hh"
#include "hsdm/contour/normal_sets.hh"
#include "hsdm/mesh/facet_links.hh"

#include <optional>

namespace hsdm {

/// The work of looking for rings, in facets looked at.
struct HandleWork {
    std::size_t rounds = 0, work = 0;
    std::size_t last = 0;    ///< of the last round, which another one would be, too
    bool is_complete = true; ///< all rings were looked for

    /// Is it less than half of what is done in a mesh of so many facets, so that none gives up?
    bool fits(std::size_t facets) const;
    /// Adds the work of another part; of the fewer rounds the last is done again.
    void operator+=(const HandleWork& other);
};

/// Where the mesh is part of a whole.
struct HandlesOfPart {
    const PartVoxels& voxels;
    std::size_t facets = 0; ///< of the whole, about: as much is done in the part as in that
    HandleWork own{};       ///< of rings at the part's own vertices
    std::size_t far = 0;    ///< work at those that are neither its own nor near by
};

/// Cuts the mesh along short rings of edges that do not bound a small part of their own, and closes both
/// sides, where points pass across the ring and are missing along it, or none speak for a quarter of the
/// facets beside it, nor of those beside the rings next to it on average, or its vertices are nearer to its
/// axis than points to each other (Witnesses). A bridge through the air is taken away like that, and a tunnel
/// filled. Each cut raises the Euler characteristic by two, so it comes to an end. A 2-manifold remains one;
/// vertices are copied with their origins, `voxel` is per origin. Returns how many rings were cut. O(facets):
/// rings are looked for near facets that no set of their vertices' voxels agrees with, that face aside from
/// one where a wall or gap passes, and where two short edges of a facet meet, and no more once that has taken
/// so much work. Serial but for the first look at all facets. `links` are the mesh's if they are known; they
/// are found if needed, and none are left once the mesh has changed.
std::size_t cut_handles(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                        std::span<const Index> voxel, PolygonMesh& mesh, std::optional<FacetLinks>& links,
                        HandlesOfPart* part = nullptr);

} // namespace hsdm
