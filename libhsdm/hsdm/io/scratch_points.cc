#include "hsdm/io/scratch_points.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <utility>

namespace hsdm {
namespace {

constexpr const char* the_points = "the points";
constexpr std::size_t bytes_waiting = sizeof(PointRow) + 2 * sizeof(Index); // with its bucket and its order

} // namespace

ScratchPoints::ScratchPoints(const ScratchPlace& place, std::size_t expected, std::size_t buffered,
                             std::size_t beside)
    : file_(place), beside_(beside), most_waiting_(buffered / (bytes_waiting + beside)) {
    file_.check_room(the_points, expected * (sizeof(PointRow) + beside));
    const std::size_t waiting = std::min(expected, most_waiting_);
    waiting_.reserve(waiting), waiting_in_.reserve(waiting), waiting_beside_.reserve(waiting * beside);
}

ScratchPoints::ScratchPoints(const ScratchPlace& place, ByteReader& index, std::size_t buffered,
                             std::size_t beside)
    : file_(place), beside_(beside), most_waiting_(buffered / (bytes_waiting + beside)) {
    for (auto cells = index.take<std::uint64_t>(); cells > 0; --cells) {
        Bucket& bucket = buckets_[bucket_of(index.take<MortonCode>())];
        bucket.points = index.take<std::size_t>();
        bucket.blocks = index.take_vector<Block>();
    }
}

void ScratchPoints::put_index(std::vector<char>& bytes) const {
    put(std::uint64_t{buckets_.size()}, bytes);
    for (const Cell& cell : cells()) {
        put(cell.code, bytes), put(cell.points, bytes);
        put_vector(find(cell.code)->blocks, bytes);
    }
}

Index ScratchPoints::bucket_of(MortonCode cell) {
    if (cell >= bucket_of_.size()) bucket_of_.resize(cell + 1, no_index);
    Index& bucket = bucket_of_[cell];
    if (bucket == no_index) bucket = static_cast<Index>(buckets_.size()), buckets_.emplace_back();
    return bucket;
}

const ScratchPoints::Bucket* ScratchPoints::find(MortonCode cell) const {
    const Index bucket = cell < bucket_of_.size() ? bucket_of_[cell] : no_index;
    return bucket == no_index ? nullptr : &buckets_[bucket];
}

void ScratchPoints::add(MortonCode cell, const PointRow& point, const char* beside) {
    const Index bucket = bucket_of(cell);
    waiting_.push_back(point);
    if (beside_ > 0) waiting_beside_.insert(waiting_beside_.end(), beside, beside + beside_);
    waiting_in_.push_back(bucket);
    ++buckets_[bucket].points;
    if (waiting_.size() >= most_waiting_) flush();
}

void ScratchPoints::finish() {
    flush();
    release(waiting_, waiting_in_, waiting_beside_);
}

/// A block for what waits of each cell, in the order of cells; returns their first places, per bucket.
std::vector<Index> ScratchPoints::places_of_blocks() {
    std::vector<Index> place(buckets_.size(), 0);
    for (const Index bucket : waiting_in_) ++place[bucket];
    Index next = 0;
    for (const Index bucket : bucket_of_) {
        if (bucket == no_index || place[bucket] == 0) continue;
        const Index count = std::exchange(place[bucket], next);
        const std::size_t beside = file_.size() + waiting_.size() * sizeof(PointRow) + next * beside_;
        buckets_[bucket].blocks.push_back({file_.size() + next * sizeof(PointRow), beside, count});
        next += count;
    }
    return place;
}

void ScratchPoints::flush() {
    constexpr std::size_t at_once = 1u << 15; // rows that are put in order beside those that wait
    std::vector<Index> place = places_of_blocks(), order = unwritten_vector<Index>(waiting_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[place[waiting_in_[i]]++] = static_cast<Index>(i);
    std::vector<PointRow> rows;
    for (std::size_t begin = 0; begin < order.size(); begin += at_once) {
        Interruption::poll();
        rows.resize(std::min(at_once, order.size() - begin));
        for_each_index(rows.size(), chunks::quick, [&](Index i) { rows[i] = waiting_[order[begin + i]]; });
        file_.append(the_points, rows);
    }
    if (beside_ > 0) flush_beside(order);
    waiting_.clear(), waiting_in_.clear(), waiting_beside_.clear();
}

void ScratchPoints::flush_beside(const std::vector<Index>& order) {
    std::vector<char> bytes = unwritten_vector<char>(waiting_beside_.size());
    for_each_index(order.size(), chunks::quick, [&](Index i) {
        std::copy_n(waiting_beside_.data() + order[i] * beside_, beside_, bytes.data() + i * beside_);
    });
    file_.append(the_points, bytes);
}

std::vector<ScratchPoints::Cell> ScratchPoints::cells() const {
    std::vector<Cell> cells;
    cells.reserve(buckets_.size());
    for (MortonCode code = 0; code < bucket_of_.size(); ++code)
        if (const Bucket* bucket = find(code)) cells.push_back({code, bucket->points});
    return cells;
}

void ScratchPoints::read(MortonCode cell, std::vector<PointRow>& points) const {
    const Bucket* const found = find(cell);
    if (!found) return;
    const std::size_t needed = points.size() + found->points;
    if (needed > points.capacity()) points.reserve(std::max(needed, 2 * points.size()));
    for (const Block& block : found->blocks) {
        const std::size_t at = points.size();
        resize_unwritten(points, at + block.points);
        file_.read(block.offset, points.data() + at, block.points * sizeof(PointRow));
    }
}

void ScratchPoints::read_beside(MortonCode cell, std::vector<char>& bytes) const {
    const Bucket* const found = find(cell);
    resize_unwritten(bytes, found ? found->points * beside_ : 0);
    std::size_t at = 0;
    for (const Block& block : found ? std::span(found->blocks) : std::span<const Block>()) {
        file_.read(block.beside, bytes.data() + at, block.points * beside_);
        at += block.points * beside_;
    }
}

} // namespace hsdm
