#pragma once
// Points on disk, sorted by cells of space: more of them than fit the memory.

#include "hsdm/core/morton.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/io/scratch_bytes.hh"
#include "hsdm/types.hh"

#include <array>
#include <string>
#include <vector>

namespace hsdm {

/// A point and its normal, as they came.
using PointRow = std::array<double, 6>;

/// Points by the cell that each lies in, and as many bytes beside each, in a file as ScratchBytes. The least
/// memory is as large as the largest code of a cell. Only read() and read_beside() are for several threads.
class ScratchPoints {
public:
    /// `expected`: so many points are to come. `buffered`: bytes of memory that may be used, at least one
    /// point's a cell. `beside`: bytes beside a point. Throws Error if the file cannot be made or the disk
    /// has no room for so many.
    ScratchPoints(const ScratchPlace& place, std::size_t expected, std::size_t buffered,
                  std::size_t beside = 0);
    /// Those of a file that is there, as put_index() has told where they are.
    ScratchPoints(const ScratchPlace& place, ByteReader& index, std::size_t buffered, std::size_t beside = 0);

    /// `beside`: that many bytes; null if they are none. Throws Error if the disk is full.
    void add(MortonCode cell, const PointRow& point, const char* beside = nullptr);
    /// To be called after the last point and before the first read().
    void finish();

    /// A cell and how many points it has.
    struct Cell {
        MortonCode code;
        std::size_t points;
    };
    /// Those that have some, ascending.
    std::vector<Cell> cells() const;
    /// Appends the points of a cell in the order that they came in. Throws Error if the file cannot be read.
    void read(MortonCode cell, std::vector<PointRow>& points) const;
    /// Replaces `bytes` by what is beside them. Throws the same.
    void read_beside(MortonCode cell, std::vector<char>& bytes) const;

    std::size_t bytes() const { return file_.size(); } ///< of the file
    void flush_to_disk() const { file_.flush_to_disk(); }
    /// To be called after finish().
    void put_index(std::vector<char>& bytes) const;

private:
    struct Block {
        std::size_t offset, beside, points; ///< bytes where they begin, and how many
    };
    struct Bucket {
        std::vector<Block> blocks;
        std::size_t points = 0;
    };
    Index bucket_of(MortonCode cell);
    const Bucket* find(MortonCode cell) const;
    std::vector<Index> places_of_blocks();
    void flush();
    void flush_beside(const std::vector<Index>& order);

    ScratchBytes file_;
    std::vector<Index> bucket_of_; // per cell, or no_index
    std::vector<Bucket> buckets_;  // as they came
    std::size_t beside_;           // bytes
    std::size_t most_waiting_;
    std::vector<PointRow> waiting_;
    std::vector<Index> waiting_in_; // buckets
    std::vector<char> waiting_beside_;
};

} // namespace hsdm
