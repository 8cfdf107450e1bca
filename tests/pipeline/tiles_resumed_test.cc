// Runs in tiles that end before their time, and those that go on with what is left.
#include "hsdm/errors.hh"
#include "hsdm/io/kept_scratch.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/kept_passes.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "support/check.hh"
#include "support/folder.hh"
#include "support/rank_threads.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <atomic>
#include <filesystem>
#include <optional>
#include <thread>

using namespace hsdm;

namespace {

const std::vector<KeptScratch::Trait> this_job = {{"input", "a torus"}};

PointCloud torus(bool normals, double noise = 0) {
    PointCloud cloud = support::sample(support::torus(1, 0.4),
                                       {.points = 2500, .normals = normals, .position_noise = noise});
    // is left out; one that is told by its distance alone lies beyond the others
    cloud.positions.push_back({0.03, 0.02, normals ? 0.01 : 0.9});
    if (normals) cloud.normals.push_back({0, 0, 1});
    if (!normals) {
        cloud.sensors = {Vec3(0, 0, 5), Vec3(1, 0, -5)};
        for (const Vec3& p : cloud.positions) cloud.sensor_of.push_back(p[2] > 0 ? 0 : 1);
    }
    return cloud;
}

TileOptions small_tiles(KeptScratch* kept, std::size_t most_points = 1200) {
    TileOptions tiles;
    tiles.memory = std::size_t{1} << 30;
    tiles.most_points = most_points;
    tiles.kept = kept;
    return tiles;
}

/// One process that fails at a certain time that it would tell others something.
class FailingRank final : public Ranks {
public:
    explicit FailingRank(std::size_t last) : last_(last) {}
    int rank() const override { return 0; }
    int size() const override { return 1; }

private:
    std::vector<Bytes> gather_bytes(const Bytes& own) override {
        if (last_-- == 0) throw Error("a fault");
        return {own};
    }
    std::vector<Bytes> exchange_bytes(std::vector<Bytes>&& out,
                                      const std::vector<std::vector<std::uint64_t>>&) override {
        return std::move(out);
    }
    [[noreturn]] void abort(const std::string&) noexcept override { std::terminate(); }

    std::size_t last_;
};

struct Run {
    std::optional<PolygonMesh> mesh; ///< none: it failed
    std::size_t reads = 0;           ///< of the points
    TileReport how;
    Report report;
};

Run run_by(Ranks& ranks, const PointCloud& cloud, const ReconstructOptions& options, KeptScratch* kept,
           std::size_t most_points = 1200) {
    Run run;
    const PointParts parts = [&](const auto& visit) { ++run.reads, visit(view_of(cloud)); };
    try {
        Reconstruction made =
            reconstruct_in_tiles(parts, options, small_tiles(kept, most_points), ranks, &run.how);
        run.mesh = to_polygons(made.mesh);
        run.report = std::move(made.report);
    } catch (const Error& error) {
        CHECK(std::string(error.what()) == "a fault");
    }
    return run;
}

Run run_until(std::size_t fault, const PointCloud& cloud, const ReconstructOptions& options,
              KeptScratch* kept) {
    FailingRank ranks(fault);
    return run_by(ranks, cloud, options, kept);
}

void check_same(const Run& whole, const Run& other) {
    REQUIRE(other.mesh);
    CHECK(support::are_same_bits(whole.mesh->positions, other.mesh->positions));
    CHECK(whole.mesh->corners == other.mesh->corners);
    CHECK(whole.mesh->sharp_edges == other.mesh->sharp_edges);
    CHECK(whole.report.rejected == other.report.rejected);
    CHECK(whole.report.options == other.report.options);
    CHECK(whole.report.error.points_to_mesh_mean == other.report.error.points_to_mesh_mean);
    CHECK(whole.report.input.spacing == other.report.input.spacing);
    CHECK(whole.report.input.merged_duplicates == other.report.input.merged_duplicates);
    CHECK(whole.report.dropped.size() == other.report.dropped.size());
}

/// A fault every so-manieth time that it would tell others something, and a run that goes on.
void check_faults(const PointCloud& cloud, const ReconstructOptions& options, std::size_t step) {
    const support::Folder folder;
    const Run whole = run_until(std::size_t{1} << 40, cloud, options, nullptr);
    REQUIRE(whole.mesh);
    CHECK(whole.how.tiles > 2);
    CHECK(whole.report.rejected.at("points_outlying") >= 1); // more of noisy ones
    std::size_t went_on = 0, tiles = 0, faults = 0;
    for (std::size_t fault = 1;; fault += step) {
        INFO("fault " << fault);
        bool ended = false;
        {
            KeptScratch kept(folder / ".", 0, this_job);
            const Run first = run_until(fault, cloud, options, &kept);
            CHECK_FALSE(first.how.went_on);
            ended = first.mesh.has_value();
            if (ended) check_same(whole, first);
        }
        KeptScratch kept(folder / ".", 0, this_job);
        const Run second = run_until(std::size_t{1} << 40, cloud, options, &kept);
        check_same(whole, second);
        CHECK(second.reads == (second.how.went_on ? 0 : 2));
        went_on += second.how.went_on, tiles += second.how.kept_tiles;
        kept.remove();
        CHECK(std::filesystem::is_empty(folder / "."));
        if (ended) break;
        ++faults;
    }
    CHECK(faults > 2);
    CHECK(2 * went_on > faults);
    CHECK(tiles > 0);
}

} // namespace

