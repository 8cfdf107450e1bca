#include "hsdm/contour/rims.hh"

#include "hsdm/contour/facet_constants.hh"
#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hsdm {
namespace {

bool is_at_rim(const DualMesh& mesh, Index dual) {
    return std::ranges::any_of(mesh.duals.corners_of(dual), [&](FacetCorner corner) {
        return mesh.links.of(corner).rim || mesh.links.of(corner.previous()).rim;
    });
}

/// Is a vertex in a voxel without points, in a facet with one at a rim?
bool is_beyond_rim(const DualMesh& mesh, Index dual) {
    return mesh.duals.voxels[dual].voxel == no_index
           && std::ranges::any_of(mesh.duals.corners_of(dual), [&](FacetCorner corner) {
                  return is_at_rim(mesh, mesh.duals.from(corner.next()))
                         || is_at_rim(mesh, mesh.duals.from(corner.previous()));
              });
}

/// Where the sheets of one vertex end.
struct SheetEnd {
    Vec3 nearest{0, 0, 0};                                     ///< of their points
    double distance = std::numeric_limits<double>::infinity(); ///< to it
    double spacing = 0;                                        ///< of their points, where they are densest
};

class EndFinder {
public:
    EndFinder(const Octree& octree, const OctreeLevel& level, const NormalSets& sets, const DualMesh& mesh)
        : octree_(octree), level_(level), sets_(sets), mesh_(mesh) {}

    /// Looks at the sets that cross the edges of the vertex's voxel, and at the voxel's own.
    SheetEnd operator()(Index dual, const Vec3& at) const {
        SheetEnd end;
        const Index own = mesh_.duals.voxels[dual].voxel;
        const bool is_beyond = own == no_index && mesh_.duals.open[dual] == 0;
        Index most = 0, last = no_index;
        const auto look = [&](Index s) {
            most = std::max(most, is_beyond ? most_around(sets_.sets[s]) : sets_.sets[s].count);
            find_nearest(s, at, end);
        };
        for (const FacetCorner corner : mesh_.duals.corners_of(dual)) {
            const Index s = mesh_.crossings.of(corner).set;
            if (std::exchange(last, s) != s) look(s);
        }
        if (own != no_index)
            for (Index s = sets_.first[own]; s < sets_.first[own + 1]; ++s) look(s);
        // A full set covers about one face of a voxel.
        end.spacing = level_.voxel_size / std::sqrt(static_cast<double>(most));
        return end;
    }

private:
    /// Points of the fullest set around that faces the same way: at the tip of a wedge its own may have one.
    Index most_around(const NormalSet& set) const {
        Index most = set.count;
        for_neighbors(level_, set.voxel, [&](Index v) {
            for (const NormalSet& other : sets_.of_voxel(v))
                if ((other.normal | set.normal) > 0) most = std::max(most, other.count);
        });
        return most;
    }

