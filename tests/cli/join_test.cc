// Several scans of one thing as one cloud.
#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace hsdm;
using namespace hsdm::test;

namespace {

/// Every second point of a cloud in each of two scans, and all of them in a third one beside the folder.
class TwoScans {
public:
    explicit TwoScans(std::size_t points, bool normals = true) {
        const PointCloud all =
            support::sample(support::torus(1, 0.3), {.points = points, .normals = normals});
        std::filesystem::create_directory(folder / "scans");
        support::write_ply(folder / "all.ply", all);
        for (const std::size_t first : {std::size_t{0}, std::size_t{1}}) {
            PointCloud part;
            for (std::size_t i = first; i < points; i += 2) {
                part.positions.push_back(all.positions[i]);
                if (normals) part.normals.push_back(all.normals[i]);
            }
            support::write_ply(folder / (first == 0 ? "scans/a.ply" : "scans/b.ply"), part);
        }
    }
    std::string made_of(const std::string& call) const {
        const CommandResult result = run(folder, "reconstruct " + call + " -o made.ply");
        INFO(call << ": " << result.err);
        CHECK(result.status == 0);
        return read_file(folder / "made.ply");
    }

    Folder folder;
};

} // namespace

TEST_CASE("scans that are joined make the mesh of one file with all their points", "[cli]") {
    const TwoScans scans(8000, GENERATE(true, false));
    const std::string one = scans.made_of("all.ply --depth 5 --quiet");
    for (const char* call :
         {"--join scans", "scans/b.ply scans/a.ply --join", "--join scans/a.ply scans/b.ply"})
        CHECK(scans.made_of(call + std::string(" --depth 5 --quiet")) == one);
    const CommandResult told =
        run(scans.folder, "reconstruct --join scans --depth 5 --out-dir out --format ply --report r.json");
    CHECK(told.status == 0);
    CHECK(read_file(scans.folder / "out/scans.ply") == one);
    CHECK(told.out.find("8,000 points of 2 files") != std::string::npos);
    CHECK(run(scans.folder, "reconstruct --join scans/ --depth 5 --out-dir slash --format ply --quiet").status
          == 0);
    CHECK(read_file(scans.folder / "slash/scans.ply") == one);
    const std::string report = read_file(scans.folder / "r.json");
    CHECK(report.find("\"files\"") != std::string::npos);
    CHECK(report.find("scans/b.ply") != std::string::npos);
}

TEST_CASE("scans that are joined in bounded memory make the same file", "[cli][tiles]") {
    const TwoScans scans(60000);
    const std::string one = scans.made_of("all.ply --depth 7 --quiet");
    CHECK(scans.made_of("--join scans --depth 7 --memory 100M --quiet") == one);
}

TEST_CASE("what only some scans have is left out, and said", "[cli]") {
    const TwoScans scans(4000);
    PointCloud bare = sphere_scan(100);
    scans.folder.write("scans/c.xyz", xyz(bare));
    const CommandResult result = run(scans.folder, "reconstruct --join scans --depth 4 -o m.off");
    CHECK(result.status == 0);
    CHECK(result.out.find("left out: normals") != std::string::npos);
    CHECK(run(scans.folder, "reconstruct --join scans --depth 4 --normals given -o n.off").status == 1);
}

TEST_CASE("scans that cannot be joined are refused, and name the file", "[cli]") {
    const TwoScans scans(500);
    scans.folder.write("bad.xyz", "1 2 3\n4 5\n");
    const CommandResult bad = run(scans.folder, "reconstruct --join scans bad.xyz -o m.off");
    CHECK(bad.status == 1);
    CHECK(bad.err.find("hsdm: bad.xyz:2: ") != std::string::npos);
    const CommandResult own = run(scans.folder, "reconstruct --join scans -o scans/a.ply");
    CHECK(own.status == 2);
    CHECK(own.err.find("destroyed") != std::string::npos);
    CHECK(run(scans.folder, "reconstruct --join scans - -o m.off </dev/null").status == 2);
    std::filesystem::create_directory(scans.folder / "none");
    const CommandResult none = run(scans.folder, "reconstruct --join none -o m.off");
    CHECK(none.status == 1);
    CHECK(none.err.find("none: holds no file") != std::string::npos);
    CHECK(list(scans.folder) == "all.ply\nbad.xyz\nnone\nscans\n");
}
