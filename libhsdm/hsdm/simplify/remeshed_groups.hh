#pragma once
// The results of remeshing, group by group, to be reused for the next mesh, which has most of the same
// facets.

#include "hsdm/simplify/unchanged.hh"

#include <cstdint>
#include <span>

namespace hsdm {

/// Groups of a mesh's facets and the facets that each group was remeshed to, over the same vertices and with
/// the same border.
class RemeshedGroups {
public:
    std::size_t size() const { return first_facet_.size() - 1; }

    /// Begins a new group of these facets.
    void begin(std::span<const Index> facets);
    /// Adds a resulting facet to the last group.
    void add_ring(std::span<const Index> ring);
    /// Appends a group of the mesh before, by the numbers that its facets and vertices have now.
    void copy(const RemeshedGroups& before, Index group, const Unchanged& same);

    /// Per facet of the next mesh, its group here, or no_index. A group applies if all of its facets are in
    /// that mesh, and no vertex of theirs is shared with a facet that has no group or one of a group that is
    /// not there completely. Facets marked `whole` are in no group and do not affect those beside them. The
    /// results of groups that were remeshed beside other facets may not fit together; the caller has to check
    /// that. O(facets).
    std::vector<Index> find(const PolygonMesh& mesh, const Unchanged& same,
                            const std::vector<std::uint8_t>& whole) const;
    /// Adds the resulting facets of the last group to a mesh with the same vertices.
    void append_last(PolygonMesh& mesh) const;

    PolygonMesh mesh; ///< the mesh that was remeshed, as it was before

private:
    std::vector<Index> facets_;                         // by group
    std::vector<Index> first_facet_{0}, first_ring_{0}; // per group, and the end
    std::vector<Index> first_corner_{0};                // per ring, and the end
    std::vector<Index> corners_;
};

} // namespace hsdm
