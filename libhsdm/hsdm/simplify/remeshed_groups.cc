#include "hsdm/simplify/remeshed_groups.hh"

#include <algorithm>

namespace hsdm {

void RemeshedGroups::begin(std::span<const Index> facets) {
    facets_.insert(facets_.end(), facets.begin(), facets.end());
    first_facet_.push_back(static_cast<Index>(facets_.size()));
    first_ring_.push_back(first_ring_.back());
}

void RemeshedGroups::add_ring(std::span<const Index> ring) {
    corners_.insert(corners_.end(), ring.begin(), ring.end());
    first_corner_.push_back(static_cast<Index>(corners_.size()));
    ++first_ring_.back();
}

void RemeshedGroups::copy(const RemeshedGroups& before, Index group, const Unchanged& same) {
    begin({});
    for (Index i = before.first_facet_[group]; i < before.first_facet_[group + 1]; ++i)
        facets_.push_back(same.facet_now[before.facets_[i]]);
    first_facet_.back() = static_cast<Index>(facets_.size());
    for (Index r = before.first_ring_[group]; r < before.first_ring_[group + 1]; ++r) {
        add_ring({});
        for (Index c = before.first_corner_[r]; c < before.first_corner_[r + 1]; ++c)
            corners_.push_back(same.vertex_now[before.corners_[c]]);
        first_corner_.back() = static_cast<Index>(corners_.size());
    }
}

std::vector<Index> RemeshedGroups::find(const PolygonMesh& next, const Unchanged& same,
                                        const std::vector<std::uint8_t>& whole) const {
    std::vector<Index> group(next.facet_count(), no_index);
    if (size() == 0) return group;
    std::vector<Index> group_of(same.facet_now.size(), no_index), missing(size());
    for (Index g = 0; g < size(); ++g) {
        missing[g] = first_facet_[g + 1] - first_facet_[g];
        for (Index i = first_facet_[g]; i < first_facet_[g + 1]; ++i) group_of[facets_[i]] = g;
    }
    for (std::size_t f = 0; f < group.size(); ++f) {
        if (whole[f] || same.facet[f] == no_index) continue;
        group[f] = group_of[same.facet[f]];
        if (group[f] != no_index) --missing[group[f]];
    }
    std::vector<std::uint8_t> changed(next.vertex_count(), 0);
    for (std::size_t f = 0; f < group.size(); ++f)
        if (!whole[f] && (group[f] == no_index || missing[group[f]] != 0))
            for (Index v : next.facet(f)) changed[v] = 1;
    for (std::size_t f = 0; f < group.size(); ++f)
        if (group[f] != no_index && std::ranges::any_of(next.facet(f), [&](Index v) { return changed[v]; }))
            missing[group[f]] = no_index;
    for (Index& g : group)
        if (g != no_index && missing[g] != 0) g = no_index;
    return group;
}

void RemeshedGroups::append_last(PolygonMesh& to) const {
    for (Index r = first_ring_[size() - 1]; r < first_ring_[size()]; ++r)
        to.add_facet(std::span(corners_).subspan(first_corner_[r], first_corner_[r + 1] - first_corner_[r]));
}

} // namespace hsdm
