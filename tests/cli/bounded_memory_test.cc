// Reconstructing in bounded memory when things go wrong: nothing is lost, and nothing is left behind.
#include "cli/run.hh"
#include "support/sample.hh"
#include "support/scanner.hh"

#include <catch2/catch.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

using namespace hsdm;
using namespace hsdm::test;

namespace {

/// A folder with a scan that does not fit the bound, its mesh in one piece, an old file and a scratch folder.
class Job {
public:
    explicit Job(std::size_t points = 60000) {
        std::filesystem::create_directory(folder / "scratch");
        support::write_ply(folder / "scan.ply", support::sample(support::torus(1, 0.3), {.points = points}));
        folder.write("old.ply", "old");
    }

    /// What is to come out.
    std::string in_one_piece() const {
        REQUIRE(run(folder, "reconstruct scan.ply --depth 7 --quiet -o one.ply").status == 0);
        return read_file(folder / "one.ply");
    }
    bool left_nothing() const {
        return std::filesystem::is_empty(folder / "scratch") && read_file(folder / "old.ply") == "old";
    }

    Folder folder;
    std::string call = "reconstruct scan.ply --depth 7 --memory 100M --scratch scratch --quiet ";
};

} // namespace

TEST_CASE("a disk that is full ends bounded memory with a message, and old files stand", "[cli][tiles]") {
    const Job job;
    const auto [blocks, what] = GENERATE(std::pair(1000, "scratch"), std::pair(6000, "old.ply"));
    INFO(what); // the points take 2.9 MB of scratch, the mesh 3.6 MB
    const CommandResult result =
        run(job.folder, job.call + "-o old.ply", "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + ";");
    INFO(result.err);
    CHECK(result.status == 1);
    CHECK(result.err.find(what) != std::string::npos);
    CHECK(result.err.find("too large") != std::string::npos);
    CHECK(job.left_nothing());
    CHECK(list(job.folder) == "old.ply\nscan.ply\nscratch\n");
}

TEST_CASE("colours, labels and scanners are those of one piece in bounded memory", "[cli][tiles]") {
    const PointCloud cloud = support::scan_from_above(
        support::box({1, 0.8, 0.5}), 1, {.points = 12000, .positions = 2, .misalignment = 0.02});
    std::ostringstream text;
    text.precision(17);
    text << "x y z red green blue label nr\n";
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec3& p = cloud.positions[i];
        text << p[0] << ' ' << p[1] << ' ' << p[2] << ' ' << i % 256 << " 9 " << i % 7 << ' ' << i % 3 << ' '
             << cloud.sensor_of[i] << '\n';
    }
    std::ostringstream call;
    call.precision(17);
    call << "reconstruct scan.xyz --depth 5 --holes keep --sensor-column nr";
    for (const Vec3& place : cloud.sensors)
        call << " --sensor " << place[0] << ',' << place[1] << ',' << place[2];
    Folder folder;
    folder.write("scan.xyz", text.str());
    REQUIRE(run(folder, call.str() + " --quiet -o one.ply").status == 0);
    const CommandResult result =
        run(folder, call.str() + " --memory 76M -o tiles.ply --report report.json --scratch .");
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(read_file(folder / "one.ply") == read_file(folder / "tiles.ply"));
    const std::string report = read_file(folder / "report.json");
    CHECK(report.find("\"sensors\": \"2\"") != std::string::npos);
    CHECK(report.find("\"tiles\": ") != std::string::npos);
}

TEST_CASE("two jobs share a folder for scratch", "[cli][tiles]") {
    const Job job;
    const CommandResult both =
        run(job.folder, job.call + "-o a.ply & first=$!; '" HSDM_COMMAND "' " + job.call
                            + "-o b.ply; second=$?; wait $first && exit $second");
    INFO(both.err);
    CHECK(both.status == 0);
    CHECK(job.left_nothing());
    const std::string one = job.in_one_piece();
    CHECK(read_file(job.folder / "a.ply") == one);
    CHECK(read_file(job.folder / "b.ply") == one);
}

