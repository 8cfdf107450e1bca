#include "hsdm/contour/move_to_creases.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/mesh/vertex_neighbors.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// How well a facet faces along one of two normals: the least cosine of its triangles with the nearer normal.
/// The triangles fan out from the corner for which that is largest, because a quad with three corners on a
/// crease has a straight one, and a quad across a crease folds along one diagonal. -1 if triangles are too
/// thin.
double along(const std::vector<Vec3>& ring, const std::array<Vec3, 2>& normals) {
    const std::size_t n = ring.size();
    double best = -1;
    for (std::size_t from = 0; from < n; ++from) {
        double least = 1;
        for (std::size_t i = 1; i + 1 < n && least > best; ++i) {
            const Vec3 &a = ring[from], &b = ring[(from + i) % n], &c = ring[(from + i + 1) % n];
            const Vec3 up = (b - a) % (c - a);
            const double length = up.norm();
            const bool thin = length <= creases::least_sine * (b - a).norm() * (c - a).norm();
            least = thin ? -1 : std::min(least, std::max(up | normals[0], up | normals[1]) / length);
        }
        best = std::max(best, least);
    }
    return best;
}

/// Moves vertices to creases, and back again where that makes facets intersect.
class CreaseMoves {
public:
    CreaseMoves(PolygonMesh& mesh, double voxel_size, const std::vector<PlacedVertices::OnCrease>& on_creases)
        : mesh_(mesh),
          voxel_size_(voxel_size),
          on_creases_(on_creases),
          wanted_(marked(mesh.positions.size(), on_creases)),
          at_(mesh, wanted_),
          beside_(facets_beside()),
          moved_(on_creases.size(), 0) {
        for (const auto& v : on_creases) was_.push_back(mesh.positions[v.dual]);
    }

    /// Returns, per wanted vertex, whether it has moved.
    const std::vector<std::uint8_t>& run() {
        bool any = true; // a vertex may become free to move when another has moved
        for (int round = 0; round < enough_rounds && any; ++round) {
            any = false;
            for (std::size_t i = 0; i < moved_.size(); ++i)
                if (!moved_[i] && suits_all(i)) {
                    mesh_.positions[on_creases_[i].dual] = on_creases_[i].position;
                    moved_[i] = 1;
                    any = true;
                }
        }
        while (take_back_intersecting()) // each pass moves back at least one vertex
            while (take_back_unsuited()) {
            }
        return moved_;
    }

private:
    static std::vector<std::uint8_t> marked(std::size_t count,
                                            const std::vector<PlacedVertices::OnCrease>& vertices) {
        std::vector<std::uint8_t> result(count, 0);
        for (const auto& v : vertices) result[v.dual] = 1;
        return result;
    }

    /// Facets that share vertices with facets at wanted vertices.
    std::vector<Index> facets_beside() const {
        std::vector<std::uint8_t> beside(wanted_.size(), 0);
        for (Index f : at_.all())
            for (Index v : mesh_.facet(f)) beside[v] = 1;
        return FacetsAt(mesh_, beside).all();
    }

    bool take_back(std::size_t i) {
        mesh_.positions[on_creases_[i].dual] = was_[i];
        moved_[i] = 0;
        return true;
    }

    bool take_back_intersecting() {
        bool any = false;
        for (const auto& pair : find_self_intersections(part_of(mesh_, beside_)).facet_pairs)
            for (Index f : pair)
                for (Index v : mesh_.facet(beside_[f])) {
                    if (!wanted_[v]) continue;
                    const auto at =
                        std::ranges::lower_bound(on_creases_, v, {}, &PlacedVertices::OnCrease::dual);
                    const auto i = static_cast<std::size_t>(at - on_creases_.begin());
                    if (moved_[i]) any = take_back(i);
                }
        return any;
    }

    /// Moves back vertices whose facets no longer pass the test, now that others have moved back.
    bool take_back_unsuited() {
        bool any = false;
        for (std::size_t i = 0; i < moved_.size(); ++i)
            if (moved_[i] && !suits_all(i)) any = take_back(i);
        return any;
    }

    bool suits_all(std::size_t i) {
        return std::ranges::all_of(at_.of(on_creases_[i].dual), [&](Index f) { return suits(f, i); });
    }

    /// Does a facet pass the test with vertex i on its crease: other vertices not too close, normal hardly
    /// turned, facing along a sheet (or as near and as badly before the move)?
    bool suits(Index facet, std::size_t i) {
        const PlacedVertices::OnCrease& to = on_creases_[i];
        after_.clear();
        before_.clear();
        for (Index v : mesh_.facet(facet)) {
            before_.push_back(v == to.dual ? was_[i] : mesh_.positions[v]);
            after_.push_back(v == to.dual ? to.position : mesh_.positions[v]);
            const double side = (after_.back() - to.position).norm();
            if (v != to.dual && side < sheets::plane_error * voxel_size_
                && side < (after_.back() - was_[i]).norm())
                return false;
        }
        const Vec3 now = area_vector(after_), then = area_vector(before_);
        if ((now | then) <= angles::halfway * now.norm() * then.norm()) return false;
        const double is = along(after_, to.normals);
        return is > angles::halfway || is >= along(before_, to.normals);
    }

    PolygonMesh& mesh_;
    double voxel_size_;
    const std::vector<PlacedVertices::OnCrease>& on_creases_;
    std::vector<std::uint8_t> wanted_; // per vertex
    FacetsAt at_;                      // those
    std::vector<Index> beside_;
    std::vector<std::uint8_t> moved_;  // per wanted vertex: has it moved?
    std::vector<Vec3> was_;            // ... its position before
    std::vector<Vec3> after_, before_; // positions of a facet's vertices
};

} // namespace

std::size_t move_to_creases(PolygonMesh& mesh, double voxel_size, PlacedVertices& vertices) {
    if (vertices.on_creases.empty()) return 0;
    CreaseMoves moves(mesh, voxel_size, vertices.on_creases);
    const std::vector<std::uint8_t>& moved = moves.run();
    for (std::size_t i = 0; i < moved.size(); ++i)
        if (moved[i]) vertices.is_clamped[vertices.on_creases[i].dual] = 0;
    const auto count = static_cast<std::size_t>(std::ranges::count(moved, 1));
    vertices.clamped -= count;
    return count;
}

} // namespace hsdm
