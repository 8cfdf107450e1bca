#include "hsdm/simplify/facet_field.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/edge_table.hh"
#include "hsdm/simplify/constants.hh"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

void measure_facets(const PolygonMesh& mesh, FacetField& field) {
    resize_large(field.area, mesh.facet_count());
    resize_large(field.centre, field.size());
    resize_large(field.normal, field.size());
    for_each_index(field.size(), chunks::usual, [&](Index f) {
        const auto ring = mesh.facet(f);
        field.area[f] = area_vector(mesh, ring);
        field.normal[f] = unit(field.area[f]);
        field.centre[f] = centroid(mesh, ring);
    });
}

void link_facets(const PolygonMesh& mesh, FacetField& field) {
    std::vector<Index> facet_of = large_vector<Index>(mesh.corners.size());
    for_each_index(field.size(), chunks::usual, [&](Index f) {
        std::fill(facet_of.begin() + mesh.first[f], facet_of.begin() + mesh.first[f + 1], f);
    });
    assign_large(field.beside, mesh.corners.size(), no_index);
    EdgeTable(mesh).for_edges([&](Index, std::span<const EdgeSide> edge, std::size_t) {
        if (edge.size() != 2) return;
        const Index a = edge[0].side, b = edge[1].side, f = facet_of[a], g = facet_of[b];
        if ((field.normal[f] | field.normal[g]) > angles::smooth) field.beside[a] = g, field.beside[b] = f;
    });
}

void gather_normals(FacetField& field) {
    std::vector<double> bend = large_vector<double>(field.size()), wider_bend = copy_of_large(bend);
    std::vector<NormalSum> wider = large_vector<NormalSum>(field.size());
    resize_large(field.around, field.size());
    for_each_index(field.size(), chunks::usual, [&](Index f) {
        field.around[f].add(field.normal[f], field.area[f].norm());
        field.for_beside(f, [&](Index g) {
            bend[f] += (field.normal[g] - field.normal[f]) | (field.centre[g] - field.centre[f]);
        });
    });
    for (int away = 0; away < surroundings::most_sides_away; ++away) {
        for_each_index(field.size(), chunks::usual, [&](Index f) {
            wider[f] = field.around[f];
            wider_bend[f] = bend[f];
            field.for_beside(f, [&](Index g) {
                wider[f] += field.around[g];
                wider_bend[f] += bend[g];
            });
        });
        field.around.swap(wider);
        bend.swap(wider_bend);
    }
    resize_large(field.convex, field.size());
    for_each_index(field.size(), chunks::usual, [&](Index f) { field.convex[f] = bend[f] > 0; });
}

void measure_bend(FacetField& field) {
    resize_large(field.spread, field.size());
    resize_large(field.next_spread, field.size());
    resize_large(field.mean_normal, field.size());
    for_each_index(field.size(), chunks::usual, [&](Index f) {
        const std::array<double, 3> deviation = field.around[f].deviation();
        field.spread[f] = deviation[2];
        field.next_spread[f] = deviation[1];
        field.mean_normal[f] = unit(field.around[f].mean());
    });
}

} // namespace

void NormalSum::add(const Vec3& normal, double weight) {
    sum_ += normal * weight;
    std::size_t k = 0;
    for (unsigned i = 0; i < 3; ++i)
        for (unsigned j = i; j < 3; ++j) squares_[k++] += weight * normal[i] * normal[j];
    weight_ += weight;
}

NormalSum& NormalSum::operator+=(const NormalSum& other) {
    sum_ += other.sum_;
    for (std::size_t k = 0; k < 6; ++k) squares_[k] += other.squares_[k];
    weight_ += other.weight_;
    return *this;
}

Variation NormalSum::about(const Vec3& centre, bool with_directions) const {
    Variation variation{{0, 0, 0}, {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}};
    if (!(weight_ > 0)) return variation;
    const Eigen::Vector3d c(centre[0], centre[1], centre[2]);
    Eigen::Matrix3d m;
    m << squares_[0], squares_[1], squares_[2], squares_[1], squares_[3], squares_[4], squares_[2],
        squares_[4], squares_[5];
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(m / weight_ - c * c.transpose(),
                        with_directions ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
    for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        variation.deviation[i] = std::sqrt(std::max(0.0, eigen.eigenvalues()[k]));
        if (!with_directions) continue;
        const Eigen::Vector3d direction = eigen.eigenvectors().col(k);
        variation.direction[i] = {direction[0], direction[1], direction[2]};
    }
    return variation;
}

FacetField facet_field(const PolygonMesh& mesh) {
    FacetField field;
    field.first = mesh.first;
    measure_facets(mesh, field);
    link_facets(mesh, field);
    gather_normals(field);
    measure_bend(field);
    return field;
}

} // namespace hsdm
