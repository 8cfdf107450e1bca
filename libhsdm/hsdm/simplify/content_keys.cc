#include "hsdm/simplify/content_keys.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/hash.hh"

#include <bit>

namespace hsdm {
namespace {

constexpr std::size_t keys_per_chunk = 2048;

Key ring_key(std::span<const Index> ring, std::span<const Key> places) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < ring.size(); ++i)
        if (places[ring[i]] < places[ring[least]]) least = i;
    Key key = ring.size();
    for (std::size_t i = least; i < ring.size(); ++i) key = hash_index(key ^ places[ring[i]]);
    for (std::size_t i = 0; i < least; ++i) key = hash_index(key ^ places[ring[i]]);
    // How a polygon is cut depends on where its ring starts, so that is part of its key.
    return ring.size() > 3 ? hash_index(key ^ least) : key;
}

} // namespace

Key place_key(const Vec3& place) {
    Key key = 1;
    for (unsigned k = 0; k < 3; ++k) key = hash_index(key ^ std::bit_cast<Key>(place[k]));
    return key;
}

std::vector<Key> place_keys(std::span<const Vec3> places) {
    std::vector<Key> keys(places.size());
    for_chunks(keys.size(), keys_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) keys[i] = place_key(places[i]);
    });
    return keys;
}

std::vector<Key> facet_keys(const PolygonMesh& mesh, std::span<const Key> places) {
    std::vector<Key> keys(mesh.facet_count());
    for_chunks(keys.size(), keys_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t f = begin; f < end; ++f) keys[f] = ring_key(mesh.facet(f), places);
    });
    return keys;
}

std::vector<Key> triangle_keys(const Triangulation& cut, std::span<const Key> places) {
    std::vector<Key> keys(cut.size());
    for_chunks(keys.size(), keys_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t t = begin; t < end; ++t) keys[t] = ring_key(cut.triangles[t], places);
    });
    return keys;
}

KeySet::KeySet(std::size_t most)
    : slots_(std::bit_ceil(2 * most + 2), no_key), shift_(64 - std::countr_zero(slots_.size())) {}

KeyIndex::KeyIndex(std::span<const Key> keys)
    : keys_(keys),
      slots_(std::bit_ceil(2 * keys.size() + 2), no_index),
      shift_(64 - std::countr_zero(slots_.size())) {
    for (Index i = 0; i < keys.size(); ++i) {
        if (keys[i] == no_key) continue;
        Index& slot = slots_[slot_of(keys[i])];
        if (slot == no_index) slot = i;
    }
}

KeySet::KeySet(std::span<const Key> keys) : KeySet(keys.size()) {
    for (const Key key : keys) insert(key);
}

bool KeySet::insert(Key key) {
    Key& slot = slots_[slot_of(key)];
    if (key == no_key || slot == key) return false;
    slot = key;
    return true;
}

} // namespace hsdm