TEST_CASE("a run in tiles goes on where one with a fault has ended", "[pipeline][tiles]") {
    check_faults(torus(true), {.depth = 4}, 13);
}

TEST_CASE("tiles whose pieces are lost are made again, and what is told of them forgotten",
          "[pipeline][tiles]") {
    const PointCloud cloud = torus(true);
    const ReconstructOptions options{.depth = 4};
    const support::Folder folder;
    const auto run_with = [&](std::size_t most_points) {
        OneRank alone;
        KeptScratch kept(folder / ".", 0, this_job);
        return run_by(alone, cloud, options, &kept, most_points);
    };
    const Run whole = run_with(1200);
    const std::string pieces = folder / "hsdm-resume-0/pieces";
    const auto left = static_cast<std::uintmax_t>(GENERATE(0, 7)); // eighths
    std::filesystem::resize_file(pieces, std::filesystem::file_size(pieces) * left / 8);
    const Run other = run_with(100000);
    check_same(whole, other);
    CHECK(other.how.went_on);
    CHECK(other.reads == 0); // all passes stay
    CHECK(other.how.tiles < whole.how.tiles);
    const Run last = run_with(1200);
    check_same(whole, last);
    CHECK(last.how.went_on);
    CHECK((last.how.kept_tiles > 0) == (left > 0));
    CHECK(last.how.kept_tiles < last.how.tiles);
    CHECK(run_with(1200).how.kept_tiles == last.how.tiles);
}

TEST_CASE("a run that goes on tells its own options, not those of the one before", "[pipeline][tiles]") {
    const PointCloud cloud = torus(true);
    const ReconstructOptions options{.depth = 4};
    ReconstructOptions others = options;
    others.min_component.emplace().value = 3;
    const support::Folder folder;
    const auto run_with = [&](const ReconstructOptions& of_run) {
        OneRank alone;
        KeptScratch kept(folder / ".", 0, this_job);
        return run_by(alone, cloud, of_run, &kept);
    };
    const Run first = run_with(others), second = run_with(options);
    CHECK(first.report.options.contains("min-component"));
    CHECK(second.how.went_on);
    OneRank alone;
    check_same(run_by(alone, cloud, options, nullptr), second);
}

TEST_CASE("wherever a run in tiles fails the next one goes on, whatever it has to find out",
          "[pipeline][tiles][slow]") {
    const bool normals = GENERATE(true, false);
    ReconstructOptions options;
    if (!normals) options.depth = 4; // else the voxel is chosen
    check_faults(torus(normals), options, normals ? 2 : 3);
}

TEST_CASE("so it does where noisy points have been moved", "[pipeline][tiles][slow]") {
    check_faults(torus(false, 0.04), {.depth = 4}, 7);
}

TEST_CASE("so it does where normals have been mended", "[pipeline][tiles][slow]") {
    PointCloud cloud = support::sample(support::torus(1, 0.4), {.points = 2500, .normal_noise = 0.4});
    for (std::size_t i = 0; i < cloud.size(); i += 5) cloud.normals[i] = -cloud.normals[i];
    cloud.positions.push_back({0.03, 0.02, 0.01});
    cloud.normals.push_back({0, 0, 1});
    check_faults(cloud, {.depth = 4}, 7);
}

TEST_CASE("ranks go on with what all of them have kept", "[pipeline][tiles]") {
    const PointCloud cloud = torus(true);
    const ReconstructOptions options{.depth = 4, .threads = 1};
    const Run whole = run_until(std::size_t{1} << 40, cloud, options, nullptr);
    const support::Folder folder;
    // What the second rank has is of no use without what the first one lost: none begins anew unasked.
    const bool loses = GENERATE(false, true);
    std::size_t went_on = 0, reads = 0;
    std::optional<Run> result;
    for (int turn = 0; turn < 2; ++turn) {
        if (turn == 1 && loses) std::filesystem::remove_all(folder / "hsdm-resume-0");
        went_on = reads = 0;
        std::vector<Run> runs(2);
        const auto failures = support::run_ranks(2, [&](Ranks& ranks) {
            KeptScratch kept(folder / ".", ranks.rank(), this_job);
            Run& run = runs[static_cast<std::size_t>(ranks.rank())];
            const PointParts parts = [&](const auto& visit) {
                ++run.reads, support::share_of(cloud, ranks)(visit);
            };
            Reconstruction made = reconstruct_in_tiles(parts, options, small_tiles(&kept), ranks, &run.how);
            run.mesh = to_polygons(made.mesh);
            run.report = std::move(made.report);
        });
        for (const std::string& failure : failures)
            CHECK((failure.find("rank 0 finds nothing in its hsdm-resume-0; give it its --scratch")
                   != std::string::npos)
                  == (turn == 1 && loses));
        if (turn == 1 && loses) return;
        for (const Run& run : runs) went_on += run.how.went_on, reads += run.reads;
        check_same(whole, runs.front());
    }
    CHECK(went_on == 2);
    CHECK(reads == 0);
}

