#pragma once
// Neighbours of the points of parts, on disk, for passes that look at the same parts again.

#include "hsdm/io/scratch_bytes.hh"
#include "hsdm/pipeline/cloud_parts.hh"

#include <optional>

namespace hsdm {

/// Of one cloud, as its points are; once they are others what was found is forgotten. Not for several
/// threads.
class PartStore {
public:
    /// Nothing is kept on a disk with little room.
    PartStore(const ScratchCloud& cloud, int ghost) : first_ghost(ghost), widths(ghost), cloud_(cloud) {}

    const int first_ghost; ///< voxels around a part that is not known
    PartWidths widths;     ///< of the parts

    /// find_neighbors() of a part; where the same were found before, what that gave. Throws Error if the disk
    /// cannot be written or read.
    Neighbors neighbors(const CloudPart& part, const NeighborOptions& options);

private:
    /// The range and what is around it, and how neighbours were sought.
    struct Key {
        MortonCode begin;
        int ghost, count, finest;
        friend auto operator<=>(const Key&, const Key&) = default;
    };
    struct Place {
        std::size_t points, count, leaves, index_at, reach_at, first_at, level_at;
    };
    void keep(const Key& key, const Neighbors& found);
    Neighbors kept(const Place& place) const;

    const ScratchCloud& cloud_;
    std::size_t version_ = 0; // of its points
    std::optional<ScratchBytes> file_;
    std::map<Key, Place> places_;
};

} // namespace hsdm
