#include "hsdm/pipeline/sparse_areas.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/pipeline/bent_facets.hh"
#include "hsdm/pipeline/constants.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {
namespace {

VoxelCoord voxel_at(const Vec3& place, double h) {
    VoxelCoord at;
    for (unsigned k = 0; k < 3; ++k) at[k] = static_cast<std::int32_t>(std::floor(place[k] / h));
    return at;
}

/// Calls visit(voxel) for the occupied ones of the 27 round a place until it returns true; does it?
template <class Visit>
bool any_voxel_round(const OctreeLevel& level, const Vec3& place, Visit&& visit) {
    const VoxelCoord at = voxel_at(place, level.voxel_size);
    const auto look = [&](const VoxelCoord& c) {
        const Index voxel = level.find(c);
        return voxel != no_index && visit(voxel);
    };
    return look(at) || std::ranges::any_of(neighbor_offsets, [&](const VoxelCoord& o) {
               return look({at[0] + o[0], at[1] + o[1], at[2] + o[2]});
           });
}

/// The voxels a surface passes, as points in them fall by chance: of c points in k voxels, on the average m
/// in each that is passed, c / k is m / (1 - exp(-m)). Returns m.
double mean_points(double points_per_occupied) {
    double mean = std::max(points_per_occupied - 1, uneven::fewest_points);
    for (int step = 0; step < 20; ++step) // a contraction from any start
        mean = std::max(points_per_occupied * (1 - std::exp(-mean)), uneven::fewest_points);
    return mean;
}

/// Calls visit(window, points to each voxel that the surface passes, how many it passes) for windows with
/// points enough to tell.
template <class Visit>
void for_telling(std::span<const SparseWindow> windows, const Visit& visit) {
    for (const SparseWindow& window : windows) {
        const auto points = static_cast<double>(window.points);
        if (points < uneven::fewest_of_window) continue;
        const double mean = mean_points(points / static_cast<double>(window.voxels));
        visit(window, mean, points / mean);
    }
}

/// Share of the surface that has fewer points to a level's voxels than `fewest`.
double sparse_share(std::span<const SparseWindow> windows, double fewest) {
    double sparse = 0, all = 0;
    for_telling(windows, [&](const SparseWindow&, double mean, double passed) {
        all += passed;
        if (mean < fewest) sparse += passed;
    });
    return all > 0 ? sparse / all : 0;
}

/// windows_of(above): of the level so many above the finest.
template <class WindowsOf>
int levels_above_sparse(int depth, const WindowsOf& windows_of) {
    if (sparse_share(windows_of(0), uneven::points_per_voxel) <= uneven::most_sparse) return 0;
    int above = 1;
    while (above < std::min(uneven::most_levels, depth - 1)
           && sparse_share(windows_of(above), uneven::points_of_coarsest) > uneven::most_sparse)
        ++above;
    return above;
}

std::vector<SparseWindow> windows_of(const OctreeLevel& level) {
    const OctreeLevel wide = coarser_level(level, level.depth - std::min(level.depth, uneven::window_levels));
    std::vector<SparseWindow> windows = large_vector<SparseWindow>(wide.size());
    Index voxel = 0;
    for (Index w = 0; w < wide.size(); ++w) {
        const Index begin = voxel, end_point = wide.first_point[w + 1];
        while (voxel < level.size() && level.first_point[voxel] < end_point) ++voxel;
        windows[w] = {wide.codes[w], level.codes[begin], level.codes[voxel - 1], voxel - begin,
                      end_point - wide.first_point[w]};
    }
    return windows;
}

} // namespace

Occurrences voxels_too_small(const OctreeLevel& level) {
    double small = 0, all = 0;
    Occurrences result;
    for_telling(windows_of(level), [&](const SparseWindow& window, double mean, double passed) {
        all += passed;
        if (mean >= uneven::points_to_close) return;
        small += passed;
        const VoxelCoord at = morton_decode(window.first_voxel);
        result.add({window.voxels, Vec3(at[0] + 0.5, at[1] + 0.5, at[2] + 0.5) * level.voxel_size});
    });
    return small > uneven::most_sparse * all ? result : Occurrences();
}

void note_coarser_levels(int levels, Report& report) {
    if (levels > 0)
        report.options["resolution"] +=
            ", and up to " + std::to_string(1 << levels) + " times as wide where the points are sparser";
}

int levels_above_sparse(const OctreeLevel& level) {
    return levels_above_sparse(level.depth, [&](int above) {
        return windows_of(above == 0 ? level : coarser_level(level, level.depth - above));
    });
}

SparseWindows::SparseWindows(int depth)
    : depth_(depth), of_level_(static_cast<std::size_t>(std::min(uneven::most_levels, depth)) + 1) {}

