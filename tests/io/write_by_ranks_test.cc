#include "hsdm/io/write_by_ranks.hh"

#include "hsdm/io/mesh_writers.hh"
#include "support/folder.hh"
#include "support/meshes.hh"
#include "support/rank_threads.hh"

#include <catch2/catch.hpp>

#include <atomic>
#include <cmath>
#include <future>

#include <sys/stat.h>

using namespace hsdm;

namespace {

/// Triangles, quads and a larger polygon, with normals and a property of each type, if asked for.
PolygonMesh some_mesh(Index n, bool with_rows, double far) {
    PolygonMesh mesh = support::divided_sphere(n);
    mesh.add_facet(std::array<Index, 3>{0, 1, 2});
    mesh.add_facet(std::array<Index, 5>{5, 3, 1, 7, 9});
    for (Vec3& p : mesh.positions) p += Vec3(far, 2, -far);
    if (!with_rows) return mesh;
    mesh.normals = mesh.positions;
    using Type = VertexProperty::Type;
    for (const Type type : {Type::uint8, Type::int32, Type::float32, Type::float64}) {
        std::vector<double> values;
        for (const Vec3& p : mesh.positions)
            values.push_back(type == Type::uint8 || type == Type::int32 ? std::floor(100 * std::abs(p[1] - 2))
                                                                        : p[1]);
        mesh.properties.push_back({"p" + std::to_string(static_cast<int>(type)), type, values});
    }
    return mesh;
}

PolygonMesh bare(const PolygonMesh& mesh) {
    PolygonMesh facets;
    facets.positions = mesh.positions, facets.corners = mesh.corners, facets.first = mesh.first;
    return facets;
}

/// Of a mesh without links, which these formats do not read; act(mesh), whose rows and facets are its.
template <class Act>
auto with_linked(const PolygonMesh& facets, const VertexRows& rows, const Act& act) {
    const FacetLinks none;
    return act(LinkedMesh{facets, none, {}, rows});
}

WrittenMesh write_alone(const std::string& path, const PolygonMesh& mesh, MeshFormat format,
                        const WriteOptions& options = {}) {
    return with_linked(bare(mesh), rows_of(mesh),
                       [&](const LinkedMesh& linked) { return write_mesh(path, linked, format, options); });
}

/// What each rank throws; the first one has the mesh.
std::vector<std::string> write_by(int count, const std::string& path, const PolygonMesh& mesh,
                                  MeshFormat format, const WriteOptions& options, WrittenMesh& written,
                                  const support::OpenShared& open = {}) {
    const PolygonMesh facets = bare(mesh);
    return support::run_ranks(
        count,
        [&](Ranks& ranks) {
            const WrittenMesh of_rank =
                with_linked(ranks.is_first() ? facets : PolygonMesh(),
                            ranks.is_first() ? rows_of(mesh) : VertexRows(), [&](const LinkedMesh& linked) {
                                return write_mesh_by_ranks(path, linked, format, options, ranks);
                            });
            if (ranks.is_first()) written = of_rank;
        },
        open);
}

void check_same_file(int count, const PolygonMesh& mesh, MeshFormat format, const WriteOptions& options) {
    const support::Folder folder;
    const WrittenMesh one = write_alone(folder / "one", mesh, format, options);
    WrittenMesh all;
    for (const std::string& failure : write_by(count, folder / "all", mesh, format, options, all))
        CHECK(failure.empty());
    CHECK(support::read_file(folder / "one") == support::read_file(folder / "all"));
    CHECK(folder.names() == std::set<std::string>{"all", "one"});
    CHECK(all.by_all_ranks == (count > 1));
    CHECK(all.text_for_precision == one.text_for_precision);
    CHECK(all.moved_by_floats == one.moved_by_floats);
    CHECK(all.shift == one.shift);
}

/// A file that takes less than it is given, or tells of a failure.
class WorseFile final : public SharedFile {
public:
    WorseFile(std::unique_ptr<SharedFile> file, std::string failure)
        : file_(std::move(file)), failure_(std::move(failure)) {}
    std::string write_at(std::uint64_t offset, std::string_view bytes) override {
        if (!failure_.empty()) return failure_;
        return file_->write_at(offset, bytes.substr(0, bytes.size() / 2));
    }
    std::string close() override { return file_->close(); }

private:
    std::unique_ptr<SharedFile> file_;
    std::string failure_;
};

/// A file that has no room for the end of text.
class FileWithoutEnd final : public SharedFile {
public:
    FileWithoutEnd(std::unique_ptr<SharedFile> file, std::atomic<int>& closed)
        : file_(std::move(file)), closed_(closed) {}
    std::string write_at(std::uint64_t offset, std::string_view bytes) override {
        return bytes.starts_with("endsolid") ? "no space for the end" : file_->write_at(offset, bytes);
    }
    std::string close() override {
        ++closed_;
        return file_->close();
    }

private:
    std::unique_ptr<SharedFile> file_;
    std::atomic<int>& closed_;
};

} // namespace

