#include "hsdm/contour/rims.hh"

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
        Index most = 0, last = no_index;
        const auto look = [&](Index s) {
            most = std::max(most, sets_.sets[s].count);
            find_nearest(s, at, end);
        };
        for (const FacetCorner corner : mesh_.duals.corners_of(dual)) {
            const Index s = mesh_.crossings.of(corner).set;
            if (std::exchange(last, s) != s) look(s);
        }
        const Index own = mesh_.duals.voxels[dual].voxel;
        if (own != no_index)
            for (Index s = sets_.first[own]; s < sets_.first[own + 1]; ++s) look(s);
        // A full set covers about one face of a voxel.
        end.spacing = level_.voxel_size / std::sqrt(static_cast<double>(most));
        return end;
    }

private:
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

/// The place of a vertex once its sheet ends a spacing beyond its points, or where it was.
Vec3 drawn_in(const SheetEnd& end, const Vec3& p, VertexClass type, const Vec3& direction) {
    const Vec3 way = end.nearest - p, across = direction * (direction | way);
    const Vec3 back = type == VertexClass::smooth ? way - across : across;
    const double distance = back.norm();
    return distance > end.spacing ? p + back * (1 - end.spacing / distance) : p;
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

} // namespace

void draw_in_rims(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                  const DualMesh& mesh, PlacedVertices& vertices) {
    const std::vector<Vec3> placed = copy_of_large(vertices.positions);
    const EndFinder end_of(octree, level, sets, mesh);
    const std::vector<Index> moved = indices_where(mesh.duals.size(), chunks::slow, [&](Index v) {
        if (vertices.classes[v] == VertexClass::corner || !(mesh.duals.open[v] || is_at_rim(mesh, v)))
            return false;
        vertices.positions[v] =
            drawn_in(end_of(v, placed[v]), placed[v], vertices.classes[v], vertices.directions[v]);
        return vertices.positions[v] != placed[v];
    });
    std::vector<Vec3> drawn;
    drawn.reserve(moved.size());
    for (const Index v : moved) drawn.push_back(vertices.positions[v]);
    // Those round which a facet turns over go back, a quarter of the way at a time.
    std::vector<std::uint8_t> quarters(moved.size(), 4), turning(moved.size());
    for (bool any = true; any;) {
        for_each_index(moved.size(), chunks::slow, [&](Index i) {
            turning[i] = quarters[i] > 0 && turns_over(mesh, moved[i], placed, vertices.positions);
        });
        any = false;
        for (std::size_t i = 0; i < moved.size(); ++i) {
            if (!turning[i]) continue;
            any = true;
            const Vec3& from = placed[moved[i]];
            vertices.positions[moved[i]] = from + (drawn[i] - from) * (0.25 * --quarters[i]);
        }
    }
}

} // namespace hsdm