void SparseWindows::add(const Octree& part) {
    if (part.size() == 0) return;
    for (std::size_t above = 0; above < of_level_.size(); ++above)
        append(windows_of(extract_level(part, depth_ - static_cast<int>(above))), of_level_[above]);
}

/// The last window so far may go on, and its last voxel.
void SparseWindows::append(std::vector<SparseWindow> next, std::vector<SparseWindow>& all) {
    if (!all.empty() && !next.empty() && all.back().code == next.front().code) {
        const SparseWindow last = all.back();
        all.pop_back();
        SparseWindow& both = next.front();
        both.voxels += last.voxels - (last.last_voxel == both.first_voxel ? 1 : 0);
        both.points += last.points;
        both.first_voxel = last.first_voxel;
    }
    append_large(all, next);
}

void SparseWindows::join(Ranks& ranks) {
    if (ranks.size() == 1) return;
    for (std::vector<SparseWindow>& windows : of_level_) {
        std::vector<SparseWindow> all;
        for (const Ranks::Bytes& got : ranks.gather(bytes_of(windows)))
            append(ByteReader(got).take_rest<SparseWindow>(), all);
        windows = std::move(all);
    }
}

int SparseWindows::levels_above() const {
    return levels_above_sparse(
        depth_, [&](int above) -> const auto& { return of_level_[static_cast<std::size_t>(above)]; });
}

SparseAreas::SparseAreas(const Octree& octree, const OctreeLevel& level, int coarser_levels)
    : octree_(octree), finest_(level), sparse_on_(large_vector<std::uint8_t>(octree.size(), 0)) {
    coarser_.reserve(static_cast<std::size_t>(coarser_levels));
    for (int above = 1; above <= coarser_levels; ++above)
        coarser_.push_back(coarser_level(level, level.depth - above));
    for (int above = 0; above < coarser_levels; ++above) find_sparse(above);
    for (int above = 0; above <= coarser_levels; ++above) {
        const OctreeLevel& at = this->level(above);
        std::vector<std::uint8_t> most = large_vector<std::uint8_t>(at.size());
        for_each_index(at.size(), chunks::usual, [&](Index v) {
            most[v] = *std::max_element(sparse_on_.begin() + at.first_point[v],
                                        sparse_on_.begin() + at.first_point[v + 1]);
        });
        most_sparse_.push_back(std::move(most));
    }
}

bool SparseAreas::lacks(const Vec3& place, const Vec3& normal, int above) const {
    return !is_full(place, normal, above) && is_among_sparse(place, normal, above);
}

bool SparseAreas::is_full(const Vec3& place, const Vec3& normal, int above) const {
    const OctreeLevel& at = level(above);
    int count = 0;
    return any_voxel_round(at, place, [&](Index voxel) {
        for (Index p = at.first_point[voxel]; p < at.first_point[voxel + 1]; ++p)
            if ((octree_.normals[p] | normal) > angles::facing && ++count >= uneven::points_around)
                return true;
        return false;
    });
}

void SparseAreas::find_sparse(int above) {
    for_each_index(octree_.size(), chunks::slow, [&](Index p) {
        if (sparse_on_[p] == above && !is_full(octree_.positions[p], octree_.normals[p], above))
            ++sparse_on_[p];
    });
}

bool SparseAreas::is_among_sparse(const Vec3& place, const Vec3& normal, int above) const {
    for (int wide = above + 1; wide <= static_cast<int>(coarser_.size()); ++wide) {
        const OctreeLevel& at = level(wide);
        const bool found = any_voxel_round(at, place, [&](Index voxel) {
            if (most_sparse_[static_cast<std::size_t>(wide)][voxel] < wide) return false;
            for (Index p = at.first_point[voxel]; p < at.first_point[voxel + 1]; ++p)
                if (sparse_on_[p] >= wide && (octree_.normals[p] | normal) > angles::facing) return true;
            return false;
        });
        if (found) return true;
    }
    return false;
}

CompletedPoints SparseAreas::points_between(const PolygonMesh& facets, int above) const {
    const BentFacets bent(facets, level(above).voxel_size);
    std::vector<CompletedPoints> parts(chunk_count(facets.facet_count(), chunks::heavy));
    for_chunks(facets.facet_count(), chunks::heavy,
               [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                   for (std::size_t f = begin; f < end; ++f)
                       bent.for_places(f, [&](const Vec3& place, const Vec3& normal) {
                           if (!lacks(place, normal, above)) return;
                           parts[chunk].positions.push_back(place);
                           parts[chunk].normals.push_back(normal);
                       });
               });
    CompletedPoints points;
    for (const CompletedPoints& part : parts) {
        points.positions.insert(points.positions.end(), part.positions.begin(), part.positions.end());
        points.normals.insert(points.normals.end(), part.normals.begin(), part.normals.end());
    }
    return points;
}

} // namespace hsdm
