#include "hsdm/pipeline/cloud_distance.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/system.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/spatial/facet_cells.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

/// Facets by the cell of the cloud that the first vertex of each lies in: all, or those near some cells.
class NearFacets {
public:
    NearFacets(const ScratchCloud& cloud, const PolygonMesh& facets)
        : cloud_(cloud), facets_(facets), cell_size_(std::ldexp(cloud.cube_extent(), -cloud.cell_depth())) {
        find_cells();
        std::vector<double> longest = large_vector<double>(facets.facet_count());
        for_each_index(cell_.size(), chunks::quick, [&](Index f) {
            for (const Index v : facets.facet(f))
                longest[f] =
                    std::max(longest[f], (facets.positions[v] - facets.positions[facets.facet(f)[0]]).norm());
        });
        if (!longest.empty()) longest_ = std::ranges::max(longest);
    }
    /// `longest`: of all facets.
    NearFacets(const ScratchCloud& cloud, const PolygonMesh& some, double longest)
        : cloud_(cloud),
          facets_(some),
          cell_size_(std::ldexp(cloud.cube_extent(), -cloud.cell_depth())),
          longest_(longest) {
        find_cells();
    }

    double longest() const { return longest_; } ///< way from a facet's first vertex to another one
    int all_cells() const { return 1 << cloud_.cell_depth(); }

    /// Far enough for points that are within a few voxels of the facets.
    int first_reach() const {
        const double far = longest_ + 2 * cloud_.voxel_size();
        return static_cast<int>(std::min(std::ceil(far / cell_size_), 1.0 * all_cells()));
    }

    /// The nearest facet of a point in one of some cells is among those whose first vertex is at most `reach`
    /// cells from them, if it is no farther than this.
    double known(int reach) const {
        if (reach >= all_cells()) return Box::inf;
        return std::max(0.0, reach * cell_size_ - longest_);
    }

    /// Those facets, in their order.
    PolygonMesh around(const std::vector<Index>& cells, int reach) const {
        const auto side = static_cast<std::size_t>(all_cells());
        std::vector<std::uint8_t> is_near = large_vector<std::uint8_t>(side * side * side);
        for (const Index cell : cells) {
            const VoxelCoord at = morton_decode(cell);
            CellRange around{at, at};
            for (std::size_t k = 0; k < 3; ++k) {
                around.lo[k] = std::max(0, at[k] - reach);
                around.hi[k] = std::min(all_cells() - 1, at[k] + reach);
            }
            around.for_each([&](const VoxelCoord& c) { is_near[morton_encode(c)] = 1; });
        }
        return part_of(
            facets_, indices_where(cell_.size(), chunks::light, [&](Index f) { return is_near[cell_[f]]; }));
    }

private:
    void find_cells() {
        const int shift = 3 * (morton_levels - cloud_.cell_depth());
        cell_ = large_vector<Index>(facets_.facet_count());
        for_each_index(cell_.size(), chunks::quick, [&](Index f) {
            const Vec3& first = facets_.positions[facets_.facet(f)[0]];
            cell_[f] = static_cast<Index>(code_at(first, cloud_.cube_extent()) >> shift);
        });
    }

    const ScratchCloud& cloud_;
    const PolygonMesh& facets_;
    double cell_size_, longest_ = 0;
    std::vector<Index> cell_;
};

std::vector<Index> cells_of(std::span<const MortonCode> codes, int shift) {
    std::vector<Index> cells;
    for (const MortonCode code : codes) {
        const auto cell = static_cast<Index>(code >> shift);
        if (cells.empty() || cells.back() != cell) cells.push_back(cell);
    }
    return cells;
}

/// Some points of many.
struct Points {
    std::span<const Vec3> positions;
    std::span<const MortonCode> codes;
    int shift; ///< from a code to its cell
};

/// The distances of those that are due to the facets within `reach` of their cells; due are then those to
/// which others may be nearer.
void look_around(const Points& points, const NearFacets& near, double voxel, int reach,
                 std::vector<double>& squared, std::vector<Index>& due) {
    std::vector<Vec3> places = large_vector<Vec3>(due.size());
    std::vector<MortonCode> at = large_vector<MortonCode>(due.size());
    for_each_index(due.size(), chunks::light,
                   [&](Index i) { places[i] = points.positions[due[i]], at[i] = points.codes[due[i]]; });
    const PolygonMesh facets = near.around(cells_of(at, points.shift), reach);
    if (facets.facet_count() > 0) {
        const FacetCells cells(facets, voxel);
        const std::vector<double> found = squared_distances_by_cells(places, facets, cells);
        for_each_index(due.size(), chunks::light, [&](Index i) { squared[due[i]] = found[i]; });
    }
    const double known = near.known(reach);
    std::erase_if(due, [&](Index i) { return std::sqrt(squared[i]) <= known; });
}

