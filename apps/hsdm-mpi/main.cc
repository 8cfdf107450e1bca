// hsdm-mpi: `hsdm reconstruct` by all processes that mpirun or srun has started.

#include "command.hh"
#include "interrupt.hh"
#include "mpi_ranks.hh"

#include <cstdio>
#include <iostream>

namespace {

class Nothing : public std::streambuf {
    int overflow(int c) override { return traits_type::not_eof(c); }
    std::streamsize xsputn(const char*, std::streamsize count) override { return count; }
};

} // namespace

int main(int argc, char** argv) {
    using namespace hsdm::command;
    static auto& nothing = *new Nothing; // streams are flushed after what is static is gone
    prepare_process();                   // before MPI has memory, descriptors and threads
    handle_signals();                    // which those threads must not take
    try {
        MpiRanks ranks(argc, argv);
        if (ranks.is_first()) return run_command(argc, argv, &ranks);
        // What fails is told by the first rank, which hears of it, and so is the status: mpirun asks all
        // others to end once one has another than 0.
        for (std::ostream* stream : {&std::cout, &std::cerr, &std::clog}) stream->rdbuf(&nothing);
        run_command(argc, argv, &ranks);
        return std::freopen("/dev/null", "w", stderr) ? done : failed; // nor that they are asked to end now
    } catch (const std::exception& error) {
        complain(error.what());
        return failed;
    }
}
