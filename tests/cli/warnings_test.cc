// What a run warns of: the summary's last lines, the report, and --strict.
#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;
using namespace hsdm::test;

namespace {

constexpr const char* at_voxels = " --voxel-size 0.0625 ";

/// A slot of half a voxel in a block, which its points do not tell apart from a fold.
void write_slotted(const Folder& folder, const std::string& name) {
    const support::Solid slot =
        support::box({2, 1, 0.8}) - support::box({0.03, 2, 0.8}).placed({.shift = Vec3(0, 0, 0.4)});
    support::write_ply(folder / name, support::sample(slot, {.points = 20000, .seed = 2}));
}

std::string last_line(const std::string& text) {
    const std::size_t end = text.find_last_not_of('\n');
    return text.substr(text.rfind('\n', end) + 1, end - text.rfind('\n', end));
}

} // namespace

TEST_CASE("a warning stands last in the summary and in the report, and costs no status", "[cli]") {
    const Folder folder;
    write_slotted(folder, "slot.ply");
    const CommandResult result =
        run(folder, std::string("reconstruct slot.ply -o a.off --report r.json") + at_voxels);
    CHECK(result.status == 0);
    CHECK(result.err == "");
    CHECK(last_line(result.out).starts_with("warning   "));
    const auto warnings = nlohmann::json::parse(read_file(folder / "r.json"))["warnings"];
    REQUIRE(!warnings.empty());
    for (const auto& one : warnings) {
        CHECK(one["how_much"] > 0);
        for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(one["where"][k].get<double>()) < 1.1);
        CHECK(result.out.find(one["what"].get<std::string>()) != std::string::npos);
    }
    const auto first = result.out.find("warning   ");
    CHECK(static_cast<std::size_t>(
              std::count(result.out.begin() + static_cast<std::ptrdiff_t>(first), result.out.end(), '\n'))
          == warnings.size()); // nothing else stands behind the first
}

TEST_CASE("with --strict a warning is status 1, is told, and changes no file", "[cli]") {
    const Folder folder;
    write_slotted(folder, "slot.ply");
    REQUIRE(run(folder, std::string("reconstruct slot.ply -o a.off --quiet") + at_voxels).status == 0);
    const CommandResult strict =
        run(folder, std::string("reconstruct slot.ply -o b.off --quiet --strict") + at_voxels);
    CHECK(strict.status == 1);
    CHECK(strict.out == "");
    CHECK(strict.err.starts_with("hsdm: slot.ply: a warning, which --strict makes a failure: "));
    CHECK(read_file(folder / "a.off") == read_file(folder / "b.off"));
}

TEST_CASE("with --strict a mesh without warnings passes, and intersections are counted", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    const CommandResult result =
        run(folder, "reconstruct scan.xyz --depth 4 -o a.off --strict --report r.json");
    CHECK(result.status == 0);
    CHECK(result.err == "");
    const auto report = nlohmann::json::parse(read_file(folder / "r.json"));
    CHECK(report["warnings"] == nlohmann::json::array());
    CHECK(report["mesh"]["intersections"] == 0);
}

TEST_CASE("of several inputs the totals say how many have warnings", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(20000)));
    write_slotted(folder, "slot.ply");
    const std::string command = std::string("reconstruct slot.ply scan.xyz --out-dir d") + at_voxels;
    const CommandResult result = run(folder, command);
    CHECK(result.status == 0);
    CHECK(last_line(result.out).ends_with("; 1 with warnings"));
    CHECK(run(folder, command + "--strict").status == 1);
}

TEST_CASE("a case may expect how many warnings there are, and one that is strict misses with any", "[cli]") {
    const Folder folder;
    write_slotted(folder, "slot.ply");
    folder.write("scan.xyz", xyz(sphere_scan(20000)));
    const auto status = [&](const std::string& input, const std::string& arguments,
                            const std::string& expected) {
        folder.write("suite.json", R"({"cases": [{"input": ")" + input
                                       + R"(", "args": ["--voxel-size", "0.0625")" + arguments
                                       + R"(], "expect": {)" + expected + "}}]}");
        return run(folder, "regress suite.json").status;
    };
    CHECK(status("scan.xyz", "", R"("warnings": [])") == 0);
    CHECK(status("scan.xyz", "", R"("warnings": {"max": 0})") == 0);
    CHECK(status("scan.xyz", R"(, "--strict")", R"("mesh.closed": true)") == 0);
    CHECK(status("slot.ply", "", R"("warnings": {"min": 1})") == 0);
    CHECK(status("slot.ply", "", R"("warnings.0.how_much": {"min": 1})") == 0);
    CHECK(status("slot.ply", "", R"("warnings": [])") == 1);
    CHECK(status("slot.ply", "", R"("warnings": {"max": 0})") == 1);
    CHECK(status("slot.ply", R"(, "--strict")", R"("mesh.components": 1)") == 1);
}
