#include "hsdm/completion/crossed_moves.hh"

#include "hsdm/core/parallel_sort.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/spatial/self_intersections.hh"

namespace hsdm {
namespace {

/// The missing facets of a patch.
PolygonMesh missing_part(const CompletionPatch& patch, std::vector<Index>& facets) {
    facets =
        indices_where(patch.net.facet_count(), chunks::light, [&](Index q) { return patch.missing[q] != 0; });
    PolygonMesh part;
    part.positions = patch.net.positions;
    for (const Index q : facets) part.add_facet(patch.net.facet(q));
    return part;
}

/// The ways of the sides of missing facets: of each that has no held end the triangle from where one end was
/// to where both are.
class Sweeps {
public:
    Sweeps(const CompletionPatch& patch, const std::vector<Vec3>& from) : patch_(patch), from_(from) {
        const auto count = static_cast<Index>(from.size());
        swept.positions = from;
        swept.positions.insert(swept.positions.end(), patch.net.positions.begin(), patch.net.positions.end());
        for (std::size_t q = 0; q < patch.net.facet_count(); ++q) {
            if (patch.missing[q] == 0) continue;
            const auto corners = patch.net.facet(q);
            for (std::size_t c = 0; c < corners.size(); ++c) {
                const Index a = corners[c], b = corners[(c + 1) % corners.size()];
                if (!moves(a) || !moves(b)) continue;
                swept.add_facet(std::array<Index, 3>{a, a + count, b + count});
                mover.push_back(a);
                box.add(from[a]), box.add(patch.net.positions[a]), box.add(patch.net.positions[b]);
            }
        }
    }

    PolygonMesh swept;
    std::vector<Index> mover; ///< per triangle, whose way its first side is
    Box box;

private:
    bool moves(Index v) const {
        return patch_.held[v] == 0 && (patch_.net.positions[v] - from_[v]).sqrnorm() > 0;
    }

    const CompletionPatch& patch_;
    const std::vector<Vec3>& from_;
};

/// Appends the facets of a mesh that may reach into a box.
void append_near(const PolygonMesh& mesh, const Box& box, PolygonMesh& to) {
    const std::vector<Index> near = indices_where(mesh.facet_count(), chunks::usual, [&](Index f) {
        const Box of = box_of(mesh, f);
        for (unsigned k = 0; k < 3; ++k)
            if (of.hi[k] < box.lo[k] || of.lo[k] > box.hi[k]) return false;
        return true;
    });
    const PolygonMesh part = part_of(mesh, near);
    const auto shift = static_cast<Index>(to.positions.size());
    to.positions.insert(to.positions.end(), part.positions.begin(), part.positions.end());
    std::vector<Index> corners;
    for (std::size_t f = 0; f < part.facet_count(); ++f) {
        corners.clear();
        for (const Index v : part.facet(f)) corners.push_back(v + shift);
        to.add_facet(corners);
    }
}

} // namespace

std::vector<Index> crossed_moves(const PolygonMesh& mesh, const CompletionPatch& patch,
                                 const std::vector<Vec3>& from) {
    std::vector<Index> crossed;
    std::vector<Index> missing;
    for (const auto& pair : find_self_intersections(missing_part(patch, missing)).facet_pairs)
        for (const Index facet : pair)
            for (const Index v : patch.net.facet(missing[facet]))
                if (patch.held[v] == 0) crossed.push_back(v);
    Sweeps sweeps(patch, from);
    const std::size_t ways = sweeps.mover.size();
    append_near(mesh, sweeps.box, sweeps.swept);
    for (const auto& [first, second] : find_self_intersections(sweeps.swept).facet_pairs)
        if (first < ways && second >= ways) crossed.push_back(sweeps.mover[first]);
    sort_unique(crossed);
    return crossed;
}

} // namespace hsdm
