// The same bits from every compiler, build type and number of threads: those that testdata/hashes.txt keeps
// for the measurement suites.

#include "hashes/kept_hashes.hh"

#include "reconstruct_arguments.hh"
#include "suite_file.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/io/source_bytes.hh"
#include "hsdm/reconstruct.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

using namespace hsdm;
using namespace hsdm::test;
using command::Case;

namespace {

constexpr const char* kept_path = HSDM_TESTDATA_DIR "/hashes.txt";

struct SuiteCase {
    std::string name; ///< with the suite
    Case what;
};

/// Lines of the file that HSDM_HASHES_OF names: suites and cases; nothing if it is not set.
std::optional<std::set<std::string>> names_asked_for() {
    const char* const path = std::getenv("HSDM_HASHES_OF");
    if (!path) return std::nullopt;
    std::ifstream in(path);
    std::set<std::string> names;
    for (std::string line; std::getline(in, line);) names.insert(line);
    return names;
}

/// Of the suites that are there; all of them, or those of HSDM_HASHES_OF.
std::vector<SuiteCase> measurement_cases() {
    const std::optional<std::set<std::string>> names = names_asked_for();
    std::vector<SuiteCase> cases;
    for (const char* suite : {"data/suite.json", "data/crowd/suite.json"}) {
        const std::string path = std::string(HSDM_SHARED_DIR "/") + suite;
        if (!std::filesystem::exists(path)) {
            WARN("skipped, for there is no " << path);
            continue;
        }
        const io::SourceBytes text = io::SourceBytes::open(path);
        for (Case& one : command::parse_suite(std::string(text.view()), path, command::OtherKeys::left))
            if (std::string name = std::string(suite) + ' ' + one.name; !names || names->contains(name))
                cases.push_back({std::move(name), std::move(one)});
    }
    return cases;
}

/// Results hold bits of these functions, which the C library computes otherwise on other processors.
KeptHash library_functions() {
    std::uint64_t hash = 0;
    for (int i = 1; i <= 4096; ++i) {
        const double x = 3.7 * i / 4096;
        for (const double y :
             {std::exp(-x), std::sin(x), std::cos(x), std::atan2(x, 1.3 - x), std::acos(x / 4)})
            hash = (hash ^ std::bit_cast<std::uint64_t>(y)) * 0x9e3779b97f4a7c15;
    }
    return {"the C library's functions", {hash, 0}};
}

/// Whether results can have the bits that are kept.
bool has_kept_library() {
    const KeptHash here = library_functions();
    const auto kept = read_hashes(kept_path);
    const auto found = kept.find(here.name);
    if (found != kept.end() && found->second.geometry == here.hash.geometry) return true;
    WARN("skipped: exp, sin, cos, atan2 or acos of this C library and processor have other bits");
    return false;
}

/// With so many threads, even if there are fewer cores; 0: as many as there are.
MeshHash result_of(const Case& one, int threads = 0) {
    const command::CaseOptions asked = command::case_options(one.name, one.arguments);
    ReconstructOptions options = asked.reconstruct;
    options.threads = threads;
    options.measure = false; // the report's errors are of no concern here, but a third of the time
    const Reconstruction result = reconstruct(read_points(one.input, asked.read).cloud, options);
    if (threads > 0) CHECK(result.report.threads == threads);
    return hash_of(result.mesh);
}

/// Zero, and the test has failed, for a case that fails.
MeshHash result_or_zero(const SuiteCase& one) {
    try {
        return result_of(one.what);
    } catch (const Error& error) {
        FAIL_CHECK(one.name << ": " << error.what());
        return {};
    }
}

/// Empty, or a line for each of the hashes that are not as kept.
std::string changes(const std::vector<KeptHash>& found) {
    const auto kept = read_hashes(kept_path);
    std::string lines;
    for (const KeptHash& one : found) {
        const auto before = kept.find(one.name);
        if (before == kept.end())
            lines += "not kept   " + line_of(one) + '\n';
        else if (before->second.geometry != one.hash.geometry)
            lines += "geometry   " + line_of(one) + '\n';
        else if (before->second.features != one.hash.features)
            lines += "features   " + line_of(one) + '\n';
    }
    return lines;
}

constexpr const char* advice =
    "Results changed. If they were meant to, renew testdata/hashes.txt: HSDM_WRITE_HASHES=FILE, see "
    "CONTRIBUTING.md.\n";

} // namespace

TEST_CASE("the measurement suites' meshes have the bits that are kept", "[shared][slow]") {
    const char* const path = std::getenv("HSDM_WRITE_HASHES");
    if (!path && !has_kept_library()) return;
    std::vector<KeptHash> found{library_functions()};
    for (const SuiteCase& one : measurement_cases()) found.push_back({one.name, result_or_zero(one)});
    if (path) return write_hashes(path, found);
    const std::string changed = changes(found);
    INFO(advice << changed);
    CHECK(changed.empty());
}

TEST_CASE("the measurement suites' small clouds give these bits with any number of threads",
          "[shared][slow]") {
    if (!has_kept_library()) return;
    const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 8);
    constexpr std::uintmax_t small = 500000; // bytes
    for (const SuiteCase& one : measurement_cases()) {
        if (std::filesystem::file_size(one.what.input) > small) continue;
        for (const int threads : {1, 3, 8}) {
            const std::string changed = changes({{one.name, result_of(one.what, threads)}});
            INFO(threads << " threads. " << advice << changed);
            CHECK(changed.empty());
        }
    }
}
