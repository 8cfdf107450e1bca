#include "hsdm/completion/complete_surface.hh"

#include "hsdm/completion/bores.hh"
#include "hsdm/completion/completion_patch.hh"
#include "hsdm/completion/constants.hh"
#include "hsdm/completion/continued_space.hh"
#include "hsdm/completion/slits.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/turn_outward.hh"

#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

void add_samples(std::span<const Index> quad, const CompletionPatch& patch, const std::vector<Vec3>& normals,
                 CompletedPoints& points) {
    constexpr int n = completing::samples;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const double u = (i + 0.5) / n, v = (k + 0.5) / n;
            const std::array<double, 4> weight{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
            Vec3 position(0, 0, 0), normal(0, 0, 0);
            for (unsigned j = 0; j < 4; ++j) {
                position += patch.net.positions[quad[j]] * weight[j];
                normal += normals[quad[j]] * weight[j];
            }
            const double length = normal.norm();
            if (!(length > 0)) continue;
            points.positions.push_back(position);
            points.normals.push_back(normal / length);
        }
}

/// Does a mesh that is nearly closed face inward? Of others nobody can say. Nearly: discs as long around as
/// its border would be less than a tenth of its area.
bool faces_inward(const PolygonMesh& mesh, const BoundaryLoops& border) {
    double area = 0, volume = 0, length = 0;
    const Vec3 base = mesh.positions[border[0][0]];
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const Vec3 twice = area_vector(mesh, mesh.facet(f));
        area += 0.5 * twice.norm();
        volume += twice | (mesh.positions[mesh.facet(f)[0]] - base);
    });
    for (std::size_t l = 0; l < border.size(); ++l) length += length_of(mesh, border[l]);
    return volume < 0 && length * length < 0.1 * 4 * std::numbers::pi * area;
}

/// A mesh with the walls of its bores, and the loops that are left then.
struct JoinedMesh {
    PolygonMesh mesh;
    BoundaryLoops loops;

    JoinedMesh(const PolygonMesh& open, const BoundaryLoops& all, const Bores& bores) : mesh(open) {
        const auto first = static_cast<Index>(mesh.vertex_count());
        append_large(mesh.positions, bores.walls.positions);
        for (std::size_t f = 0; f < bores.walls.facet_count(); ++f) {
            const auto facet = bores.walls.facet(f);
            mesh.add_facet(std::array{first + facet[0], first + facet[1], first + facet[2]});
        }
        std::vector<std::uint8_t> joined(all.size());
        for (const Index l : bores.loops) joined[l] = 1;
        for (std::size_t l = 0; l < all.size(); ++l) {
            if (joined[l] != 0) continue;
            for (Index i = all.begin[l]; i < all.begin[l + 1]; ++i) {
                loops.vertices.push_back(all.vertices[i]);
                loops.facets.push_back(all.facets[i]);
            }
            loops.begin.push_back(static_cast<Index>(loops.vertices.size()));
        }
    }
};

/// Adds points of the surface that closes a mesh, facets outward.
void add_completing(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size,
                    const CompleteOptions& options, const KnownSpace& seen, CompletedPoints& points) {
    if (loops.size() == 0) return;
    // Where facets face inward what goes on from them is no bore of the part.
    const ContinuedSpace continued =
        seen.outside ? ContinuedSpace(mesh, loops, voxel_size) : ContinuedSpace();
    KnownSpace space = seen;
    if (!continued.empty())
        space.holds = [&](const Vec3& p) { return (seen.holds && seen.holds(p)) || continued.holds(p); };
    CompletionPatch patch =
        completion_patch(completion_field(mesh, loops, voxel_size, space, options.most_bytes), mesh, loops);
    if (options.passing == Passing::stopped)
        fair_beside(mesh, patch, space);
    else
        fair(patch, space);
    const std::vector<Vec3> normals = vertex_area_vectors(patch.net);
    for (std::size_t q = 0; q < patch.net.facet_count(); ++q)
        if (patch.missing[q] != 0) add_samples(patch.net.facet(q), patch, normals, points);
}

} // namespace

CompletedPoints complete_surface(const PolygonMesh& mesh, double voxel_size) {
    return complete_surface(mesh, boundary_loops(mesh), voxel_size);
}

CompletedPoints complete_surface(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size,
                                 const CompleteOptions& options) {
    const std::function<bool(const Vec3&)>& empty = options.empty;
    check_option(voxel_size > 0 && std::isfinite(voxel_size), "voxel_size", voxel_size, "be positive");
    Box box;
    for (const Vec3& p : mesh.positions) box.add(p);
    check_option(mesh.facet_count() == 0 || box.extent() / voxel_size < 1 << 17, "voxel_size", voxel_size,
                 "be at least the mesh's extent over 2^17");
    CompletedPoints points;
    if (loops.size() == 0) return points;
    const bool inward = faces_inward(mesh, loops);
    PolygonMesh turned;
    if (inward) turn_over(turned = mesh);
    const PolygonMesh& outward = inward ? turned : mesh;
    // Beyond a mesh that faces inward is what it is in; who looks in from there sees no room.
    const auto within = [&](const Vec3& p) {
        for (unsigned k = 0; k < 3; ++k)
            if (p[k] < box.lo[k] || p[k] > box.hi[k]) return false;
        return empty(p);
    };
    const KnownSpace space{inward && empty ? std::function<bool(const Vec3&)>(within) : empty, !inward};
    const BoundaryLoops turned_loops = inward ? boundary_loops(turned) : BoundaryLoops();
    const BoundaryLoops& border = inward ? turned_loops : loops;
    // A wall of a bore may pass through the mesh as well.
    const bool may_pass = options.passing == Passing::ignored;
    const Bores bores = may_pass ? find_bores(outward, border, voxel_size, space.holds) : Bores();
    if (bores.loops.empty()) {
        add_completing(outward, border, voxel_size, options, space, points);
    } else {
        points = points_across(bores.walls, voxel_size);
        const JoinedMesh joined(outward, border, bores);
        add_completing(joined.mesh, joined.loops, voxel_size, options, space, points);
    }
    if (inward)
        for (Vec3& n : points.normals) n = -n;
    return points;
}

} // namespace hsdm