TEST_CASE("what was done before the disk was full is gone on with", "[cli][tiles]") {
    const Job job;
    const std::string call =
        "reconstruct scan.ply --depth 7 --memory 100M --scratch scratch --resume --report report.json ";
    // The points take 2.88 MB of scratch, what the survey finds some 3.0; or the mesh has no place, and all
    // tiles are done.
    const bool is_late = GENERATE(false, true);
    const CommandResult failed = is_late
                                     ? run(job.folder, call + "-o /dev/full --format ply")
                                     : run(job.folder, call + "-o part.ply", "trap '' XFSZ; ulimit -f 5750;");
    INFO(failed.err);
    CHECK(failed.status == 1);
    CHECK_FALSE(exists(job.folder / "part.ply"));
    CHECK(exists(job.folder / "scratch/hsdm-resume-0/log"));
    const CommandResult other = run(job.folder, call + "-o part.ply --holes keep");
    CHECK(other.status == 1);
    CHECK(other.err
          == "hsdm: scratch/hsdm-resume-0: is kept of a job with another --holes: auto, and not keep; remove "
             "the "
             "folder to begin anew, or name another with --scratch\n");
    CHECK(failed.err.find("what is done stays in scratch/hsdm-resume-0;") != std::string::npos);
    const CommandResult result = run(job.folder,
                                     "reconstruct .././scan.ply --depth 7 --memory 100M --scratch . --resume "
                                     "--report ../report.json -o ../part.ply --threads 1",
                                     "cd scratch;");
    INFO(result.err);
    CHECK(result.status == 0);
    const std::string report = read_file(job.folder / "report.json");
    CHECK(report.find(" tiles were kept\"") != std::string::npos);
    CHECK((report.find("\"0 tiles were kept") == std::string::npos) == is_late);
    CHECK(read_file(job.folder / "part.ply") == job.in_one_piece());
    CHECK(job.left_nothing());
}

TEST_CASE("a scan that has changed is not taken for the one that was begun", "[cli][tiles]") {
    const Job job(20000);
    const std::string call =
        "reconstruct scan.ply --depth 6 --memory 70M --scratch scratch --resume -o part.ply";
    CHECK(run(job.folder, call, "trap '' XFSZ; ulimit -f 100;").status == 1);
    std::filesystem::last_write_time(job.folder / "scan.ply",
                                     std::filesystem::last_write_time(job.folder / "scan.ply")
                                         + std::chrono::seconds(1));
    const CommandResult result = run(job.folder, call);
    CHECK(result.status == 1);
    CHECK(result.err.find("is kept of a job with another time of /") != std::string::npos);
    CHECK(result.err.find("remove the folder") != std::string::npos);
}

TEST_CASE("a job that is killed in any phase is gone on with", "[cli][tiles][slow]") {
    const Job job(100000);
    REQUIRE(run(job.folder, "reconstruct scan.ply --depth 7 --quiet -o one.ply").status == 0);
    const std::string one = read_file(job.folder / "one.ply");
    const std::string call =
        "reconstruct scan.ply --depth 7 --memory 130M --scratch scratch --resume -o new.ply ";
    int killed_late = 0;
    for (const std::string phase : {"octree", "survey", "tiles", "whole", "error", "write"}) {
        INFO(phase);
        const CommandResult first =
            run(job.folder, call + "--progress always >out 2>err & command=$!; until grep -q " + phase
                                + " err; do kill -0 $command 2>/dev/null || break; sleep 0.01; done; "
                                  "kill -KILL $command 2>/dev/null; wait $command");
        const bool killed = first.status == 128 + 9;
        CHECK((killed || first.status == 0)); // it may have ended before
        // Whenever it was killed: what is kept goes after the mesh has come, and not before.
        const bool is_kept = exists(job.folder / "scratch/hsdm-resume-0/log");
        const bool is_written = exists(job.folder / "new.ply");
        CHECK((killed ? is_kept || is_written : is_written && !is_kept));
        const CommandResult result = run(job.folder, call + "--report report.json");
        INFO(result.err);
        CHECK(result.status == 0);
        CHECK(read_file(job.folder / "new.ply") == one);
        const bool went_on =
            read_file(job.folder / "report.json").find(" tiles were kept") != std::string::npos;
        CHECK((went_on || !is_kept || is_written || phase == "octree")); // before a pass was kept
        CHECK((is_kept || !went_on));
        killed_late += killed && went_on;
        CHECK(job.left_nothing());
        std::filesystem::remove(job.folder / "new.ply");
    }
    CHECK(killed_late > 0);
}

