#pragma once
// Numbers that are the same for the same places and facets, whatever their indices: what is known of one mesh
// is known of whatever the next has from it.

#include "hsdm/mesh/triangulate.hh"

#include <cstdint>

namespace hsdm {

/// 64 well mixed bits.
using Key = std::uint64_t;
inline constexpr Key no_key = 0;

Key place_key(const Vec3& place);
/// O(n), parallel.
std::vector<Key> place_keys(std::span<const Vec3> places);

/// Facets are the same if their vertices are, in the same order, and whoever cuts them gets the same
/// triangles. `places`: keys of the vertices. O(corners), parallel.
std::vector<Key> facet_keys(const PolygonMesh& mesh, std::span<const Key> places);
/// Triangles that facets of the mesh are cut into.
std::vector<Key> triangle_keys(const Triangulation& cut, std::span<const Key> places);

/// A set of keys, no_key never among them.
class KeySet {
public:
    /// Takes up to this many keys, and no more.
    explicit KeySet(std::size_t most = 0);
    explicit KeySet(std::span<const Key> keys);

    /// False if the key is there already, or is none. O(1).
    bool insert(Key key);
    bool contains(Key key) const { return key != no_key && slots_[slot_of(key)] == key; }

private:
    /// Where the key is, or is to be.
    std::size_t slot_of(Key key) const {
        std::size_t slot = key >> shift_;
        while (slots_[slot] != no_key && slots_[slot] != key) slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }

    std::vector<Key> slots_; // a power of two, at most half of them taken
    int shift_;
};

/// Where in a list each key is.
class KeyIndex {
public:
    /// The list must outlive it.
    explicit KeyIndex(std::span<const Key> keys);

    /// The first place of the key, or no_index where it is not in the list or no_key. O(1).
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