std::vector<Index> all_of(std::size_t count) {
    return indices_where(count, chunks::light, [](Index) { return true; });
}

/// bytes_for(rank) of the first one for each other in turn, so that it has room for one of them.
Ranks::Bytes pass_from_first(Ranks& ranks, const std::function<Ranks::Bytes(std::size_t)>& bytes_for) {
    Ranks::Bytes own;
    const auto size = static_cast<std::size_t>(ranks.size());
    for (std::size_t receiver = 1; receiver < size; ++receiver) {
        std::vector<Ranks::Bytes> out(size);
        if (ranks.is_first()) out[receiver] = bytes_for(receiver);
        std::vector<Ranks::Bytes> got = ranks.exchange(std::move(out));
        if (receiver == static_cast<std::size_t>(ranks.rank())) own = std::move(got.front());
    }
    return own;
}

/// Each rank gets the facets around these cells, of which it has points.
void send_facets(const NearFacets& near, const std::vector<std::vector<Index>>& cells, int reach,
                 Ranks& ranks) {
    pass_from_first(ranks, [&](std::size_t rank) {
        Ranks::Bytes bytes;
        if (cells[rank].empty()) return bytes;
        const PolygonMesh facets = near.around(cells[rank], reach);
        put(near.longest(), bytes);
        put_vector(facets.positions, bytes);
        put_vector(facets.first, bytes);
        put_vector(facets.corners, bytes);
        return bytes;
    });
}

/// Some facets of all, and how long one of all is.
struct SomeFacets {
    PolygonMesh mesh;
    double longest = 0;
};

SomeFacets receive_facets(Ranks& ranks) {
    const Ranks::Bytes got = pass_from_first(ranks, {});
    SomeFacets some;
    if (got.empty()) return some;
    ByteReader reader(got);
    some.longest = reader.take<double>();
    some.mesh.positions = reader.take_vector<Vec3>();
    some.mesh.first = reader.take_vector<Index>();
    some.mesh.corners = reader.take_vector<Index>();
    return some;
}

std::vector<std::vector<Index>> cells_of_ranks(const ScratchCloud& cloud) {
    std::vector<std::vector<Index>> cells(static_cast<std::size_t>(cloud.ranks().size()));
    for (const ScratchPoints::Cell& cell : cloud.cells())
        cells[static_cast<std::size_t>(cloud.owner(cell.code))].push_back(static_cast<Index>(cell.code));
    return cells;
}

/// Gives ranks the facets farther off that they ask for.
void serve_far_points(const NearFacets& near, Ranks& ranks) {
    for (int reach = 2 * near.first_reach(); ranks.any(false); reach *= 2) {
        std::vector<std::vector<Index>> cells;
        for (const Ranks::Bytes& got :
             ranks.exchange(std::vector<Ranks::Bytes>(static_cast<std::size_t>(ranks.size()))))
            cells.push_back(ByteReader(got).take_rest<Index>());
        send_facets(near, cells, reach, ranks);
    }
}

/// Distances that come in the order of the points, and what they add up to.
class Measured {
public:
    explicit Measured(const ScratchCloud& cloud) : sums_(std::numbers::sqrt3 * cloud.voxel_size()) {}

    void add(const std::vector<double>& squared, const auto& position_of) {
        const std::size_t before = sums_.count();
        sums_.add(squared);
        const Distance so_far = sums_.result();
        if (off_.count == 0 && so_far.beyond > 0) {
            first_off_ = so_far.first_beyond;
            off_.first = position_of(first_off_ - before);
        }
        off_.count = so_far.beyond;
    }

    const Occurrences& off() const { return off_; }      ///< relative to the cube
    std::size_t first_off() const { return first_off_; } ///< which one, if there is one
    Distance result() const { return sums_.result(); }

private:
    DistanceSums sums_;
    Occurrences off_;
    std::size_t first_off_ = 0;
};

/// What a rank has to tell the first: distances of all its points, and the first place that is far off.
class OwnDistances {
public:
    explicit OwnDistances(const ScratchCloud& cloud)
        : cloud_(cloud), shift_(3 * (morton_levels - cloud.cell_depth())) {}

    void measure(std::size_t most_points) {
        const SomeFacets some = receive_facets(cloud_.ranks());
        const NearFacets near(cloud_, some.mesh, some.longest);
        Measured here(cloud_);
        reach_ = near.first_reach();
        cloud_.for_groups(most_points, [&](const Octree& part) {
            if (part.size() > 0) measure_near(part, near, here);
            os::give_back_freed_memory();
        });
        first_off_ = here.off().count > 0 ? here.first_off() : squared_.size();
        place_off_ = here.off().first;
    }

