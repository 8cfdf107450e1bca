#include "command.hh"

#include "activity.hh"
#include "help_text.hh"
#include "interrupt.hh"
#include "messages.hh"
#include "standard_output.hh"
#include "threads.hh"
#include "usage.hh"

#include "hsdm/core/ranks.hh"
#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"
#include "hsdm/version.hh"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <new>

namespace hsdm::command {
namespace {

/// Asks for none.
void complain_of_memory() {
    std::cerr << "hsdm: " << current_file() << (*current_file() ? ": " : "") << "out of memory in phase "
              << current_phase() << memory_advice << std::endl;
}

int status_of(const Run& run, StandardOutput& output) {
    try {
        const int status = run();
        output.finish();
        return status;
    } catch (const UsageError& error) {
        complain(error.what());
        complain("run with --help for more information");
        return wrong_usage;
    } catch (const OptionError& error) {
        complain(message_of(error));
        return wrong_usage;
    } catch (const std::exception& error) {
        complain(message_of(error));
        return failed;
    }
}

/// Runs a subcommand and reports the temporaries of killed runs that it has removed.
int guarded(const Run& run) {
    try {
        StandardOutput output;
        const int status = status_of(run, output);
        for (const std::string& left : take_removed_leftovers())
            complain("removed " + left + ", left by a run that was killed");
        return status;
    } catch (const std::bad_alloc&) { // there was none for a message either
        complain_of_memory();
        return failed;
    }
}

/// The subcommands in the groups that --help shows them in.
void add_subcommands(CLI::App& app, Run& run) {
    add_reconstruct(app, run, nullptr);
    app.get_subcommand("reconstruct")->group("From points to a mesh");
    add_info(app, run);
    add_compare(app, run);
    for (const char* name : {"info", "compare"}) app.get_subcommand(name)->group("What files hold");
    add_process(app, run);
    add_stages(app, run);
    for (const char* name : {"process", "stages"})
        app.get_subcommand(name)->group("Stages that meshes go through");
    add_regress(app, run);
    app.get_subcommand("regress")->group("Suites");
    add_manual(app, run);
}

/// What `hsdm-mpi` has.
void add_reconstruct_by_ranks(CLI::App& app, Run& run, Ranks& ranks) {
    app.footer("Run by mpirun or srun: the processes share the work, and write the file that one would.\n"
               "Example:\n"
               "  mpirun -n 4 hsdm-mpi reconstruct scan.ply --depth 11 -o part.ply");
    add_reconstruct(app, run, &ranks);
}

/// A standard descriptor that is closed becomes one that cannot be used either: else the next file or pipe
/// that is opened takes its number, and gets what goes there.
void take_standard_descriptors() {
    os::FileStatus status;
    for (const int wanted : {os::standard_input, os::standard_output, os::standard_error})
        if (!os::status_of(wanted, status) && errno == EBADF) {
            if (wanted == os::standard_input)
                os::open_to_write("/dev/null");
            else
                os::open_to_read("/dev/null");
        }
}

/// Ranks that do different things would wait for what does not come.
void check_arguments(int argc, char** argv, Ranks& ranks) {
    Ranks::Bytes own;
    for (int k = 1; k < argc; ++k) append_bytes(argv[k], std::strlen(argv[k]) + 1, own);
    const std::vector<Ranks::Bytes> all = ranks.gather(own);
    if (std::ranges::count(all, own) != ranks.size())
        throw UsageError("the processes have different arguments; give all of them the same");
}

/// The subcommand's status, or the one that the arguments deserve.
int parse_and_run(int argc, char** argv, Ranks* ranks) {
    const std::string name = ranks ? "hsdm-mpi" : "hsdm";
    CLI::App app("scanned points in, CAD-ready meshes out", name);
    app.formatter(help_formatter());
    app.set_help_flag("-h,--help", "print this and end");
    app.set_version_flag("--version", name + " " + version, "print the version and end");
    app.require_subcommand(1);
    app.footer("Points come as PLY, PCD, text and more, meshes go out as OFF, STL, PLY, OBJ or .om;\n"
               "`hsdm SUBCOMMAND --help` tells what a subcommand takes.\n"
               "Examples:\n"
               "  hsdm reconstruct scan.ply -o part.stl\n"
               "  hsdm reconstruct scan.xyz --depth 6 -o part.off --report part.json\n"
               "  hsdm info part.stl\n"
               "  hsdm compare part.off scan.ply");
    Run run;
    if (ranks)
        add_reconstruct_by_ranks(app, run, *ranks);
    else
        add_subcommands(app, run);
    const auto work = [&] {
        if (const auto status = parse_command_line(app, argc, argv)) return *status;
        if (!ranks) handle_signals(); // it has been done there
        start_threads();
        return run();
    };
    return guarded([&] {
        if (!ranks) return work();
        int status = done;
        ranks->together([&] {
            check_arguments(argc, argv, *ranks);
            status = work();
        });
        return status;
    });
}

} // namespace

void complain(const std::string& message) {
    std::cerr << "hsdm: " << printable(message) << std::endl;
}

void prepare_process() {
    os::keep_freed_memory();
    take_standard_descriptors();
}

int run_command(int argc, char** argv, Ranks* ranks) {
    try {
        return parse_and_run(argc, argv, ranks);
    } catch (const std::bad_alloc&) { // while the options are set up
        complain_of_memory();
        return failed;
    }
}

} // namespace hsdm::command