TEST_CASE("what is told of files that are not read again is told all the same", "[cli][tiles]") {
    const Folder folder;
    std::filesystem::create_directory(folder / "scratch");
    const PointCloud cloud = support::sample(support::torus(1, 0.3), {.points = 20000});
    for (const char* name : {"a.xyz", "b.xyz"}) {
        std::ostringstream text;
        text << "nan 0 0 0 0 1\n";
        const std::size_t first = name[0] == 'a' ? 0 : 10000;
        for (std::size_t i = first; i < first + 10000; ++i)
            text << cloud.positions[i] << ' ' << cloud.normals[i] << '\n';
        folder.write(name, text.str());
    }
    const std::string call = "reconstruct a.xyz b.xyz --join --columns x,y,z,nx,ny,nz --depth 6 --memory 80M "
                             "--scratch scratch --report report.json -o ";
    const auto told = [&] {
        const std::string report = read_file(folder / "report.json");
        std::string lines;
        std::istringstream in(report);
        for (std::string line; std::getline(in, line);)
            if (line.find("nonfinite") != std::string::npos || line.find("columns") != std::string::npos)
                lines += line + '\n';
        return lines;
    };
    REQUIRE(run(folder, call + "whole.ply").status == 0);
    const std::string whole = told();
    CHECK(whole.find("\"dropped_nonfinite\": 2") != std::string::npos);
    CHECK(run(folder, call + "/dev/full --format ply --resume").status == 1);
    REQUIRE(run(folder, call + "part.ply --resume").status == 0);
    CHECK(read_file(folder / "report.json").find(" tiles were kept") != std::string::npos);
    CHECK(told() == whole);
    CHECK(read_file(folder / "part.ply") == read_file(folder / "whole.ply"));
}

TEST_CASE("a cloud that tiles refuse leaves nothing to go on with", "[cli][tiles]") {
    const Folder folder;
    std::filesystem::create_directory(folder / "scratch");
    constexpr std::size_t points = 8000;
    const double spacing = std::sqrt(12.0 / points); // as wide is the noise, many voxels
    support::write_ply(
        folder / "scan.ply",
        support::sample(support::sphere(1), {.points = points, .normals = false, .position_noise = spacing}));
    const CommandResult result = run(folder, "reconstruct scan.ply --depth 12 --memory 80M --scratch scratch "
                                             "--resume -o part.ply");
    CHECK(result.status == 1);
    CHECK(result.err.find("this is not done in tiles") != std::string::npos);
    CHECK(result.err.find("stays in") == std::string::npos);
    CHECK(std::filesystem::is_empty(folder / "scratch"));
}

TEST_CASE("a signal in any phase of bounded memory leaves nothing", "[cli][tiles][slow]") {
    const Job job(300000);
    int cancelled = 0;
    for (const char* phase : {"octree", "survey", "tiles", "whole", "error", "write"}) {
        INFO(phase);
        const CommandResult result =
            run(job.folder,
                "reconstruct scan.ply --depth 8 --memory 200M --scratch scratch --progress always -o new.ply "
                ">out 2>err & command=$!; until grep -q "
                    + std::string(phase)
                    + " err; do kill -0 $command 2>/dev/null || break; sleep 0.01; done; "
                      "kill -INT $command 2>/dev/null; wait $command");
        CHECK((result.status == 130 || result.status == 0)); // it may have ended before
        cancelled += result.status == 130;
        CHECK(exists(job.folder / "new.ply") == (result.status == 0));
        CHECK(job.left_nothing());
        std::filesystem::remove(job.folder / "new.ply");
        CHECK(list(job.folder) == "err\nold.ply\nout\nscan.ply\nscratch\n");
    }
    CHECK(cancelled > 0);
}
