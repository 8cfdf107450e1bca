// hsdm reconstruct: clouds in, meshes out.

#include "command.hh"
#include "interrupt.hh"
#include "reconstruct_arguments.hh"
#include "reconstruct_output.hh"
#include "summary.hh"

#include "hsdm/errors.hh"

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <chrono>
#include <iostream>
#include <span>

namespace hsdm::command {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Throws Cancelled between two steps after an interrupt.
void stop_if_interrupted() {
    if (interrupted()) throw Cancelled();
}

PointFile read_input(const std::string& input, const ReadOptions& options) {
    const InterruptEndsProcess while_reading;
    return read_points(input, options);
}

class ReconstructRun {
public:
    explicit ReconstructRun(const ReconstructArguments& arguments)
        : arguments_(arguments),
          options_(arguments.options()),
          levels_(arguments.level_range()),
          plan_(arguments),
          text_(plan_.uses_standard_output() ? std::cerr : std::cout) {
        options_.measure = !arguments.quiet || !arguments.report.empty();
        options_.classify = options_.measure || plan_.writes_features();
        options_.vertex_normals = plan_.writes_properties();
    }

    int run() {
        for (const std::string& input : arguments_.inputs) {
            stop_if_interrupted();
            if (arguments_.inputs.size() == 1) {
                reconstruct_one(input);
            } else {
                try_one(input);
            }
        }
        if (arguments_.inputs.size() > 1 && !arguments_.quiet)
            text_ << grouped(arguments_.inputs.size() - failures_) << " of "
                  << grouped(arguments_.inputs.size()) << " inputs done, " << grouped(failures_)
                  << " failed, " << grouped(points_) << " points, " << grouped(faces_) << " faces\n";
        write_report();
        return failures_ == 0 ? done : failed;
    }

private:
    /// A failure is told and noted; the other inputs go on.
    void try_one(const std::string& input) {
        try {
            reconstruct_one(input);
        } catch (const Cancelled&) {
            throw;
        } catch (const OptionError&) {
            throw;
        } catch (const std::exception& error) {
            ++failures_;
            complain(error.what());
            nlohmann::ordered_json entry = {{"input", {{"file", input}}}, {"failure", error.what()}};
            reports_.push_back(entry.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                               + '\n');
        }
    }

    /// What make() returns; its errors begin with a name.
    template <class Make>
    static auto named(const std::string& name, Make make) {
        try {
            return make();
        } catch (const Error& error) {
            throw Error(name, error.what());
        }
    }

    void reconstruct_one(const std::string& input) {
        const auto start = Clock::now();
        const std::string name = input == "-" ? "standard input" : input;
        ProgressBar bar(arguments_.progress, name);
        bar.show("read", 0);
        PointFile file = read_input(input, arguments_.read);
        const double read_seconds = seconds_since(start);
        stop_if_interrupted();
        ReconstructOptions options = options_;
        options.progress = [&bar](const char* phase, double share) {
            bar.show(phase, 0.1 + 0.85 * share);
            return !interrupted();
        };
        const std::size_t points = file.cloud.size();
        const auto write = [&](std::span<Reconstruction> results) {
            points_ += points;
            for (Reconstruction& result : results) {
                bar.show("write", 0.97);
                result.report.input.file = input;
                result.report.seconds.read = read_seconds;
                write_one(input, result, start);
            }
        };
        if (levels_) {
            std::vector<Reconstruction> results = named(name, [&] {
                return reconstruct_levels(std::move(file.cloud), levels_->first, levels_->second, options);
            });
            write(results);
        } else {
            Reconstruction result = named(name, [&] { return reconstruct(std::move(file.cloud), options); });
            write({&result, 1});
        }
    }

    void write_one(const std::string& input, Reconstruction& result, Clock::time_point start) {
        Report& report = result.report;
        const MeshTarget target =
            plan_.target(input, levels_ ? std::optional<int>(report.grid.depth) : std::nullopt);
        const auto write_start = Clock::now();
        write_outputs(target, result.mesh);
        report.seconds.write = seconds_since(write_start);
        report.seconds.total = seconds_since(start);
        faces_ += report.mesh.faces;
        reports_.push_back(to_json(report));
        if (arguments_.quiet) return;
        const std::string written = target.mesh == "-" ? "standard output" : target.mesh;
        const bool single = arguments_.inputs.size() == 1 && !levels_;
        if (single) {
            print_summary(text_, report, written);
        } else {
            print_line(text_, report, written);
        }
        if (arguments_.verbose) print_details(text_, report);
    }

    /// One mesh: its report; several: a list of them in the order they were made.
    void write_report() const {
        if (arguments_.report.empty()) return;
        if (arguments_.inputs.size() == 1 && !levels_) {
            write_text(arguments_.report, reports_.front());
            return;
        }
        std::string text = "[\n";
        for (std::size_t i = 0; i < reports_.size(); ++i)
            text += reports_[i] + (i + 1 < reports_.size() ? ",\n" : "");
        write_text(arguments_.report, text + "]\n");
    }

    const ReconstructArguments& arguments_;
    ReconstructOptions options_;
    std::optional<std::pair<int, int>> levels_;
    OutputPlan plan_;
    std::ostream& text_;
    std::vector<std::string> reports_;
    std::size_t failures_ = 0, points_ = 0, faces_ = 0;
};

} // namespace

void add_reconstruct(CLI::App& app, Run& run) {
    CLI::App* const sub = app.add_subcommand("reconstruct", "point clouds in, meshes out");
    const auto arguments = std::make_shared<ReconstructArguments>();
    add_file_options(*sub, *arguments);
    add_method_options(*sub, *arguments);
    sub->footer("Examples:\n"
                "  hsdm reconstruct scan.ply -o part.stl\n"
                "  hsdm reconstruct scan.xyz --depth 6 -o part.off --features part.txt --report part.json\n"
                "  hsdm reconstruct scan.ply --levels 4:7 -o part.ply\n"
                "  hsdm reconstruct *.xyz --out-dir meshes --format stl\n"
                "  cat scan.xyz | hsdm reconstruct - --input-format xyz -o - --format off > part.off");
    sub->callback([&run, arguments] {
        run = [arguments] {
            std::optional<tbb::global_control> bound;
            if (arguments->threads > 0)
                bound.emplace(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(arguments->threads));
            return ReconstructRun(*arguments).run();
        };
    });
}

} // namespace hsdm::command
