#include "hsdm/contour/tangles_of_part.hh"

#include "hsdm/contour/untangle_rounds.hh"
#include "hsdm/core/disjoint_sets.hh"

#include <algorithm>
#include <utility>

namespace hsdm {
namespace {

/// Vertices of a pair's facets.
template <class Visit>
void for_each_corner(const PolygonMesh& mesh, const std::array<Index, 2>& pair, const Visit& visit) {
    for (const Index f : pair)
        for (const Index v : mesh.facet(f)) visit(v);
}

/// `vertices`: what those of the pair's mesh are in the one that was made.
Index least_voxel(const MeshOfPart& of, const PolygonMesh& mesh, const std::vector<Index>& vertices,
                  const std::array<Index, 2>& pair) {
    Index least = no_index;
    for_each_corner(mesh, pair, [&](Index v) { least = std::min(least, of.voxel(vertices[v])); });
    return least;
}

class PartUntangling {
public:
    PartUntangling(PolygonMesh& mesh, const MeshOfPart& of, const UntangleOptions& options,
                   const TanglePlan& plan)
        : mesh_(mesh), of_(of), options_(options), plan_(plan) {}

    TangleCounts run(const FacetCells& cells, bool& moved) {
        const SelfIntersections found = find_self_intersections(mesh_, cells);
        if (found.triangle_pairs == 0) return counts_;
        moved = true;
        move(found);
        if (plan_.mends && counts_.near) mend();
        return counts_;
    }

private:
    using FacetPairs = std::vector<std::array<Index, 2>>;

    void move(const SelfIntersections& found) {
        TangledPart around(mesh_, found.facet_pairs, options_.nearby);
        UntangleRounds rounds(around, options_);
        const std::vector<Index> vertices = around.vertices();
        const auto count = [&](std::size_t round) {
            counts_.triangles[round] =
                own_pairs(around.part, vertices, rounds.found(), &counts_.facets[round]);
        };
        count(0);
        counts_.near = std::ranges::any_of(rounds.found().facet_pairs, [&](const auto& pair) {
            return is_near(around.part, vertices, pair);
        });
        for (int round = 0; round < plan_.rounds && rounds.found().triangle_pairs > 0; ++round) {
            rounds.move();
            count(static_cast<std::size_t>(round) + 1);
        }
        around.write_back(mesh_);
    }

    /// Pairs of triangles, and of facets.
    std::uint64_t own_pairs(const PolygonMesh& part, const std::vector<Index>& vertices,
                            const SelfIntersections& found, std::uint64_t* facets = nullptr) const {
        std::uint64_t triangles = 0;
        for (std::size_t i = 0; i < found.facet_pairs.size(); ++i) {
            const Index least = least_voxel(of_, part, vertices, found.facet_pairs[i]);
            if (!of_.voxels.owns(least)) continue;
            triangles += found.triangles_of_pair[i];
            if (facets) ++*facets;
        }
        return triangles;
    }

    /// Groups of facets that have vertices in common, or facets beside them, do not see each other.
    void mend() {
        TangledPart around(mesh_, near_pairs(), options_.nearby);
        const std::vector<Index> vertices = around.vertices();
        SelfIntersections left = find_self_intersections(around.part);
        const std::uint64_t before = own_pairs(around.part, vertices, left);
        mend_part(around, left);
        counts_.changed = before - own_pairs(around.part, vertices, left);
        if (plan_.replaces) around.replace_facets(mesh_);
    }

    /// Pairs of groups that come near: what lies at the rim of the known need not be so in the whole.
    FacetPairs near_pairs() const {
        const FacetPairs pairs = find_self_intersections(mesh_).facet_pairs;
        const TangledPart all(mesh_, pairs, options_.nearby);
        DisjointSets groups(mesh_.vertex_count());
        for (const Index f : all.facets())
            for (const Index v : mesh_.facet(f)) groups.join(mesh_.facet(f)[0], v);
        for (const auto& pair : pairs) groups.join(mesh_.facet(pair[0])[0], mesh_.facet(pair[1])[0]);
        const auto group_of = [&](const auto& pair) { return groups.find(mesh_.facet(pair[0])[0]); };
        const std::vector<Index> vertices = indices_below(mesh_.vertex_count());
        std::vector<Index> near;
        for (const auto& pair : pairs)
            if (is_near(mesh_, vertices, pair)) near.push_back(group_of(pair));
        sort_unique(near);
        FacetPairs result;
        for (const auto& pair : pairs)
            if (std::ranges::binary_search(near, group_of(pair))) result.push_back(pair);
        return result;
    }

    /// `vertices`: what a part's are in the mesh.
    bool is_near(const PolygonMesh& part, const std::vector<Index>& vertices,
                 const std::array<Index, 2>& pair) const {
        bool near = false;
        for_each_corner(part, pair, [&](Index v) {
            const Index voxel = of_.voxel(vertices[v]);
            near = near || of_.voxels.owns(voxel) || of_.voxels.is_near(voxel);
        });
        return near;
    }

    PolygonMesh& mesh_;
    const MeshOfPart& of_;
    const UntangleOptions& options_;
    const TanglePlan& plan_;
    TangleCounts counts_;
};

} // namespace

void TangleCounts::operator+=(const TangleCounts& other) {
    for (std::size_t r = 0; r < triangles.size(); ++r)
        triangles[r] += other.triangles[r], facets[r] += other.facets[r];
    changed += other.changed;
    left.add(other.left);
    near |= other.near;
}

bool TanglePlan::weigh(const TangleCounts& sums) {
    if (weighed) return sums.changed == 0 && std::exchange(replaces, false);
    const auto fewest = std::ranges::min_element(sums.triangles);
    if (*fewest == 0) return false;
    rounds = static_cast<int>(fewest - sums.triangles.begin());
    weighed = true;
    mends = replaces = sums.facets[static_cast<std::size_t>(rounds)] <= untangling::most_pairs;
    return true;
}

TangleCounts untangle_part(PolygonMesh& mesh, const MeshOfPart& of, const UntangleOptions& options,
                           const TanglePlan& plan, const FacetCells& cells, bool& moved) {
    return PartUntangling(mesh, of, options, plan).run(cells, moved);
}

Occurrences own_intersections(const MeshOfPart& of) {
    const SelfIntersections found = find_self_intersections(of.mesh);
    const std::vector<Index> vertices = indices_below(of.mesh.vertex_count());
    Occurrences own;
    Index first = no_index; // voxel
    for (std::size_t i = 0; i < found.facet_pairs.size(); ++i) {
        const Index least = least_voxel(of, of.mesh, vertices, found.facet_pairs[i]);
        if (!of.voxels.owns(least)) continue;
        own.count += found.triangles_of_pair[i];
        if (least >= first) continue;
        first = least;
        own.first = of.mesh.positions[of.mesh.facet(found.facet_pairs[i][0])[0]];
    }
    return own;
}

} // namespace hsdm
