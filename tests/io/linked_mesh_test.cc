#include "hsdm/io/linked_mesh.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/linked_exporter.hh"
#include "hsdm/io/mesh_writers.hh"
#include "hsdm/io/zip_archive.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "support/folder.hh"
#include "support/meshes.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <limits>

#include <sys/stat.h>

using namespace hsdm;

namespace {

/// A mesh and its links, with which sides are sharp; its own sharp edges tell the same.
struct Linked {
    PolygonMesh mesh;
    FacetLinks links;
    std::vector<std::uint8_t> sharp;
};

/// Of a closed mesh the facets but for some, each with one of its sides sharp now and then; vertices that
/// facets are left of have normals and properties.
Linked some_linked(const PolygonMesh& whole, double holes, double sharp, unsigned seed) {
    support::Random random(seed);
    PolygonMesh facets;
    facets.positions = whole.positions;
    for (std::size_t f = 0; f < whole.facet_count(); ++f)
        if (random.uniform(0, 1) >= holes) facets.add_facet(whole.facet(f));
    const FacetLinks old = link_facets(facets);
    Linked linked;
    PolygonMesh& mesh = linked.mesh;
    for (const Index v : old.source) mesh.positions.push_back(facets.positions[v]);
    mesh.first = facets.first, mesh.corners = old.vertex;
    linked.links = link_facets(mesh);
    linked.sharp.resize(mesh.corners.size());
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        for (Index c = mesh.first[f]; c < mesh.first[f + 1]; ++c) {
            const Index twin = linked.links.twin[c];
            if ((twin != no_index && twin < c) || random.uniform(0, 1) >= sharp) continue;
            linked.sharp[c] = 1;
            if (twin != no_index) linked.sharp[twin] = 1;
            const Index a = mesh.corners[c], b = mesh.corners[next_side(mesh, static_cast<Index>(f), c)];
            mesh.sharp_edges.push_back({std::min(a, b), std::max(a, b)});
        }
    return linked;
}

void add_rows(support::Random& random, PolygonMesh& mesh) {
    using Type = VertexProperty::Type;
    const auto add = [&](const std::string& name, Type type, double low, double high) {
        std::vector<double> values;
        for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
            values.push_back(type == Type::uint8 ? std::floor(random.uniform(low, high))
                                                 : double{static_cast<float>(random.uniform(low, high))});
        mesh.properties.push_back({name, type, values});
    };
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) mesh.normals.push_back(random.direction());
    add(level_property, Type::uint8, 4, 9);
    for (std::size_t i = 0; i < 9; ++i) add(vertex_normal_component(i), Type::float32, -1, 1);
    add(normal_count_property, Type::uint8, 1, 4);
    for (const char* name : color_properties) add(name, Type::uint8, 0, 256);
    add("height", Type::float64, 0, 7);
    std::vector<double> classes(mesh.vertex_count(), 0); // as the sharp edges have it
    for (const auto& edge : mesh.sharp_edges)
        for (const Index v : edge) classes[v] = 1;
    mesh.properties.push_back({vertex_class_property, Type::uint8, classes});
}

void check_all_formats(const Linked& linked) {
    const support::Folder folder;
    PolygonMesh facets;
    facets.positions = linked.mesh.positions;
    facets.corners = linked.mesh.corners, facets.first = linked.mesh.first;
    const VertexRows rows = rows_of(linked.mesh);
    for (const MeshFormatInfo& format : mesh_formats()) {
        INFO(format.name);
        const WriteOptions options{.unit = LengthUnit::millimetre};
        write_mesh(folder / "a", linked.mesh, format.format, options);
        write_mesh(folder / "b", LinkedMesh{facets, linked.links, linked.sharp, rows}, format.format,
                   options);
        CHECK((support::read_file(folder / "a") == support::read_file(folder / "b"))); // not told: megabytes
    }
    CHECK(folder.names() == std::set<std::string>{"a", "b"});
}

} // namespace

TEST_CASE("a linked mesh is written as the mesh that it is, in every format", "[io]") {
    const double holes = GENERATE(0.0, 0.2), sharp = GENERATE(0.0, 0.3, 1.0);
    const bool with_rows = GENERATE(false, true);
    INFO(holes << " of the facets missing, " << sharp << " of the edges sharp, rows: " << with_rows);
    Linked linked = some_linked(support::divided_sphere(30), holes, sharp, 5);
    REQUIRE(linked.mesh.vertex_count() > 4096); // so that there are several stretches
    support::Random random(6);
    if (with_rows) add_rows(random, linked.mesh);
    check_all_formats(linked);
}

