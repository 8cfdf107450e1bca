#include "suite_run.hh"

#include "activity.hh"
#include "case_report.hh"
#include "load.hh"
#include "mesh_stages.hh"
#include "output_check.hh"
#include "reconstruct_arguments.hh"
#include "summary.hh"

#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/measure.hh"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <regex>
#include <system_error>
#include <thread>
#include <utility>

namespace hsdm::command {
namespace {

Reconstruction reconstruct_case(const Case& one, const CaseOptions& asked) {
    const std::vector<StageCall> stages = parse_stages(asked.stages, one.folder);
    ReconstructOptions options = asked.reconstruct;
    options.progress = [](const char* phase, double) {
        set_phase(phase);
        return true;
    };
    set_activity(one.input.c_str(), "read");
    PointFile file = read_points(one.input, asked.read);
    const PointCloud scan = scan_for_stages(stages, file.cloud, true);
    Reconstruction result = reconstruct(std::move(file), options);
    run_stages(one.input, stages, scan, true, false, result);
    result.report.input.file = one.input;
    return result;
}

Comparison compare_to_reference(const std::string& path, const PolyMesh& mesh) {
    const Loaded reference = load(path);
    set_phase("compare");
    return compare(to_polygons(mesh), reference.mesh);
}

/// Measures what the case asks for beyond the report; misses are warnings, if it is strict, and what the file
/// that it wrote says otherwise. Takes the report.
CaseReport measure_case(const Case& one, const CaseOptions& asked, Reconstruction& made, Outcome& outcome) {
    CaseReport all;
    measure_details(made.mesh, made.report.mesh);
    set_phase("intersections");
    if (asked.strict || one.expect.contains("mesh.intersections"))
        count_intersections(made.mesh, made.report);
    if (asked.strict && !made.report.warnings.empty()) {
        outcome.status = failed;
        outcome.failure = strict_words(made.report);
        outcome.misses.push_back(outcome.failure);
    }
    if (!one.reference.empty()) all.reference = compare_to_reference(one.reference, made.mesh);
    set_activity(one.input.c_str(), "write");
    if (!one.output.empty()) {
        OutputCheck check = check_output(one, asked, made.mesh);
        all.output = std::move(check.output);
        if (!check.fault.empty()) outcome.misses.push_back("the " + one.output + " file " + check.fault);
    }
    all.report = std::move(made.report);
    return all;
}

CaseOptions options_of(const Case& one) {
    CaseOptions asked = case_options(one.name, one.arguments);
    if (one.output.empty() && (asked.ascii || asked.plain))
        throw Error(one.name, std::string("args: ") + (asked.ascii ? "--ascii" : "--plain")
                                  + " is about a file, but the case has no `output`; add one");
    return asked;
}

/// That the command would end with.
int status_after(const std::exception& error) {
    const bool usage = dynamic_cast<const UsageError*>(&error) || dynamic_cast<const OptionError*>(&error);
    return usage ? wrong_usage : failed;
}

/// Of a message only so much is searched: by recursion.
constexpr std::size_t most_searched = 4096;

/// Why a case that must fail did not, or did otherwise.
std::vector<std::string> misses_of_failure(const Failure& expected, const Outcome& outcome) {
    const std::string wanted = "`" + expected.message + "`";
    if (outcome.status == done) return {"made a mesh; a failure with " + wanted + " was expected"};
    const std::string message = outcome.failure.substr(0, most_searched);
    if (!std::regex_search(message, std::regex(expected.message)))
        return {"failed without " + wanted + " in its message: " + outcome.failure};
    if (outcome.status != expected.status)
        return {"failed with status " + std::to_string(outcome.status) + ", expected "
                + std::to_string(expected.status) + ": " + outcome.failure};
    return {};
}

Outcome interrupted(const Case& one) {
    Outcome outcome;
    outcome.name = one.name;
    outcome.input = one.input;
    outcome.arguments = one.arguments;
    outcome.misses = {"interrupted"};
    outcome.interrupted = true;
    return outcome;
}

/// Cases that are taken one by one by several threads.
class Queue {
public:
    Queue(std::span<const Case> cases, const std::function<Outcome(const Case&)>& run,
          SuiteProgress& progress, const std::function<void(const std::function<void()>&)>& change)
        : cases_(cases), run_(run), progress_(progress), change_(change) {}

