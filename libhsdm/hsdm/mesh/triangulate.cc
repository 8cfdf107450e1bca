#include "hsdm/mesh/triangulate.hh"

#include "hsdm/core/chunks.hh"

namespace hsdm {
namespace {

/// Corners looked at before a polygon's remaining ears are given up and fanned: bounds the time that a
/// polygon of 10^5 corners may take.
constexpr std::size_t ear_budget = std::size_t{1} << 26;

Vec3 normal(const std::vector<Vec3>& p, Index a, Index b, Index c) {
    return (p[b] - p[a]) % (p[c] - p[a]);
}

void cut_quad(const std::vector<Vec3>& p, std::span<const Index> f, Triangle* out) {
    const Vec3 from1 = p[f[1]] - p[f[0]], from2 = p[f[2]] - p[f[0]], from3 = p[f[3]] - p[f[0]];
    const Vec3 across = p[f[3]] - p[f[1]];
    const bool flat02 = ((from1 % from2) | (from2 % from3)) > 0;
    const bool flat13 = ((from1 % from3) | ((p[f[2]] - p[f[1]]) % across)) > 0;
    const bool along02 = flat02 != flat13 ? flat02 : from2.sqrnorm() <= across.sqrnorm();
    out[0] = along02 ? Triangle{f[0], f[1], f[2]} : Triangle{f[0], f[1], f[3]};
    out[1] = along02 ? Triangle{f[0], f[2], f[3]} : Triangle{f[1], f[2], f[3]};
}

/// Cuts ears off one polygon.
class EarCutter {
public:
    EarCutter(const std::vector<Vec3>& positions, std::span<const Index> facet)
        : p_(positions), ring_(facet.begin(), facet.end()) {
        for (std::size_t i = 1; i + 1 < ring_.size(); ++i)
            axis_ += normal(p_, ring_[0], ring_[i], ring_[i + 1]);
    }

    void run(Triangle* out) {
        while (ring_.size() > 3) {
            const std::size_t ear = best_ear();
            if (ear == ring_.size()) break;
            *out++ = {before(ear), ring_[ear], after(ear)};
            ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        for (std::size_t i = 1; i + 1 < ring_.size(); ++i) *out++ = {ring_[0], ring_[i], ring_[i + 1]};
    }

private:
    Index before(std::size_t i) const { return ring_[i == 0 ? ring_.size() - 1 : i - 1]; }
    Index after(std::size_t i) const { return ring_[i + 1 == ring_.size() ? 0 : i + 1]; }
    double turn(Index a, Index b, Index c) const { return axis_ | normal(p_, a, b, c); }

    bool is_empty(Index a, Index b, Index c) {
        looked_at_ += ring_.size();
        for (Index q : ring_)
            if (q != a && q != b && q != c && turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0)
                return false;
        return true;
    }

    /// Position of the ear with the shortest cut, of the first ear in a long ring; ring_.size() if there is
    /// none.
    std::size_t best_ear() {
        std::size_t best = ring_.size();
        double shortest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < ring_.size() && looked_at_ < ear_budget; ++i) {
            const Index a = before(i), b = ring_[i], c = after(i);
            const double length = (p_[c] - p_[a]).sqrnorm();
            if (length >= shortest || !(turn(a, b, c) > 0) || !is_empty(a, b, c)) continue;
            best = i;
            shortest = length;
            if (ring_.size() > 64) break;
        }
        return best;
    }

    const std::vector<Vec3>& p_;
    std::vector<Index> ring_;
    Vec3 axis_{0, 0, 0};
    std::size_t looked_at_ = 0;
};

void cut(const std::vector<Vec3>& positions, std::span<const Index> facet, Triangle* out) {
    if (facet.size() == 3)
        *out = {facet[0], facet[1], facet[2]};
    else if (facet.size() == 4)
        cut_quad(positions, facet, out);
    else if (facet.size() > 4)
        EarCutter(positions, facet).run(out);
}

} // namespace

void append_triangles(const PolygonMesh& mesh, std::size_t facet, std::vector<Triangle>& triangles) {
    const std::size_t before = triangles.size(), corners = mesh.facet(facet).size();
    triangles.resize(before + (corners < 3 ? 0 : corners - 2));
    cut(mesh.positions, mesh.facet(facet), triangles.data() + before);
}

Triangulation triangulate(const PolygonMesh& mesh) {
    const std::size_t facets = mesh.facet_count();
    Triangulation result;
    assign_large(result.first, facets + 1, 0);
    for_each_in_order(facets, [&](std::size_t f) {
        const Index corners = mesh.first[f + 1] - mesh.first[f];
        result.first[f + 1] = result.first[f] + (corners < 3 ? 0 : corners - 2);
    });
    resize_unwritten(result.triangles, result.first.back());
    for_each_index(facets, chunks::quick, [&](Index f) {
        cut(mesh.positions, mesh.facet(f), result.triangles.data() + result.first[f]);
    });
    return result;
}

std::vector<Index> facet_of_triangle(const Triangulation& triangulation) {
    std::vector<Index> facet = large_vector<Index>(triangulation.size());
    for_each_index(triangulation.first.size() - 1, chunks::quick, [&](Index f) {
        std::fill(facet.begin() + triangulation.first[f], facet.begin() + triangulation.first[f + 1], f);
    });
    return facet;
}

} // namespace hsdm
