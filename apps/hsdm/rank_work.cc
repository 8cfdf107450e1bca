#include "rank_work.hh"

#include "summary.hh"

#include <algorithm>
#include <cstdio>

namespace hsdm::command {
namespace {

std::string megabytes(std::size_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f MB", static_cast<double>(bytes) / 1e6);
    return text;
}

std::string work_line(std::size_t rank, const TileReport::Rank& work) {
    char text[96];
    std::snprintf(text, sizeof text, ", %.2f s of work, %.2f s waited, ", work.seconds, work.seconds_waited);
    return "rank      " + std::to_string(rank) + ": " + counted(work.points, "point", "points") + " in "
           + counted(work.tiles, "tile", "tiles") + text + megabytes(work.bytes_sent) + " sent\n";
}

} // namespace

std::string work_words(const std::vector<TileReport::Rank>& ranks, bool each) {
    double most = 0, sum = 0;
    std::size_t sent = 0;
    for (const TileReport::Rank& work : ranks) {
        most = std::max(most, work.seconds);
        sum += work.seconds;
        sent += work.bytes_sent;
    }
    char uneven[64];
    std::snprintf(uneven, sizeof uneven, "the most work %.2f times the mean",
                  sum > 0 ? most * static_cast<double>(ranks.size()) / sum : 1.0);
    std::string words =
        "ranks     " + std::to_string(ranks.size()) + ": " + uneven + ", " + megabytes(sent) + " exchanged\n";
    for (std::size_t r = 0; each && r < ranks.size(); ++r) words += work_line(r, ranks[r]);
    return words;
}

} // namespace hsdm::command
