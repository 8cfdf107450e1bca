#include "hsdm/stages/pair_triangles.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/mesh/facet_normal.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace hsdm {
namespace {

struct TrianglePair {
    double skew = 0;
    OpenMesh::EdgeHandle edge;
};

/// The greatest difference of a quad's corners from right angles, as seen along its area vector; at least a
/// right angle if it is not convex.
double skew_of(const std::array<Vec3, 4>& quad) {
    const Vec3 axis = unit_or_zero((quad[2] - quad[0]) % (quad[3] - quad[1]));
    double skew = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 out = quad[(i + 1) % 4] - quad[i], in = quad[(i + 3) % 4] - quad[i];
        const double corner = std::atan2((out % in) | axis, out | in);
        skew = std::max(skew, corner > 0 ? std::abs(corner - std::numbers::pi / 2) : std::numbers::pi / 2);
    }
    return skew;
}

std::vector<TrianglePair> possible_pairs(const PolyMesh& mesh, const PairingOptions& options) {
    std::vector<TrianglePair> pairs;
    for (const auto e : mesh.edges()) {
        if (e.is_boundary() || e.feature() || e.h0().face().valence() != 3 || e.h1().face().valence() != 3)
            continue;
        const std::array<Vec3, 4> quad{mesh.point(e.v0()), mesh.point(e.h1().next().to()), mesh.point(e.v1()),
                                       mesh.point(e.h0().next().to())};
        const Vec3 left = (quad[2] - quad[0]) % (quad[3] - quad[0]),
                   right = (quad[1] - quad[0]) % (quad[2] - quad[0]);
        if (angle_between(left, right) > options.max_bend) continue;
        const double skew = skew_of(quad);
        if (skew < options.max_skew) pairs.push_back({skew, e});
    }
    return pairs;
}

} // namespace

std::size_t pair_triangles(PolyMesh& mesh, const PairingOptions& options) {
    check_option(options.max_bend > 0 && options.max_bend < std::numbers::pi, "max_bend", options.max_bend,
                 "lie in (0, pi), in radians");
    check_option(options.max_skew > 0 && options.max_skew <= std::numbers::pi / 2, "max_skew",
                 options.max_skew, "lie in (0, pi/2], in radians");
    std::vector<TrianglePair> pairs = possible_pairs(mesh, options);
    std::sort(pairs.begin(), pairs.end(), [](const TrianglePair& a, const TrianglePair& b) {
        return a.skew != b.skew ? a.skew < b.skew : a.edge < b.edge;
    });
    std::size_t quads = 0;
    for (const TrianglePair& pair : pairs) {
        const OpenMesh::SmartEdgeHandle e = OpenMesh::make_smart(pair.edge, mesh);
        const bool are_free = e.h0().face().valence() == 3 && e.h1().face().valence() == 3;
        if (!are_free || !mesh.is_simple_link(e)) continue;
        mesh.set_normal(mesh.remove_edge(e), Vec3(0, 0, 0));
        ++quads;
    }
    mesh.garbage_collection();
    mesh.update_face_normals();
    return quads;
}

} // namespace hsdm
