#include "hsdm/io/scratch_points.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"
#include "hsdm/io/scratch_file.hh"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace hsdm {
namespace {

std::string reason() {
    return std::strerror(errno);
}

std::string megabytes(std::size_t bytes) {
    return std::to_string((bytes + 999999) / 1000000) + " MB";
}

} // namespace

ScratchPoints::ScratchPoints(const std::string& folder, std::size_t expected, std::size_t buffered)
    : folder_(folder.empty() ? temporary_folder() : folder), most_waiting_(buffered / sizeof(PointRow)) {
    std::error_code failed;
    const std::size_t needed = expected * sizeof(PointRow);
    const std::filesystem::space_info space = std::filesystem::space(folder_, failed);
    if (!failed && space.available < needed)
        throw Error(folder_, "the points take " + megabytes(needed) + " of scratch and there are "
                                 + megabytes(space.available) + "; --scratch names another folder");
    std::string name = (std::filesystem::path(folder_) / "hsdm-XXXXXX").string();
    // Whoever ends the process by a signal waits for the lock, and there is no name before or after.
    const auto lock = FileRegistry::of_process().lock();
    file_ = os::create_with_new_name(name, 0);
    if (file_ < 0)
        throw Error(folder_,
                    "no file for scratch can be made: " + reason() + "; --scratch names another folder");
    os::remove(name);
}

ScratchPoints::~ScratchPoints() {
    os::close(file_);
}

void ScratchPoints::add(MortonCode cell, const PointRow& point) {
    if (!last_ || cell != last_cell_) last_ = &buckets_[cell], last_cell_ = cell;
    last_->waiting.push_back(point);
    ++last_->points;
    if (++waiting_ >= most_waiting_) flush();
}

void ScratchPoints::finish() {
    flush();
}

void ScratchPoints::flush() {
    for (auto& [cell, bucket] : buckets_) {
        Interruption::poll();
        if (bucket.waiting.empty()) continue;
        const std::size_t bytes = bucket.waiting.size() * sizeof(PointRow);
        if (!os::write_all(file_, {reinterpret_cast<const char*>(bucket.waiting.data()), bytes}))
            throw Error(folder_, "the points cannot be written to scratch after " + megabytes(written_) + ": "
                                     + reason() + "; --scratch names another folder");
        bucket.blocks.push_back({written_, bucket.waiting.size()});
        written_ += bytes;
        bucket.waiting = std::vector<PointRow>();
    }
    waiting_ = 0;
}

std::vector<ScratchPoints::Cell> ScratchPoints::cells() const {
    std::vector<Cell> cells;
    cells.reserve(buckets_.size());
    for (const auto& [code, bucket] : buckets_) cells.push_back({code, bucket.points});
    return cells;
}

void ScratchPoints::read(MortonCode cell, std::vector<PointRow>& points) const {
    const auto found = buckets_.find(cell);
    if (found == buckets_.end()) return;
    for (const Block& block : found->second.blocks) {
        const std::size_t at = points.size();
        points.resize(at + block.points);
        char* bytes = reinterpret_cast<char*>(points.data() + at);
        const std::size_t count = block.points * sizeof(PointRow);
        const std::ptrdiff_t some = os::read_all_at(file_, bytes, count, block.offset);
        if (some < 0) throw Error(folder_, "scratch cannot be read: " + reason());
        if (static_cast<std::size_t>(some) < count)
            throw Error(folder_, "scratch cannot be read: the file has become shorter");
    }
}

} // namespace hsdm