    /// Runs one case after the other while there are any.
    void work() noexcept {
        try {
            for (std::size_t i = next_++; i < cases_.size(); i = next_++) run_one(i);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            error_ = std::current_exception();
            next_ = cases_.size();
        }
        done_.notify_all();
    }

    /// Runs the next case on this thread.
    void run_next() { run_one(next_++); }

    /// What has not begun does not begin any more.
    void close() { next_ = cases_.size(); }

    /// Waits for a case that others run. Throws what ended one of them.
    void wait_for(std::size_t i) {
        std::unique_lock lock(mutex_);
        done_.wait(lock, [&] { return is_done_[i] || error_; });
        if (!is_done_[i]) std::rethrow_exception(error_);
    }

private:
    void run_one(std::size_t i) {
        change_([&] { progress_.begun[i] = true; });
        Outcome outcome = run_(cases_[i]);
        change_([&] { progress_.outcomes[i] = std::move(outcome); });
        {
            const std::lock_guard lock(mutex_);
            is_done_[i] = true;
        }
        done_.notify_all();
    }

    std::span<const Case> cases_;
    const std::function<Outcome(const Case&)>& run_;
    SuiteProgress& progress_;
    const std::function<void(const std::function<void()>&)>& change_;
    std::atomic<std::size_t> next_ = 0;
    std::mutex mutex_;
    std::condition_variable done_;
    std::vector<char> is_done_ = std::vector<char>(cases_.size());
    std::exception_ptr error_;
};

/// As many as can be had, up to a number.
std::vector<std::jthread> start_workers(int count, Queue& queue) {
    std::vector<std::jthread> threads;
    threads.reserve(static_cast<std::size_t>(count));
    try {
        for (int i = 0; i < count; ++i) threads.emplace_back([&queue] { queue.work(); });
    } catch (const std::system_error&) { // the others do the work
    }
    return threads;
}

} // namespace

Outcome run_case(const Case& one, PolygonMesh* mesh) {
    Outcome outcome;
    outcome.name = one.name;
    const auto start = std::chrono::steady_clock::now();
    const auto stop = [&outcome, start] {
        outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    try {
        outcome.status = wrong_usage;
        const CaseOptions asked = options_of(one);
        outcome.status = done;
        Reconstruction made = reconstruct_case(one, asked);
        outcome.report = to_json(measure_case(one, asked, made, outcome));
        for (const auto& [key, expected] : one.expect.items()) {
            const std::string reason = miss(key, find_key(outcome.report, key), expected);
            if (!reason.empty()) outcome.misses.push_back(reason);
        }
        stop();
        if (mesh) *mesh = to_polygons(made.mesh);
    } catch (const std::exception& error) {
        stop();
        if (outcome.status == done) outcome.status = status_after(error);
        outcome.failure = message_of(error);
        outcome.misses.push_back(outcome.failure);
    }
    if (one.fails) outcome.misses = misses_of_failure(*one.fails, outcome);
    return outcome;
}

std::vector<Outcome> SuiteProgress::so_far(std::span<const Case> cases) const {
    std::vector<Outcome> all;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (outcomes[i])
            all.push_back(*outcomes[i]);
        else if (begun[i])
            all.push_back(interrupted(cases[i]));
    }
    return all;
}

void run_cases(std::span<const Case> cases, int jobs, const std::function<Outcome(const Case&)>& run,
               SuiteProgress& progress, const std::function<void(const std::function<void()>& make)>& change,
               const std::function<void(const Outcome&)>& show) {
    progress.outcomes.assign(cases.size(), std::nullopt);
    progress.begun.assign(cases.size(), 0);
    Queue queue(cases, run, progress, change);
    const int threads = std::min(jobs, static_cast<int>(std::min<std::size_t>(cases.size(), 256)));
    const std::vector<std::jthread> others =
        threads > 1 ? start_workers(threads, queue) : std::vector<std::jthread>();
    struct Closing {
        Queue& queue;
        ~Closing() { queue.close(); } // the threads are waited for next, also where something was thrown
    } const closing{queue};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (others.empty()) {
            queue.run_next();
        } else {
            queue.wait_for(i);
        }
        show(*progress.outcomes[i]);
    }
}

} // namespace hsdm::command
