#include "mpi_ranks.hh"

#include "interrupt.hh"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>

namespace hsdm::command {
namespace {

/// Counts and places in MPI 3 are of type int: of what is more, so much goes at once to and from all.
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30;

/// Looks ever less often, down to once a millisecond, instead of all the time as MPI would.
void wait(MPI_Request& request) {
    using Pause = std::chrono::microseconds;
    Pause pause(20);
    for (int done = 0;;) {
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done) return;
        std::this_thread::sleep_for(pause);
        pause = std::min(2 * pause, Pause(1000));
    }
}

/// What goes to or comes from each rank, one after the other.
struct Parcel {
    std::vector<char> bytes;
    std::vector<int> counts, places;

    explicit Parcel(std::size_t ranks) : counts(ranks), places(ranks) {}
    void add(std::size_t rank, std::uint64_t count) {
        counts[rank] = static_cast<int>(count);
        places[rank] = static_cast<int>(bytes.size());
        bytes.resize(bytes.size() + count);
    }
};

/// By MPI-IO. Open until the process ends if it is not closed: closing waits for all ranks. Each writes
/// alone, as of MPI_File_write_at_all() of Open MPI 4.1 the others never return where one finds the disk
/// full.
class MpiFile final : public SharedFile {
public:
    explicit MpiFile(MPI_File file) : file_(file) {}

    std::string write_at(std::uint64_t offset, std::string_view bytes) override {
        while (!bytes.empty()) {
            const int count = static_cast<int>(std::min<std::uint64_t>(bytes.size(), most_bytes));
            MPI_Status status;
            const int error = MPI_File_write_at(file_, static_cast<MPI_Offset>(offset), bytes.data(), count,
                                                MPI_CHAR, &status);
            if (error != MPI_SUCCESS) return words_of(error);
            int written = 0;
            MPI_Get_count(&status, MPI_CHAR, &written);
            if (written != count) return "not all was taken; free some space and run again";
            bytes.remove_prefix(static_cast<std::size_t>(count));
            offset += static_cast<std::uint64_t>(count);
        }
        return {};
    }
    std::string close() override {
        const int synced = MPI_File_sync(file_), closed = MPI_File_close(&file_);
        return words_of(synced != MPI_SUCCESS ? synced : closed);
    }

private:
    static std::string words_of(int error) {
        if (error == MPI_SUCCESS) return {};
        char text[MPI_MAX_ERROR_STRING];
        int length = 0;
        MPI_Error_string(error, text, &length);
        return {text, static_cast<std::size_t>(length)};
    }

    MPI_File file_;
};

/// The part of a message of `size` bytes that goes in one round.
std::uint64_t part_of(std::uint64_t size, std::uint64_t begin, std::uint64_t most) {
    return begin < size ? std::min(size - begin, most) : 0;
}

} // namespace

MpiRanks::MpiRanks(int& argc, char**& argv) {
    // The launcher of Open MPI 4.1 may wait for ever for a rank that has ended while it joined the job.
    const auto held = hold_end();
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    if (provided >= MPI_THREAD_SERIALIZED) return;
    MPI_Finalize();
    throw Error("this MPI cannot be used by programs with threads; use another one");
}

MpiRanks::~MpiRanks() {
    leave();
    MPI_Finalize();
}

std::vector<Ranks::Bytes> MpiRanks::gather_bytes(const Bytes& own) {
    const char* too_much = "the ranks have more to tell all others than a message holds";
    if (own.size() > most_bytes) abort(too_much);
    const auto ranks = static_cast<std::size_t>(size_);
    std::vector<int> counts(ranks), places(ranks);
    const int count = static_cast<int>(own.size());
    MPI_Request request;
    MPI_Iallgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, MPI_COMM_WORLD, &request);
    wait(request);
    std::size_t total = 0;
    for (std::size_t r = 0; r < ranks; ++r) {
        places[r] = static_cast<int>(total);
        total += static_cast<std::size_t>(counts[r]);
    }
    if (total > most_bytes) abort(too_much);
    std::vector<char> all;
    try {
        all.resize(total);
    } catch (const std::bad_alloc&) { // the others are in the next step already
        abort("out of memory");
    }
    MPI_Iallgatherv(own.data(), count, MPI_CHAR, all.data(), counts.data(), places.data(), MPI_CHAR,
                    MPI_COMM_WORLD, &request);
    wait(request);
    std::vector<Bytes> got;
    got.reserve(ranks);
    for (std::size_t r = 0; r < ranks; ++r)
        got.emplace_back(all.begin() + places[r], all.begin() + places[r] + counts[r]);
    return got;
}

std::vector<Ranks::Bytes> MpiRanks::exchange_bytes(std::vector<Bytes>&& out,
                                                   const std::vector<std::vector<std::uint64_t>>& sizes) {
    const auto ranks = static_cast<std::size_t>(size_), self = static_cast<std::size_t>(rank_);
    const std::uint64_t most = most_bytes / ranks;
    std::uint64_t longest = 0;
    for (const auto& of_rank : sizes) longest = std::max(longest, std::ranges::max(of_rank));
    std::vector<Bytes> got(ranks);
    for (std::uint64_t begin = 0; begin < longest; begin += most) {
        Parcel sent(ranks), received(ranks);
        for (std::size_t r = 0; r < ranks; ++r) {
            sent.add(r, part_of(out[r].size(), begin, most));
            std::copy_n(out[r].data() + std::min<std::uint64_t>(begin, out[r].size()), sent.counts[r],
                        sent.bytes.data() + sent.places[r]);
            received.add(r, part_of(sizes[r][self], begin, most));
        }
        MPI_Request request;
        MPI_Ialltoallv(sent.bytes.data(), sent.counts.data(), sent.places.data(), MPI_CHAR,
                       received.bytes.data(), received.counts.data(), received.places.data(), MPI_CHAR,
                       MPI_COMM_WORLD, &request);
        wait(request);
        for (std::size_t r = 0; r < ranks; ++r) {
            const auto first = received.bytes.begin() + received.places[r];
            got[r].insert(got[r].end(), first, first + received.counts[r]);
        }
    }
    return got;
}

std::unique_ptr<SharedFile> MpiRanks::open_shared(const std::string& path) {
    MPI_File file;
    const int error = MPI_File_open(MPI_COMM_WORLD, path.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file);
    return error == MPI_SUCCESS ? std::make_unique<MpiFile>(file) : nullptr;
}

void MpiRanks::abort(const std::string& why) noexcept {
    std::fprintf(stderr, "hsdm: rank %d of %d: %s\n", rank_, size_, why.c_str());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
    std::abort(); // which MPI_Abort() does not return to
}

} // namespace hsdm::command
