#include "hsdm/pipeline/work_of_ranks.hh"

#include "hsdm/core/system.hh"
#include "hsdm/io/scratch_bytes.hh"

#include <algorithm>

namespace hsdm {

std::vector<Report::Rank> WorkOfRanks::of_all(Report::Rank own) const {
    own.seconds_waited = ranks_.seconds_waited() - waited_;
    own.seconds = std::chrono::duration<double>(Clock::now() - start_).count() - own.seconds_waited;
    own.bytes_sent = ranks_.bytes_sent() - sent_;
    own.peak_memory_bytes = os::peak_memory();
    own.scratch_bytes = scratch_use().most;
    Ranks::Bytes bytes;
    put(own, bytes);
    std::vector<Report::Rank> all;
    for (const Ranks::Bytes& got : ranks_.gather(bytes)) all.push_back(ByteReader(got).take<Report::Rank>());
    return all;
}

void WorkOfRanks::add_to(std::vector<Report::Rank>& before) const {
    const std::vector<Report::Rank> since = of_all({});
    for (std::size_t r = 0; r < before.size(); ++r) {
        before[r].seconds += since[r].seconds;
        before[r].seconds_waited += since[r].seconds_waited;
        before[r].bytes_sent += since[r].bytes_sent;
        before[r].peak_memory_bytes = since[r].peak_memory_bytes;
        before[r].scratch_bytes = since[r].scratch_bytes;
    }
}

} // namespace hsdm
