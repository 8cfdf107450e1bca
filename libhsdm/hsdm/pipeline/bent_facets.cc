#include "hsdm/pipeline/bent_facets.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Per corner of the facets, the normal of the surface there on the facet's side of creases.
std::vector<Vec3> corner_normals(const PolygonMesh& mesh) {
    std::vector<Vec3> areas = large_vector<Vec3>(mesh.facet_count());
    std::vector<Index> facet_of = large_vector<Index>(mesh.corners.size());
    for_each_index(mesh.facet_count(), chunks::usual, [&](Index f) {
        areas[f] = area_vector(mesh, mesh.facet(f));
        std::fill(facet_of.begin() + mesh.first[f], facet_of.begin() + mesh.first[f + 1], f);
    });
    const Groups corners_at(mesh.corners, mesh.vertex_count());
    std::vector<Vec3> normals = large_vector<Vec3>(mesh.corners.size());
    for_each_index(mesh.corners.size(), chunks::usual, [&](Index c) {
        const Vec3& own = areas[facet_of[c]];
        Vec3 sum(0, 0, 0);
        for (const Index other : corners_at.of(mesh.corners[c])) {
            const Vec3& area = areas[facet_of[other]];
            if ((area | own) > angles::one_sheet * area.norm() * own.norm()) sum += area;
        }
        normals[c] = unit(sum);
    });
    return normals;
}

} // namespace

BentFacets::BentFacets(const PolygonMesh& mesh, double voxel_size)
    : mesh_(mesh), normals_(corner_normals(mesh)), voxel_size_(voxel_size) {}

void BentFacets::for_places(std::size_t f, const Put& put) const {
    const auto ring = mesh_.facet(f);
    const Vec3* normal = normals_.data() + mesh_.first[f];
    const std::size_t size = ring.size();
    const Vec3 middle = centroid(mesh_, ring);
    std::vector<double> weight(size);
    const auto place = [&](std::size_t i, double b, double c) {
        std::fill(weight.begin(), weight.end(), (1 - b - c) / static_cast<double>(size));
        weight[i] += b, weight[(i + 1) % size] += c;
        Vec3 flat(0, 0, 0), along(0, 0, 0), lift(0, 0, 0);
        for (std::size_t k = 0; k < size; ++k) flat += mesh_.positions[ring[k]] * weight[k];
        for (std::size_t k = 0; k < size; ++k) {
            lift += normal[k] * (weight[k] * ((mesh_.positions[ring[k]] - flat) | normal[k]));
            along += normal[k] * weight[k];
        }
        if (along.norm() > 0) put(flat + lift * 0.5, unit(along));
    };
    for (std::size_t i = 0; i < size; ++i) {
        const Vec3 &a = mesh_.positions[ring[i]], &b = mesh_.positions[ring[(i + 1) % size]];
        const double twice = ((a - middle) % (b - middle)).norm();
        const int n =
            std::max(1, static_cast<int>(std::ceil(std::sqrt(twice) * completing::samples / voxel_size_)));
        for (int j = 0; j < n; ++j)
            for (int k = 0; j + k < n; ++k) place(i, (j + 1.0 / 3) / n, (k + 1.0 / 3) / n);
    }
}

} // namespace hsdm
