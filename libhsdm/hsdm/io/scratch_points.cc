#include "hsdm/io/scratch_points.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>

namespace hsdm {
namespace {

constexpr const char* the_points = "the points";

} // namespace

ScratchPoints::ScratchPoints(const ScratchPlace& place, std::size_t expected, std::size_t buffered)
    : file_(place), most_waiting_(buffered / sizeof(PointRow)) {
    file_.check_room(the_points, expected * sizeof(PointRow));
}

ScratchPoints::ScratchPoints(const ScratchPlace& place, ByteReader& index, std::size_t buffered)
    : file_(place), most_waiting_(buffered / sizeof(PointRow)) {
    for (auto cells = index.take<std::uint64_t>(); cells > 0; --cells) {
        Bucket& bucket = buckets_[index.take<MortonCode>()];
        bucket.points = index.take<std::size_t>();
        bucket.blocks = index.take_vector<Block>();
    }
}

void ScratchPoints::put_index(std::vector<char>& bytes) const {
    put(std::uint64_t{buckets_.size()}, bytes);
    for (const auto& [cell, bucket] : buckets_) {
        put(cell, bytes), put(bucket.points, bytes);
        put_vector(bucket.blocks, bytes);
    }
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
        bucket.blocks.push_back({file_.append(the_points, bucket.waiting), bucket.waiting.size()});
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
    const std::size_t needed = points.size() + found->second.points;
    if (needed > points.capacity()) points.reserve(std::max(needed, 2 * points.size()));
    for (const Block& block : found->second.blocks) {
        const std::size_t at = points.size();
        resize_unwritten(points, at + block.points);
        file_.read(block.offset, points.data() + at, block.points * sizeof(PointRow));
    }
}

} // namespace hsdm