TEST_CASE("what is kept of another job, or by another process, is told apart", "[pipeline][tiles]") {
    const support::Folder folder;
    const auto refusal = [&](const std::vector<KeptScratch::Trait>& job) -> std::string {
        try {
            KeptScratch(folder / ".", 0, job).keep(1, {});
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    CHECK_FALSE(KeptScratch::is_there(folder / ".", 0));
    {
        KeptScratch kept(folder / ".", 0, this_job);
        kept.keep(7, {'a', 'b'});
        CHECK(refusal(this_job).find("another process") != std::string::npos);
    }
    CHECK(KeptScratch::is_there(folder / ".", 0));
    CHECK(refusal({{"input", "a box"}}).find("another input: a torus, and not a box") != std::string::npos);
    CHECK(refusal({{"size", "a box"}}).find("of a job of other files or options; remove")
          != std::string::npos);
    // A record that was not written to its end, as by a process that was killed.
    const std::string log = folder / "hsdm-resume-0/log";
    {
        KeptScratch kept(folder / ".", 0, this_job);
        REQUIRE(kept.records().size() == 1);
        CHECK(kept.read(kept.records().front()) == KeptScratch::Bytes{'a', 'b'});
        kept.keep(8, KeptScratch::Bytes(1000, 'c'));
    }
    std::filesystem::resize_file(log, std::filesystem::file_size(log) - 1);
    KeptScratch kept(folder / ".", 0, this_job);
    CHECK(kept.records().size() == 1);
    kept.keep(9, {});
    CHECK(kept.records().back().key == 9);
    kept.remove();
    CHECK(std::filesystem::is_empty(folder / "."));
}

TEST_CASE("ranks that come back on other machines are told which, and begin nothing anew",
          "[pipeline][tiles]") {
    const support::Folder folder;
    const auto on = [&](const std::vector<std::string>& machines) {
        return support::run_ranks(static_cast<int>(machines.size()), [&](Ranks& ranks) {
            refuse_moved(folder / machines[static_cast<std::size_t>(ranks.rank())], ranks);
        });
    };
    for (const char* machine : {"a", "b", "c", "d"}) std::filesystem::create_directory(folder / machine);
    CHECK(on({"a", "b"}) == std::vector<std::string>(2)); // nothing was begun
    for (const auto& [machine, rank] : {std::pair("a", 0), {"b", 1}, {"c", 2}})
        KeptScratch(folder / machine, rank, this_job).keep(1, {});
    CHECK(KeptScratch::processes_in(folder / "b") == std::vector{1});
    CHECK(on({"a", "b", "c"}) == std::vector<std::string>(3));
    for (const std::string& why : on({"b", "a", "c"})) {
        CHECK(why.find("rank 0 on ") != std::string::npos);
        CHECK(why.find("has no hsdm-resume-0, which rank 1 on ") != std::string::npos);
        CHECK(why.find("mpirun --host") != std::string::npos);
    }
    for (const std::string& why : on({"a", "c"}))
        CHECK(why.find("hsdm-resume-2 of more processes") != std::string::npos);
    CHECK(on({"c"})[0].find("of more processes") != std::string::npos);
    CHECK(on({"a", "b", "d"}) == std::vector<std::string>(3)); // KeptPasses knows whether it is lost
    KeptScratch(folder / "d", 0, this_job).keep(1, {});
    for (const int rank : {1, 2}) KeptScratch(folder / "d", rank, this_job).keep(1, {});
    CHECK(on({"d", "d", "d"}) == std::vector<std::string>(3)); // a folder that all see
}

TEST_CASE("of two that open and remove what is kept each has it for itself", "[pipeline][tiles]") {
    const support::Folder folder;
    std::atomic<int> inside = 0, jobs = 0;
    std::atomic<bool> alone = true;
    const auto work = [&] {
        while (jobs < 60) {
            try {
                KeptScratch kept(folder / ".", 0, this_job);
                alone = alone && inside++ == 0 && std::filesystem::exists(kept.folder() + "/log");
                ++jobs, --inside;
                kept.remove();
            } catch (const Error&) { // the other one works there
            }
        }
    };
    std::thread other(work);
    work();
    other.join();
    CHECK(alone);
    KeptScratch(folder / ".", 0, this_job).remove();
    CHECK(std::filesystem::is_empty(folder / "."));
}
