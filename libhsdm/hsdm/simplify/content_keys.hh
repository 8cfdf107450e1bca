#pragma once
// Keys (hashes) of places and facets by coordinates, not by indices, so that what is known of one mesh is
// known of the same parts of the next.

#include "hsdm/mesh/triangulate.hh"

#include <cstdint>

namespace hsdm {

/// 64 well mixed bits.
using Key = std::uint64_t;
inline constexpr Key no_key = 0;

Key place_key(const Vec3& place);
/// O(n), parallel.
std::vector<Key> place_keys(std::span<const Vec3> places);

/// Keys of facets, equal if their vertices lie at the same places in the same order and whoever cuts them
/// gets the same triangles. `places`: keys of the vertices. O(corners), parallel.
std::vector<Key> facet_keys(const PolygonMesh& mesh, std::span<const Key> places);
/// Keys of the triangles that the facets of a mesh are cut into.
std::vector<Key> triangle_keys(const Triangulation& cut, std::span<const Key> places);

/// A set of keys, no_key never among them.
class KeySet {
public:
    /// An empty set for up to this many keys, and no more.
    explicit KeySet(std::size_t most = 0);
    explicit KeySet(std::span<const Key> keys);

    /// False if the key is in the set already, or is no_key. O(1).
    bool insert(Key key);
    bool contains(Key key) const { return key != no_key && slots_[slot_of(key)] == key; }

private:
    /// The slot that the key has or would get.
    std::size_t slot_of(Key key) const {
        std::size_t slot = key >> shift_;
        while (slots_[slot] != no_key && slots_[slot] != key) slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }

    std::vector<Key> slots_; // a power of two, at most half of them taken
    int shift_;
};

/// The position in a list of each of its keys.
class KeyIndex {
public:
    /// The list must outlive it.
    explicit KeyIndex(std::span<const Key> keys);

    /// The first position of the key in the list, or no_index if it is not there or is no_key. O(1).
    Index find(Key key) const { return key == no_key ? no_index : slots_[slot_of(key)]; }

private:
    std::size_t slot_of(Key key) const {
        std::size_t slot = key >> shift_;
        while (slots_[slot] != no_index && keys_[slots_[slot]] != key)
            slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }

    std::span<const Key> keys_;
    std::vector<Index> slots_; // a power of two, at most half of them taken
    int shift_;
};

} // namespace hsdm
