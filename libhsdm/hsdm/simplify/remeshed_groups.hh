#pragma once
// The results of remeshing, group by group, to be reused for the next mesh, which has most of the same
// facets.

#include "hsdm/simplify/content_keys.hh"

namespace hsdm {

/// Groups of facets and the facets that each group was remeshed to, over the same vertices and with the same
/// border. Vertices and facets are known by keys of their places.
class RemeshedGroups {
public:
    std::size_t size() const { return first_facet_.size() - 1; }

    /// Begins a new group of the facets with these keys.
    void begin(std::span<const Key> facets);
    /// Adds a resulting facet to the last group. `places`: keys of the mesh's vertices.
    void add_ring(std::span<const Index> ring, std::span<const Key> places);
    /// Appends a group of another collection.
    void copy(const RemeshedGroups& other, Index group);

    /// Per facet of a mesh, its group here, or no_index. A group applies if all of its facets are in the
    /// mesh, no vertex of theirs coincides with another, and none is shared with a facet that has no group or
    /// one of a group that is not there completely. Facets marked `whole` are in no group and do not affect
    /// those beside them. The results of groups that were remeshed beside other facets may not fit together;
    /// the caller has to check that. O(facets).
    std::vector<Index> find(const PolygonMesh& mesh, std::span<const Key> facets, const KeyIndex& vertices,
                            std::span<const Key> places, const std::vector<std::uint8_t>& whole) const;
    /// Adds the resulting facets of a group to a mesh with such vertices.
    void append(Index group, const KeyIndex& vertices, PolygonMesh& mesh) const;

private:
    std::vector<Key> facets_;                           // by group
    std::vector<Index> first_facet_{0}, first_ring_{0}; // per group, and the end
    std::vector<Index> first_corner_{0};                // per ring, and the end
    std::vector<Key> corners_;
};

} // namespace hsdm
