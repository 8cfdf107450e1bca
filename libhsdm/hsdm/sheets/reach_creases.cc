#include "hsdm/sheets/reach_creases.hh"

#include "hsdm/facets/part_of.hh"
#include "hsdm/quality/self_intersections.hh"

#include <algorithm>

namespace hsdm {
namespace {

constexpr int most_rounds = 4;
constexpr double turn_cosine = 0.7; // of a facet's normal with that before, and with its sheet's
constexpr double nearest = 0.1;     // voxels, to another vertex
constexpr double least_sine = 0.02; // of a triangle's corner

/// The facets at some vertices.
class FacetsAt {
public:
    FacetsAt(const PolygonMesh& mesh, const std::vector<std::uint8_t>& vertices) {
        for (Index f = 0; f < mesh.facet_count(); ++f)
            for (Index v : mesh.facet(f))
                if (vertices[v]) pairs_.emplace_back(v, f);
        std::sort(pairs_.begin(), pairs_.end());
    }

    template <class Test>
    bool all_of(Index vertex, const Test& test) const {
        auto it = std::lower_bound(pairs_.begin(), pairs_.end(), std::pair{vertex, Index{0}});
        for (; it != pairs_.end() && it->first == vertex; ++it)
            if (!test(it->second)) return false;
        return true;
    }

    /// In order, each once.
    std::vector<Index> facets() const {
        std::vector<Index> result;
        for (const auto& [vertex, facet] : pairs_) result.push_back(facet);
        std::sort(result.begin(), result.end());
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }

private:
    std::vector<std::pair<Index, Index>> pairs_; // vertex and facet
};

Vec3 area_of(const std::vector<Vec3>& ring) {
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += (ring[i] - ring[0]) % (ring[i + 1] - ring[0]);
    return sum;
}

/// The cosine of a facet's normal with the nearer one of two; of a facet of several triangles the least, if
/// they all end at the corner for which that is largest: with three corners on a crease a quad has a straight
/// one, and across a crease it folds. -1 if triangles are too thin.
double along(const std::vector<Vec3>& ring, const std::array<Vec3, 2>& normals) {
    const std::size_t n = ring.size();
    double best = -1;
    for (std::size_t from = 0; from < n; ++from) {
        double least = 1;
        for (std::size_t i = 1; i + 1 < n && least > best; ++i) {
            const Vec3 &a = ring[from], &b = ring[(from + i) % n], &c = ring[(from + i + 1) % n];
            const Vec3 up = (b - a) % (c - a);
            const double length = up.norm();
            const bool thin = length <= least_sine * (b - a).norm() * (c - a).norm();
            least = thin ? -1 : std::min(least, std::max(up | normals[0], up | normals[1]) / length);
        }
        best = std::max(best, least);
    }
    return best;
}

/// Moves vertices to creases, and back again where that makes facets intersect.
class Reaching {
public:
    Reaching(PolygonMesh& mesh, double voxel_size, const std::vector<VertexPositions::OnCrease>& on_creases)
        : mesh_(mesh),
          voxel_size_(voxel_size),
          was_(mesh.positions.size()),
          moved_(mesh.positions.size(), 0) {
        std::vector<std::uint8_t> wanted(mesh.positions.size(), 0);
        for (const auto& v : on_creases) wanted[v.fan] = 1;
        const FacetsAt at(mesh, wanted);
        bool any = true; // one that moves may make way for another
        for (int round = 0; round < most_rounds && any; ++round) {
            any = false;
            for (const auto& v : on_creases) any |= !moved_[v.fan] && move(v, at);
        }
    }

    const std::vector<std::uint8_t>& moved() const { return moved_; }

    /// Facets that share vertices with those that changed are looked at. False if nothing had to go back.
    bool take_back() {
        std::vector<std::uint8_t> beside(moved_.size(), 0);
        for (Index f : FacetsAt(mesh_, moved_).facets())
            for (Index v : mesh_.facet(f)) beside[v] = 1;
        const std::vector<Index> facets = FacetsAt(mesh_, beside).facets();
        bool any = false;
        for (const auto& pair : find_self_intersections(part_of(mesh_, facets)).facet_pairs)
            for (Index f : pair)
                for (Index v : mesh_.facet(facets[f])) {
                    if (!moved_[v]) continue;
                    mesh_.positions[v] = was_[v];
                    moved_[v] = 0;
                    any = true;
                }
        return any;
    }

private:
    bool move(const VertexPositions::OnCrease& to, const FacetsAt& at) {
        const Vec3 from = mesh_.positions[to.fan];
        mesh_.positions[to.fan] = to.position;
        if (!at.all_of(to.fan, [&](Index f) { return suits(f, to, from); })) {
            mesh_.positions[to.fan] = from;
            return false;
        }
        was_[to.fan] = from;
        moved_[to.fan] = 1;
        return true;
    }

    bool suits(Index facet, const VertexPositions::OnCrease& to, const Vec3& from) {
        ring_.clear();
        before_.clear();
        for (Index v : mesh_.facet(facet)) {
            const Vec3& p = mesh_.positions[v];
            before_.push_back(v == to.fan ? from : p);
            const double side = (p - to.position).norm();
            if (v != to.fan && side < nearest * voxel_size_ && side < (p - from).norm()) return false;
            ring_.push_back(p);
        }
        const Vec3 now = area_of(ring_), then = area_of(before_);
        if ((now | then) <= turn_cosine * now.norm() * then.norm()) return false;
        const double is = along(ring_, to.normals);
        return is > turn_cosine || is >= along(before_, to.normals);
    }

    PolygonMesh& mesh_;
    double voxel_size_;
    std::vector<Vec3> was_;           // per vertex, where it was if it moved
    std::vector<Vec3> ring_, before_; // of a facet
    std::vector<std::uint8_t> moved_; // per vertex
};

} // namespace

std::size_t reach_creases(PolygonMesh& mesh, double voxel_size, VertexPositions& vertices) {
    if (vertices.on_creases.empty()) return 0;
    Reaching reaching(mesh, voxel_size, vertices.on_creases);
    for (int round = 0; round < most_rounds && reaching.take_back(); ++round) {
    }
    std::size_t count = 0;
    for (const auto& v : vertices.on_creases)
        if (reaching.moved()[v.fan]) {
            vertices.is_clamped[v.fan] = 0;
            ++count;
        }
    vertices.clamped -= count;
    return count;
}

} // namespace hsdm