    void find_nearest(Index s, const Vec3& at, SheetEnd& end) const {
        sets_.for_points_of(s, level_, [&](Index p) {
            const double d = (octree_.positions[p] - at).norm();
            if (d < end.distance) end.distance = d, end.nearest = octree_.positions[p];
        });
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    const NormalSets& sets_;
    const DualMesh& mesh_;
};

/// The place of a vertex once its sheet has that share less of what it goes on farther than a spacing beyond
/// its points.
Vec3 drawn_in(const SheetEnd& end, const Vec3& p, VertexClass type, const Vec3& direction, double share) {
    const Vec3 way = end.nearest - p, across = direction * (direction | way);
    const Vec3 back = type == VertexClass::smooth ? way - across : across;
    const double distance = back.norm();
    return distance > end.spacing ? p + back * (share * (1 - end.spacing / distance)) : p;
}

/// Does a facet round a vertex turn over between two places of the vertices?
bool turns_over(const DualMesh& mesh, Index dual, const std::vector<Vec3>& before,
                const std::vector<Vec3>& after) {
    return std::ranges::any_of(mesh.duals.corners_of(dual), [&](FacetCorner corner) {
        const auto area = [&](const std::vector<Vec3>& at) {
            const auto place = [&](FacetCorner c) { return at[mesh.duals.from(c)]; };
            const Vec3 own = at[dual];
            return (place(corner.next()) - own) % (place(corner.opposite()) - own)
                   + (place(corner.opposite()) - own) % (place(corner.previous()) - own);
        };
        return (area(before) | area(after)) < 0;
    });
}

/// The mean of a vertex's neighbours, each as often as facets have it.
Vec3 amid(const DualMesh& mesh, Index dual, const std::vector<Vec3>& positions) {
    Vec3 sum(0, 0, 0);
    double count = 0;
    for (const FacetCorner corner : mesh.duals.corners_of(dual))
        for (const FacetCorner beside : {corner.next(), corner.previous()})
            sum += positions[mesh.duals.from(beside)], ++count;
    return sum / count;
}

/// Vertices round which a facet turns over go back, a quarter of the way at a time; returns these.
std::vector<Index> put_back(const DualMesh& mesh, const std::vector<Vec3>& placed,
                            const std::vector<Index>& moved, std::vector<Vec3>& positions) {
    std::vector<Vec3> drawn;
    drawn.reserve(moved.size());
    for (const Index v : moved) drawn.push_back(positions[v]);
    std::vector<std::uint8_t> quarters(moved.size(), 4), turning(moved.size());
    for (bool any = true; any;) {
        for_each_index(moved.size(), chunks::slow, [&](Index i) {
            turning[i] = quarters[i] > 0 && turns_over(mesh, moved[i], placed, positions);
        });
        any = false;
        for (std::size_t i = 0; i < moved.size(); ++i) {
            if (!turning[i]) continue;
            any = true;
            const Vec3& from = placed[moved[i]];
            positions[moved[i]] = from + (drawn[i] - from) * (0.25 * --quarters[i]);
        }
    }
    std::vector<Index> back;
    for (std::size_t i = 0; i < moved.size(); ++i)
        if (quarters[i] < 4) back.push_back(moved[i]);
    return back;
}

/// Moves vertices half of the way to the mean of their neighbours, until none ends farther off than a
/// spacing, but for those round which a facet would turn over.
void ease_in(const EndFinder& end_of, const DualMesh& mesh, const std::vector<Vec3>& placed,
             std::vector<Index> far, std::vector<Vec3>& positions) {
    std::vector<Vec3> eased;
    std::vector<std::uint8_t> turning;
    for (int round = 0; round < spikes::rounds; ++round) {
        far = gathered(far, indices_where(far.size(), chunks::heavy, [&](Index i) {
                           const SheetEnd end = end_of(far[i], positions[far[i]]);
                           return end.distance > end.spacing;
                       }));
        if (far.empty()) return;
        eased.resize(far.size()), turning.resize(far.size());
        for_each_index(far.size(), chunks::heavy, [&](Index i) {
            eased[i] = 0.5 * (positions[far[i]] + amid(mesh, far[i], positions));
        });
        for (std::size_t i = 0; i < far.size(); ++i) std::swap(positions[far[i]], eased[i]);
        for_each_index(far.size(), chunks::heavy,
                       [&](Index i) { turning[i] = turns_over(mesh, far[i], placed, positions); });
        for (std::size_t i = 0; i < far.size(); ++i)
            if (turning[i] != 0) positions[far[i]] = eased[i];
    }
}

} // namespace

void draw_in_rims(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                  const DualMesh& mesh, PlacedVertices& vertices) {
    const std::vector<Vec3> placed = copy_of_large(vertices.positions);
    const EndFinder end_of(octree, level, sets, mesh);
    const std::vector<Index> moved = indices_where(mesh.duals.size(), chunks::slow, [&](Index v) {
        if (vertices.classes[v] == VertexClass::corner
            || !(mesh.duals.open[v] || is_at_rim(mesh, v) || is_beyond_rim(mesh, v)))
            return false;
        vertices.positions[v] = drawn_in(end_of(v, placed[v]), placed[v], vertices.classes[v],
                                         vertices.directions[v], mesh.duals.open[v] ? 1 : rims::drawn_share);
        return vertices.positions[v] != placed[v];
    });
    std::vector<Index> back = put_back(mesh, placed, moved, vertices.positions);
    std::erase_if(back, [&](Index v) { return mesh.duals.open[v] != 0; });
    ease_in(end_of, mesh, placed, std::move(back), vertices.positions);
}

} // namespace hsdm
