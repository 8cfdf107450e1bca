#include "rank_work.hh"

#include "summary.hh"

#include <cstdio>

namespace hsdm::command {
namespace {

std::string megabytes(std::size_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f MB", static_cast<double>(bytes) / 1e6);
    return text;
}

std::string work_line(std::size_t rank, const Report::Rank& work) {
    char text[96];
    std::snprintf(text, sizeof text, ", %.2f s of work, %.2f s waited, ", work.seconds, work.seconds_waited);
    return "rank      " + std::to_string(rank) + ": " + counted(work.points, "point", "points") + " in "
           + counted(work.tiles, "tile", "tiles") + text + megabytes(work.bytes_sent) + " sent, "
           + megabytes(work.peak_memory_bytes) + " of memory at peak, " + megabytes(work.scratch_bytes)
           + " of scratch\n";
}

} // namespace

std::string work_words(const std::vector<Report::Rank>& ranks, bool each) {
    std::size_t sent = 0;
    for (const Report::Rank& work : ranks) sent += work.bytes_sent;
    char uneven[64];
    std::snprintf(uneven, sizeof uneven, "the most work %.2f times the mean", imbalance_of(ranks));
    std::string words =
        "ranks     " + std::to_string(ranks.size()) + ": " + uneven + ", " + megabytes(sent) + " exchanged\n";
    for (std::size_t r = 0; each && r < ranks.size(); ++r) words += work_line(r, ranks[r]);
    return words;
}

} // namespace hsdm::command