    /// Points whose nearest facet may be one that was not sent.
    void measure_far() {
        Ranks& ranks = cloud_.ranks();
        std::vector<double> squared = large_vector<double>(far_.size(), Box::inf);
        std::vector<Index> due = all_of(far_.size());
        while (ranks.any(!due.empty())) {
            std::vector<MortonCode> codes(due.size());
            std::ranges::transform(due, codes.begin(), [&](Index i) { return codes_[i]; });
            std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks.size()));
            out.front() = bytes_of(cells_of(codes, shift_));
            ranks.exchange(std::move(out));
            const SomeFacets some = receive_facets(ranks);
            const NearFacets near(cloud_, some.mesh, some.longest);
            reach_ *= 2;
            if (!due.empty())
                look_around({positions_, codes_, shift_}, near, cloud_.voxel_size(), reach_, squared, due);
        }
        take_far(squared);
    }

    const std::vector<double>& squared() const { return squared_; }
    const Vec3& place_off() const { return place_off_; }

private:
    void measure_near(const Octree& part, const NearFacets& near, Measured& here) {
        std::vector<double> squared = large_vector<double>(part.size(), Box::inf);
        std::vector<Index> due = all_of(part.size());
        look_around({part.positions, part.codes, shift_}, near, cloud_.voxel_size(), reach_, squared, due);
        for (const Index i : due) {
            far_.push_back(squared_.size() + i);
            positions_.push_back(part.positions[i]), codes_.push_back(part.codes[i]);
            squared[i] = 0; // it is looked at later
        }
        here.add(squared, [&](std::size_t i) { return part.positions[i]; });
        append_large(squared_, squared);
    }

    void take_far(const std::vector<double>& squared) {
        Measured there(cloud_);
        there.add(squared, [&](std::size_t i) { return positions_[i]; });
        if (there.off().count > 0 && far_[there.first_off()] < first_off_) place_off_ = there.off().first;
        for (std::size_t i = 0; i < far_.size(); ++i) squared_[far_[i]] = squared[i];
    }

    const ScratchCloud& cloud_;
    const int shift_;
    int reach_ = 0;
    std::vector<double> squared_;
    std::size_t first_off_ = 0;
    Vec3 place_off_{0, 0, 0};
    std::vector<std::size_t> far_; // those left for later: which, where
    std::vector<Vec3> positions_;
    std::vector<MortonCode> codes_;
};

/// Of one rank after the other, so that the first has room for one of them.
void pass_to_first(const OwnDistances* own, Ranks& ranks, const std::function<void(ByteReader&)>& receive) {
    for (int sender = 1; sender < ranks.size(); ++sender) {
        std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks.size()));
        if (sender == ranks.rank()) {
            put(own->place_off(), out.front());
            put_vector(own->squared(), out.front());
        }
        const std::vector<Ranks::Bytes> got = ranks.exchange(std::move(out));
        if (!ranks.is_first()) continue;
        ByteReader reader(got[static_cast<std::size_t>(sender)]);
        receive(reader);
    }
}

} // namespace

Distance cloud_distance(const ScratchCloud& cloud, const PolygonMesh& facets, std::size_t most_points,
                        Occurrences& off) {
    Ranks& ranks = cloud.ranks();
    const NearFacets near(cloud, facets);
    const int shift = 3 * (morton_levels - cloud.cell_depth());
    if (ranks.size() > 1) send_facets(near, cells_of_ranks(cloud), near.first_reach(), ranks);
    Measured all(cloud);
    cloud.for_groups(most_points, [&](const Octree& part) {
        if (part.size() == 0) return;
        std::vector<double> squared = large_vector<double>(part.size(), Box::inf);
        std::vector<Index> due = all_of(part.size());
        for (int reach = near.first_reach(); !due.empty(); reach *= 2)
            look_around({part.positions, part.codes, shift}, near, cloud.voxel_size(), reach, squared, due);
        all.add(squared, [&](std::size_t i) { return part.positions[i]; });
        os::give_back_freed_memory();
    });
    if (ranks.size() > 1) serve_far_points(near, ranks);
    pass_to_first(nullptr, ranks, [&](ByteReader& reader) {
        const Vec3 first_off = reader.take<Vec3>();
        all.add(reader.take_vector<double>(), [&](std::size_t) { return first_off; });
    });
    off = all.off();
    if (off.count > 0) off.first += cloud.origin();
    return all.result();
}

void assist_cloud_distance(const ScratchCloud& cloud, std::size_t most_points) {
    OwnDistances own(cloud);
    own.measure(most_points);
    own.measure_far();
    pass_to_first(&own, cloud.ranks(), {});
}

} // namespace hsdm