TEST_CASE("ranks write the file that one writes, in each format", "[io]") {
    const int count = GENERATE(1, 2, 3, 5);
    const MeshFormat format = GENERATE(MeshFormat::ply, MeshFormat::off, MeshFormat::stl, MeshFormat::obj);
    INFO(count << " ranks, " << info_of(format).name);
    const double far = 1e5; // where floats are too coarse
    for (const bool ascii : {false, true}) {
        check_same_file(count, some_mesh(9, true, 0), format, {.ascii = ascii});
        check_same_file(count, some_mesh(9, false, far), format, {.ascii = ascii});
        check_same_file(count, some_mesh(9, true, far), format, {.ascii = ascii, .recentre = true});
    }
}

TEST_CASE("ranks write a mesh of more vertices than they have at once", "[io][slow]") {
    const PolygonMesh mesh = some_mesh(220, true, 0);
    REQUIRE(mesh.vertex_count() > std::size_t{1} << 18);
    check_same_file(3, mesh, MeshFormat::ply, {});
    check_same_file(2, mesh, MeshFormat::stl, {});
}

TEST_CASE("ranks write a mesh without facets, and none", "[io]") {
    PolygonMesh mesh;
    check_same_file(3, mesh, MeshFormat::ply, {});
    mesh.positions = {{0, 0, 1}, {0, 1, 0}};
    check_same_file(3, mesh, MeshFormat::ply, {});
    check_same_file(3, mesh, MeshFormat::stl, {.ascii = true});
}

TEST_CASE("what one rank cannot write ends all, and the file before stays", "[io]") {
    const support::Folder folder;
    const std::string path = folder.write("mesh.ply", "before");
    const bool is_short = GENERATE(false, true);
    const support::OpenShared open = [&](int rank, const std::string& name) -> std::unique_ptr<SharedFile> {
        if (rank != (is_short ? 2 : 1)) return open_positioned(name); // the last one's end is missing
        return std::make_unique<WorseFile>(open_positioned(name), is_short ? "" : "no space");
    };
    WrittenMesh written;
    const auto failures = write_by(3, path, some_mesh(9, true, 0), MeshFormat::ply, {}, written, open);
    for (const std::string& failure : failures) CHECK_FALSE(failure.empty());
    if (is_short)
        CHECK(failures[0].find("that all processes have written") != std::string::npos);
    else
        CHECK(failures[0] == path + ": cannot write: no space (rank 1 of 3)");
    CHECK(support::read_file(path) == "before");
    CHECK(folder.names() == std::set<std::string>{"mesh.ply"});
}

TEST_CASE("no rank closes a file whose last line another one cannot write", "[io]") {
    const support::Folder folder;
    std::atomic<int> closed = 0; // each would wait for all
    const support::OpenShared open = [&](int, const std::string& name) {
        return std::make_unique<FileWithoutEnd>(open_positioned(name), closed);
    };
    WrittenMesh written;
    const PolygonMesh mesh = some_mesh(9, true, 0);
    for (const std::string& failure :
         write_by(3, folder / "mesh.stl", mesh, MeshFormat::stl, {.ascii = true}, written, open))
        CHECK(failure.find("no space for the end") != std::string::npos);
    CHECK(closed == 0);
    CHECK(folder.names().empty());
}

TEST_CASE("a pipe gets the mesh from the first rank, once", "[io]") {
    const support::Folder folder;
    const std::string pipe = folder / "pipe";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    const PolygonMesh mesh = some_mesh(9, true, 0);
    write_alone(folder / "one", mesh, MeshFormat::ply);
    std::future<std::string> read = std::async(std::launch::async, [&] { return support::read_file(pipe); });
    WrittenMesh written;
    for (const std::string& failure : write_by(2, pipe, mesh, MeshFormat::ply, {}, written))
        CHECK(failure.empty());
    CHECK(read.get() == support::read_file(folder / "one"));
}

TEST_CASE("the first rank writes alone what the others do not see", "[io]") {
    const support::Folder folder;
    const PolygonMesh mesh = some_mesh(9, true, 0);
    const support::OpenShared open = [&](int rank, const std::string& name) {
        return rank == 2 ? nullptr : open_positioned(name);
    };
    WrittenMesh written;
    for (const std::string& failure : write_by(3, folder / "all", mesh, MeshFormat::ply, {}, written, open))
        CHECK(failure.empty());
    CHECK_FALSE(written.by_all_ranks);
    write_alone(folder / "one", mesh, MeshFormat::ply);
    CHECK(support::read_file(folder / "one") == support::read_file(folder / "all"));
    for (const std::string& failure : write_by(2, "/dev/null", mesh, MeshFormat::ply, {}, written))
        CHECK(failure.empty());
    CHECK_FALSE(written.by_all_ranks);
    for (const std::string& failure : write_by(2, folder / "all", mesh, MeshFormat::mf3, {}, written))
        CHECK(failure.empty()); // what is no rows of vertices and facets
    CHECK_FALSE(written.by_all_ranks);
    write_alone(folder / "one", mesh, MeshFormat::mf3);
    CHECK(support::read_file(folder / "one") == support::read_file(folder / "all"));
    CHECK(folder.names() == std::set<std::string>{"all", "one"});
}
