#include "hsdm/pipeline/part_store.hh"

namespace hsdm {
namespace {

constexpr const char* the_neighbors = "neighbours of points";

std::size_t bytes_of(const Neighbors& found) {
    return found.index.size() * sizeof(Index) + found.reach.size() * sizeof(double)
           + found.leaf_first.size() * sizeof(Index) + found.leaf_level.size();
}

} // namespace

Neighbors PartStore::neighbors(const CloudPart& part, const NeighborOptions& options) {
    if (!file_ || version_ != cloud_.version()) {
        places_.clear();
        file_.emplace(ScratchPlace{cloud_.scratch_folder(), {}, 0});
        version_ = cloud_.version();
    }
    const Key key{part.range().begin, part.ghost(), options.count, options.finest_level.value_or(-1)};
    const auto found = places_.find(key);
    if (found != places_.end() && found->second.points == part.octree().size()) return kept(found->second);
    Neighbors made = find_neighbors(part.octree(), options);
    // What has to be written later, points with their normals, must not fail for this.
    if (file_->has_room(2 * bytes_of(made) + 2 * cloud_.bytes())) keep(key, made);
    return made;
}

void PartStore::keep(const Key& key, const Neighbors& found) {
    Place place{found.reach.size(), found.count, found.leaf_level.size(), 0, 0, 0, 0};
    place.index_at = file_->append(the_neighbors, found.index);
    place.reach_at = file_->append(the_neighbors, found.reach);
    place.first_at = file_->append(the_neighbors, found.leaf_first);
    place.level_at = file_->append(the_neighbors, found.leaf_level);
    places_[key] = place;
}

Neighbors PartStore::kept(const Place& place) const {
    Neighbors found;
    found.count = place.count;
    file_->read(place.index_at, place.points * place.count, found.index);
    file_->read(place.reach_at, place.points, found.reach);
    file_->read(place.first_at, place.leaves + 1, found.leaf_first);
    file_->read(place.level_at, place.leaves, found.leaf_level);
    return found;
}

} // namespace hsdm
