#include "hsdm/completion/lattice.hh"

#include "hsdm/core/parallel_sort.hh"

#include <cmath>
#include <tuple>

namespace hsdm {
namespace {

/// The hits of one triangle, in grid coordinates.
class TriangleHits {
public:
    TriangleHits(const Lattice& lattice, std::vector<LatticeHit>& hits) : lattice_(lattice), hits_(hits) {}

    void add(const std::array<Vec3, 3>& corners) {
        const Vec3 area = (corners[1] - corners[0]) % (corners[2] - corners[0]);
        const double size = area.norm();
        if (!(size > 0)) return;
        for (unsigned axis = 0; axis < 3; ++axis)
            if (area[axis] != 0) along(axis, corners, area * (1 / size));
    }

private:
    void along(unsigned axis, const std::array<Vec3, 3>& p, const Vec3& normal) {
        const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto range = [&](unsigned k) {
            const double lo = std::min({p[0][k], p[1][k], p[2][k]}),
                         hi = std::max({p[0][k], p[1][k], p[2][k]});
            return std::pair(static_cast<int>(std::ceil(std::max(lo, 0.0))),
                             static_cast<int>(std::floor(std::min<double>(hi, lattice_.place.last[k]))));
        };
        const auto [u_lo, u_hi] = range(u);
        const auto [v_lo, v_hi] = range(v);
        for (int i = u_lo; i <= u_hi; ++i) {
            const auto [lowest, highest] = reach_at(i, u, v, p);
            const int k_lo = static_cast<int>(std::max<double>(v_lo, std::floor(lowest) - 1)),
                      k_hi = static_cast<int>(std::min<double>(v_hi, std::ceil(highest) + 1));
            for (int k = k_lo; k <= k_hi; ++k) {
                std::array<double, 3> weight;
                for (unsigned j = 0; j < 3; ++j) {
                    const Vec3 &a = p[(j + 1) % 3], &b = p[(j + 2) % 3];
                    weight[j] = (a[u] - i) * (b[v] - k) - (a[v] - k) * (b[u] - i);
                }
                if (const auto [lo, hi] = std::minmax({weight[0], weight[1], weight[2]}); lo < 0 && hi > 0)
                    continue;
                const double sum = weight[0] + weight[1] + weight[2];
                if (sum == 0) continue;
                const double at =
                    (weight[0] * p[0][axis] + weight[1] * p[1][axis] + weight[2] * p[2][axis]) / sum;
                VoxelCoord lower;
                lower[axis] = static_cast<int>(std::floor(at)), lower[u] = i, lower[v] = k;
                const Index point = lattice_.find(lower);
                if (point != no_index) hits_.push_back({3 * point + axis, at - std::floor(at), normal});
            }
        }
    }

    /// From where to where along v the triangle lies at a place along u; of sides that hardly lead along u
    /// all.
    static std::pair<double, double> reach_at(double at, unsigned u, unsigned v,
                                              const std::array<Vec3, 3>& p) {
        std::pair<double, double> reach(Box::inf, -Box::inf);
        const auto add = [&](double place) {
            reach.first = std::min(reach.first, place), reach.second = std::max(reach.second, place);
        };
        for (unsigned j = 0; j < 3; ++j) {
            const Vec3 &a = p[j], &b = p[(j + 1) % 3];
            if (const auto [lo, hi] = std::minmax(a[u], b[u]); at < lo || at > hi) continue;
            if (std::abs(b[u] - a[u]) < 1e-6) // nothing that rounding could blur
                add(a[v]), add(b[v]);
            else
                add(a[v] + (at - a[u]) / (b[u] - a[u]) * (b[v] - a[v]));
        }
        return reach;
    }

    const Lattice& lattice_;
    std::vector<LatticeHit>& hits_;
};

void sort_hits(std::vector<LatticeHit>& hits) {
    parallel_sort(hits, [](const LatticeHit& a, const LatticeHit& b) {
        const auto key = [](const LatticeHit& h) {
            return std::tuple(h.edge, h.t, h.normal[0], h.normal[1], h.normal[2]);
        };
        return key(a) < key(b);
    });
}

} // namespace

void dilate(const LatticePlace& place, int radius, std::vector<MortonCode>& codes) {
    parallel_sort_unique(codes);
    for (unsigned axis = 0; axis < 3; ++axis) {
        const std::size_t before = codes.size();
        for (std::size_t i = 0; i < before; ++i)
            for (int step = -radius; step <= radius; ++step) {
                VoxelCoord c = morton_decode(codes[i]);
                c[axis] += step;
                if (step != 0 && place.holds(c)) codes.push_back(morton_encode(c));
            }
        parallel_sort_unique(codes);
    }
}

std::vector<MortonCode> all_points(const LatticePlace& place) {
    std::vector<MortonCode> codes;
    for (int z = 0; z <= place.last[2]; ++z)
        for (int y = 0; y <= place.last[1]; ++y)
            for (int x = 0; x <= place.last[0]; ++x) codes.push_back(morton_encode(VoxelCoord{x, y, z}));
    parallel_sort_unique(codes);
    return codes;
}

std::vector<LatticeHit> find_hits(const Lattice& lattice, const PolygonMesh& mesh) {
    return collected<LatticeHit>(
        mesh.facet_count(), chunks::usual,
        [&](std::size_t begin, std::size_t end, std::vector<LatticeHit>& part) {
            TriangleHits triangles(lattice, part);
            const auto at = [&](Index vertex) { return lattice.place.local(mesh.positions[vertex]); };
            for (std::size_t f = begin; f < end; ++f) {
                const auto corners = mesh.facet(f);
                for (std::size_t c = 2; c < corners.size(); ++c)
                    triangles.add({at(corners[0]), at(corners[c - 1]), at(corners[c])});
            }
        });
}

Lattice build_lattice(const LatticePlace& place, std::vector<MortonCode> codes, const PolygonMesh& mesh) {
    Lattice lattice{place, std::move(codes), {}, {}, {}, {}};
    lattice.index.build(lattice.codes);
    resize_large(lattice.next, lattice.size());
    for_each_index(lattice.size(), chunks::usual, [&](Index i) {
        for (unsigned way = 0; way < 6; ++way) {
            VoxelCoord c = lattice.coord(i);
            c[way % 3] += way < 3 ? 1 : -1;
            lattice.next[i][way] = lattice.find(c);
        }
    });
    lattice.hits = find_hits(lattice, mesh);
    sort_hits(lattice.hits);
    assign_large(lattice.first_hit, 3 * lattice.size() + 1, Index(0));
    for (const LatticeHit& hit : lattice.hits) ++lattice.first_hit[hit.edge + 1];
    counts_to_first(lattice.first_hit);
    return lattice;
}

} // namespace hsdm
