#include "hsdm/completion/complete_surface.hh"

#include "hsdm/completion/completion_patch.hh"
#include "hsdm/completion/constants.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/fill_holes.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

/// The sides of the mesh's boundary loops.
std::vector<std::array<Index, 2>> sides_of(const BoundaryLoops& loops) {
    std::vector<std::array<Index, 2>> sides;
    for (std::size_t l = 0; l < loops.size(); ++l)
        for (std::size_t i = 0; i < loops[l].size(); ++i)
            sides.push_back({loops[l][i], loops[l][(i + 1) % loops[l].size()]});
    return sides;
}

/// Unit normals of a patch's vertices, of the quads around.
std::vector<Vec3> vertex_normals_of(const CompletionPatch& patch) {
    std::vector<Vec3> normals(patch.positions.size(), Vec3(0, 0, 0));
    for (const auto& q : patch.quads) {
        const auto& p = patch.positions;
        const Vec3 area = (p[q[2]] - p[q[0]]) % (p[q[3]] - p[q[1]]);
        for (const Index v : q) normals[v] += area;
    }
    return normals;
}

void add_samples(const std::array<Index, 4>& quad, const CompletionPatch& patch,
                 const std::vector<Vec3>& normals, CompletedPoints& points) {
    constexpr int n = completing::samples;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const double u = (i + 0.5) / n, v = (k + 0.5) / n;
            const std::array<double, 4> weight{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
            Vec3 position(0, 0, 0), normal(0, 0, 0);
            for (unsigned j = 0; j < 4; ++j) {
                position += patch.positions[quad[j]] * weight[j];
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
bool faces_inward(const PolygonMesh& mesh, std::span<const std::array<Index, 2>> border) {
    double area = 0, volume = 0, length = 0;
    const Vec3 base = mesh.positions[border[0][0]];
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const Vec3 twice = area_vector(mesh, mesh.facet(f));
        area += 0.5 * twice.norm();
        volume += twice | (mesh.positions[mesh.facet(f)[0]] - base);
    }
    for (const auto& [a, b] : border) length += (mesh.positions[b] - mesh.positions[a]).norm();
    return volume < 0 && length * length < 0.1 * 4 * std::numbers::pi * area;
}

PolygonMesh turned_over(PolygonMesh mesh) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        std::reverse(mesh.corners.begin() + mesh.first[f], mesh.corners.begin() + mesh.first[f + 1]);
    return mesh;
}

} // namespace

CompletedPoints complete_surface(const PolygonMesh& mesh, double voxel_size) {
    return complete_surface(mesh, boundary_loops(mesh), voxel_size);
}

CompletedPoints complete_surface(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size) {
    check_option(voxel_size > 0 && std::isfinite(voxel_size), "voxel_size", voxel_size, "be positive");
    Box box;
    for (const Vec3& p : mesh.positions) box.add(p);
    check_option(mesh.facet_count() == 0 || box.extent() / voxel_size < 1 << 17, "voxel_size", voxel_size,
                 "be at least the mesh's extent over 2^17");
    CompletedPoints points;
    if (loops.size() == 0) return points;
    const std::vector<std::array<Index, 2>> border = sides_of(loops);
    const bool inward = faces_inward(mesh, border);
    const auto patch_of = [&](const PolygonMesh& outward) {
        return completion_patch(completion_field(outward, border, voxel_size), outward, border);
    };
    CompletionPatch patch = inward ? patch_of(turned_over(mesh)) : patch_of(mesh);
    fair(patch);
    const std::vector<Vec3> normals = vertex_normals_of(patch);
    for (std::size_t q = 0; q < patch.quads.size(); ++q)
        if (patch.missing[q] != 0) add_samples(patch.quads[q], patch, normals, points);
    if (inward)
        for (Vec3& n : points.normals) n = -n;
    return points;
}

} // namespace hsdm
