#include "hsdm/simplify/remeshed_groups.hh"

#include <algorithm>

namespace hsdm {

void RemeshedGroups::begin(std::span<const Key> facets) {
    facets_.insert(facets_.end(), facets.begin(), facets.end());
    first_facet_.push_back(static_cast<Index>(facets_.size()));
    first_ring_.push_back(first_ring_.back());
}

void RemeshedGroups::add_ring(std::span<const Index> ring, std::span<const Key> places) {
    for (Index v : ring) corners_.push_back(places[v]);
    first_corner_.push_back(static_cast<Index>(corners_.size()));
    ++first_ring_.back();
}

void RemeshedGroups::copy(const RemeshedGroups& other, Index group) {
    begin(std::span(other.facets_)
              .subspan(other.first_facet_[group], other.first_facet_[group + 1] - other.first_facet_[group]));
    for (Index r = other.first_ring_[group]; r < other.first_ring_[group + 1]; ++r) {
        corners_.insert(corners_.end(), other.corners_.begin() + other.first_corner_[r],
                        other.corners_.begin() + other.first_corner_[r + 1]);
        first_corner_.push_back(static_cast<Index>(corners_.size()));
        ++first_ring_.back();
    }
}

std::vector<Index> RemeshedGroups::find(const PolygonMesh& mesh, std::span<const Key> facets,
                                        const KeyIndex& vertices, std::span<const Key> places,
                                        const std::vector<std::uint8_t>& whole) const {
    if (size() == 0) return std::vector<Index>(facets.size(), no_index);
    std::vector<Index> group_of(facets_.size());
    for (Index g = 0; g < size(); ++g)
        std::fill(group_of.begin() + first_facet_[g], group_of.begin() + first_facet_[g + 1], g);
    const KeyIndex known(facets_);
    std::vector<Index> group(facets.size(), no_index), missing(size());
    for (Index g = 0; g < size(); ++g) missing[g] = first_facet_[g + 1] - first_facet_[g];
    for (std::size_t f = 0; f < group.size(); ++f) {
        const Index place = whole[f] ? no_index : known.find(facets[f]);
        if (place != no_index) --missing[group[f] = group_of[place]];
    }
    std::vector<std::uint8_t> changed(mesh.vertex_count(), 0);
    for (Index v = 0; v < changed.size(); ++v)
        if (const Index first = vertices.find(places[v]); first != v && first != no_index)
            changed[v] = changed[first] = 1;
    for (std::size_t f = 0; f < group.size(); ++f)
        if (!whole[f] && (group[f] == no_index || missing[group[f]] != 0))
            for (Index v : mesh.facet(f)) changed[v] = 1;
    for (std::size_t f = 0; f < group.size(); ++f)
        if (const auto ring = mesh.facet(f);
            group[f] != no_index
            && std::any_of(ring.begin(), ring.end(), [&](Index v) { return changed[v]; }))
            missing[group[f]] = no_index;
    for (Index& g : group)
        if (g != no_index && missing[g] != 0) g = no_index;
    return group;
}

void RemeshedGroups::append(Index group, const KeyIndex& vertices, PolygonMesh& mesh) const {
    for (Index r = first_ring_[group]; r < first_ring_[group + 1]; ++r) {
        for (Index c = first_corner_[r]; c < first_corner_[r + 1]; ++c)
            mesh.corners.push_back(vertices.find(corners_[c]));
        mesh.first.push_back(static_cast<Index>(mesh.corners.size()));
    }
}

} // namespace hsdm
