// cgal_peers METHOD POINTS MESH [LENGTH]: the reconstructions of CGAL that docs/performance.md compares with.
//
// Methods: `advancing-front`, `scale-space`, `poisson`. LENGTH of `poisson` is the edge of hsdm's voxels.
// POINTS is a PLY file with normals, MESH a PLY file.
//
// This file is ours, under the licence of the project. The headers of CGAL that it includes are under the
// GPL, so a program built from it is, too: peers.py builds it for measurements where libcgal-dev is
// installed. It is no target of the project, it is never installed nor packaged, and nothing links it.
#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/read_points.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_items_with_id_3.h>
#include <CGAL/Scale_space_reconstruction_3/Advancing_front_mesher.h>
#include <CGAL/Scale_space_reconstruction_3/Jet_smoother.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/poisson_surface_reconstruction.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using PointNormal = std::pair<Point, Kernel::Vector_3>;
using Facet = std::array<std::size_t, 3>;

struct Soup {
    std::vector<Point> points;
    std::vector<Facet> facets;
};

std::vector<PointNormal> read(const std::string& path) {
    std::vector<PointNormal> points;
    const auto maps = CGAL::parameters::point_map(CGAL::First_of_pair_property_map<PointNormal>())
                          .normal_map(CGAL::Second_of_pair_property_map<PointNormal>());
    if (!CGAL::IO::read_points(path, std::back_inserter(points), maps) || points.empty())
        throw std::runtime_error(path + ": no points");
    return points;
}

std::vector<Point> positions_of(const std::vector<PointNormal>& points) {
    std::vector<Point> positions;
    positions.reserve(points.size());
    for (const PointNormal& p : points) positions.push_back(p.first);
    return positions;
}

Soup advancing_front(const std::vector<PointNormal>& points) {
    Soup soup{positions_of(points), {}};
    CGAL::advancing_front_surface_reconstruction(soup.points.begin(), soup.points.end(),
                                                 std::back_inserter(soup.facets));
    return soup;
}

/// Four rounds of jet smoothing, then an advancing front: the manual's own example.
Soup scale_space(const std::vector<PointNormal>& points) {
    const std::vector<Point> positions = positions_of(points);
    CGAL::Scale_space_surface_reconstruction_3<Kernel> reconstruct(positions.begin(), positions.end());
    reconstruct.increase_scale(4, CGAL::Scale_space_reconstruction_3::Jet_smoother<Kernel>());
    reconstruct.reconstruct_surface(CGAL::Scale_space_reconstruction_3::Advancing_front_mesher<Kernel>(0.5));
    Soup soup;
    soup.points.assign(reconstruct.points_begin(), reconstruct.points_end()); // as they were read
    soup.facets.assign(reconstruct.facets_begin(), reconstruct.facets_end());
    return soup;
}

/// Its triangles' circumcircles are at most as large as those of half a voxel's face, its defaults otherwise.
Soup poisson(std::vector<PointNormal> points, double voxel) {
    const double spacing = CGAL::compute_average_spacing<CGAL::Parallel_if_available_tag>(
        points, 6, CGAL::parameters::point_map(CGAL::First_of_pair_property_map<PointNormal>()));
    constexpr double angle = 20, radius_of_voxel = 0.7071, distance = 0.375;
    CGAL::Polyhedron_3<Kernel, CGAL::Polyhedron_items_with_id_3> mesh;
    if (!CGAL::poisson_surface_reconstruction_delaunay(
            points.begin(), points.end(), CGAL::First_of_pair_property_map<PointNormal>(),
            CGAL::Second_of_pair_property_map<PointNormal>(), mesh, spacing, angle,
            radius_of_voxel * voxel / spacing, distance))
        throw std::runtime_error("poisson_surface_reconstruction_delaunay failed");
    Soup soup;
    std::size_t number = 0;
    for (auto v = mesh.vertices_begin(); v != mesh.vertices_end(); ++v) {
        v->id() = number++;
        soup.points.push_back(v->point());
    }
    for (auto f = mesh.facets_begin(); f != mesh.facets_end(); ++f) {
        const auto h = f->halfedge();
        soup.facets.push_back(
            {h->vertex()->id(), h->next()->vertex()->id(), h->next()->next()->vertex()->id()});
    }
    return soup;
}

template <class T>
void put(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Binary, as hsdm writes its own.
void write(const std::string& path, const Soup& soup) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(soup.points.size())
        + "\nproperty double x\nproperty double y\nproperty double z\nelement face "
        + std::to_string(soup.facets.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Point& p : soup.points)
        for (int k = 0; k < 3; ++k) put(bytes, p[k]);
    for (const Facet& f : soup.facets) {
        bytes.push_back(3);
        for (const std::size_t v : f) put(bytes, static_cast<int>(v));
    }
    std::ofstream file(path, std::ios::binary);
    if (!file.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush())
        throw std::runtime_error(path + ": cannot be written");
}

Soup run(const std::string& method, const std::vector<PointNormal>& points, double length) {
    if (method == "advancing-front") return advancing_front(points);
    if (method == "scale-space") return scale_space(points);
    if (method == "poisson" && length > 0) return poisson(points, length);
    throw std::runtime_error(method + ": no method, or no length");
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::cerr << "usage: cgal_peers advancing-front|scale-space|poisson POINTS MESH [LENGTH]\n";
        return 2;
    }
    try {
        write(argv[3], run(argv[1], read(argv[2]), argc > 4 ? std::atof(argv[4]) : 0));
    } catch (const std::exception& error) {
        std::cerr << "cgal_peers: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