TEST_CASE("numbers of half-edges are those of to_mesh, and lead back to the sides", "[io]") {
    const Linked linked = some_linked(support::divided_cube(7), GENERATE(0.0, 0.4), 0, 3);
    const EdgeNumbers numbers(linked.links.twin);
    std::vector<Index> found;
    for (Index side = 0; side < linked.links.twin.size(); ++side) {
        const Index twin = linked.links.twin[side], half_edge = numbers.half_edge(side);
        CHECK(numbers.first_side(half_edge / 2) == std::min(side, twin)); // no_index is the largest
        if (twin != no_index) CHECK(numbers.half_edge(twin) == (half_edge ^ 1u));
        if (twin == no_index || side < twin) found.push_back(half_edge / 2);
    }
    CHECK(found.size() == numbers.edges());
    CHECK(std::ranges::is_sorted(found));
    CHECK(EdgeNumbers({}).edges() == 0);
}

TEST_CASE("3MF into a pipe is the file", "[io]") {
    const support::Folder folder;
    const std::string pipe = folder / "pipe";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    const PolygonMesh mesh = support::divided_sphere(80);
    REQUIRE(mesh.vertex_count() > std::size_t{1} << 15); // more than a stretch
    write_mesh(folder / "one", mesh, MeshFormat::mf3);
    std::future<std::string> read = std::async(std::launch::async, [&] { return support::read_file(pipe); });
    write_mesh(pipe, mesh, MeshFormat::mf3);
    CHECK(read.get() == support::read_file(folder / "one"));
}

TEST_CASE("what a member of an archive throws comes through, and no file is left", "[io]") {
    const support::Folder folder;
    std::atomic<int> made = 0;
    LongText text;
    text.add("begin");
    text.add(3, [&](std::string& out, std::size_t begin, std::size_t end) {
        if (++made > 1) throw Cancelled(); // the first time is for its size
        out.append(end - begin, 'x');
    });
    const std::string path = folder / "a.zip";
    AtomicFile file(path);
    CHECK_THROWS_AS(io::write_zip(file, path, {{"a", text}}), Cancelled);
    CHECK(made == 2);
    CHECK_THROWS_AS(file.write_at(std::uint64_t{1} << 63, "x"), Error); // which no file has room for
}

TEST_CASE("an archive that its file has no room for is refused", "[io]") {
    LongText text;
    text.add("begin");
    AtomicFile file("/dev/full");
    CHECK_THROWS_WITH(io::write_zip(file, "/dev/full", {{"a", text}}), Catch::Contains("cannot write"));
}

TEST_CASE("a linked mesh of more vertices than are made at once is written in every format", "[io][slow]") {
    Linked linked = some_linked(support::divided_sphere(110), 0.02, 0.1, 7);
    REQUIRE(linked.mesh.vertex_count() > std::size_t{1} << 16);
    support::Random random(8);
    add_rows(random, linked.mesh);
    check_all_formats(linked);
}

TEST_CASE("a linked mesh without facets is one in every format, or refused as any", "[io]") {
    const support::Folder folder;
    const PolygonMesh none;
    const FacetLinks links;
    const VertexRows rows;
    for (const MeshFormatInfo& format : mesh_formats()) {
        INFO(format.name);
        const LinkedMesh linked{none, links, {}, rows};
        if (format.format == MeshFormat::glb || format.format == MeshFormat::mf3) {
            CHECK_THROWS_AS(write_mesh(folder / "b", linked, format.format), Error);
            continue;
        }
        write_mesh(folder / "a", none, format.format);
        write_mesh(folder / "b", linked, format.format);
        CHECK(support::read_file(folder / "a") == support::read_file(folder / "b"));
    }
}

TEST_CASE("OpenMesh's format refuses what it would number wrongly", "[io]") {
    const std::size_t most = std::numeric_limits<int>::max();
    CHECK_NOTHROW(check_sizes("a.om", {most, most, most / 2, 0xffffffff}));
    CHECK_THROWS_WITH(check_sizes("a.om", {9, 9, most / 2 + 1, 0}), Catch::Contains("half-edges"));
    CHECK_THROWS_WITH(check_sizes("a.om", {most + 1, 9, 9, 0}), Catch::Contains("write PLY"));
    CHECK_THROWS_WITH(check_sizes("a.om", {9, 9, 9, std::size_t{1} << 32}), Catch::Contains("4 GiB"));
}
