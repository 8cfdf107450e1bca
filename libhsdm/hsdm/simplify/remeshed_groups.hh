#pragma once
// What facets were cut and joined to, for the next mesh that has most of them.

#include "hsdm/simplify/content_keys.hh"

namespace hsdm {

/// Facets in groups, each of which became other facets over the same vertices with the same border. Places
/// and facets are known by their keys.
class RemeshedGroups {
public:
    std::size_t size() const { return first_facet_.size() - 1; }

    /// Appends a group, its facets by their keys.
    void begin(std::span<const Key> facets);
    /// Appends to the last group a facet that it became. `places`: keys of the mesh's vertices.
    void add_ring(std::span<const Index> ring, std::span<const Key> places);
    /// Appends a group of another collection.
    void copy(const RemeshedGroups& other, Index group);

    /// Per facet of a mesh its group here, or no_index. A group is taken whose facets are all there and share
    /// no vertex with one that is in none or in a group not all of which is there, nor has any vertex the
    /// place of another. Facets marked `whole` are in no group, and those beside them may be. What groups
    /// became may not go together, as they were beside others then: that is for the caller to find out.
    /// O(facets).
    std::vector<Index> find(const PolygonMesh& mesh, std::span<const Key> facets, const KeyIndex& vertices,
                            std::span<const Key> places, const std::vector<std::uint8_t>& whole) const;
    /// Adds what a group became to a mesh with such vertices.
    void append(Index group, const KeyIndex& vertices, PolygonMesh& mesh) const;

private:
    std::vector<Key> facets_;                           // by group
    std::vector<Index> first_facet_{0}, first_ring_{0}; // per group, and the end
    std::vector<Index> first_corner_{0};                // per ring, and the end
    std::vector<Key> corners_;
};

} // namespace hsdm
