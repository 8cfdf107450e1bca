#include "hsdm/contour/components_of_part.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"

#include <algorithm>
#include <utility>

namespace hsdm {
namespace {

class ComponentsOfPart {
public:
    explicit ComponentsOfPart(const MeshOfPart& of)
        : of_(of), mesh_(of.mesh), vertices_(mesh_.vertex_count()), facets_(mesh_.vertex_count(), 0) {
        own_.assign(mesh_.facet_count(), 0);
        for_each_index(own_.size(), chunks::quick, [&](Index f) {
            own_[f] = is_own(f);
            if (own_[f])
                for (const Index v : mesh_.facet(f)) vertices_.join(mesh_.facet(f)[0], v);
        });
        for (Index f = 0; f < own_.size(); ++f)
            if (own_[f]) ++facets_[component_of(f)];
    }

    std::size_t largest() const { return facets_.empty() ? 0 : std::ranges::max(facets_); }

    void add_shared(const std::function<std::uint64_t(Index)>& code, PartComponents& result) {
        std::vector<std::uint8_t> by_own(mesh_.vertex_count(), 0), by_others = by_own;
        for (Index f = 0; f < own_.size(); ++f)
            for (const Index v : mesh_.facet(f)) (own_[f] ? by_own : by_others)[v] = 1;
        std::vector<Index> number(mesh_.vertex_count(), no_index), rank_in;
        for (Index v = 0; v < by_own.size(); ++v) {
            if (!by_own[v] && !by_others[v]) continue;
            const Index voxel = of_.voxel(v);
            if (voxel >= rank_in.size()) rank_in.resize(std::size_t{voxel} + 1, 0);
            const Index rank = rank_in[voxel]++;
            if (!by_own[v] || !by_others[v]) continue;
            const Index component = vertices_.find(v);
            if (number[component] == no_index) {
                number[component] = static_cast<Index>(result.sizes.size());
                result.sizes.push_back(facets_[component]);
            }
            result.shared.push_back({code(voxel), rank, number[component]});
        }
    }

private:
    bool is_own(Index f) const {
        Index least = no_index; // voxel
        for (const Index v : mesh_.facet(f)) least = std::min(least, of_.voxel(v));
        return of_.voxels.owns(least);
    }
    Index component_of(Index f) { return vertices_.find(mesh_.facet(f)[0]); }

    const MeshOfPart& of_;
    const PolygonMesh& mesh_;
    DisjointSets vertices_;
    std::vector<std::size_t> facets_; // per component, known by its least vertex
    std::vector<std::uint8_t> own_;   // per facet
};

} // namespace

PartComponents components_of_part(const MeshOfPart& of, std::size_t enough,
                                  const std::function<std::uint64_t(Index)>& code) {
    ComponentsOfPart components(of);
    PartComponents result;
    result.largest = components.largest();
    if (result.largest < enough) components.add_shared(code, result);
    return result;
}

std::size_t largest_component(std::span<const PartComponents> parts, std::size_t enough) {
    std::size_t largest = 0, count = 0;
    std::vector<PartComponents::Shared> shared;
    std::vector<std::size_t> sizes;
    for (const PartComponents& part : parts) {
        largest = std::max(largest, part.largest);
        for (PartComponents::Shared vertex : part.shared) {
            vertex.component += static_cast<Index>(count);
            shared.push_back(vertex);
        }
        sizes.insert(sizes.end(), part.sizes.begin(), part.sizes.end());
        count = sizes.size();
    }
    const auto place = [](const PartComponents::Shared& vertex) {
        return std::pair(vertex.voxel, vertex.rank);
    };
    std::ranges::sort(shared, {}, place);
    DisjointSets components(count);
    for (std::size_t i = 1; i < shared.size(); ++i)
        if (place(shared[i]) == place(shared[i - 1]))
            components.join(shared[i].component, shared[i - 1].component);
    std::vector<std::size_t> sums(count, 0);
    for (Index c = 0; c < count; ++c) largest = std::max(largest, sums[components.find(c)] += sizes[c]);
    return std::min(largest, enough);
}

} // namespace hsdm
