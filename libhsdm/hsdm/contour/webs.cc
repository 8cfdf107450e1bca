#include "hsdm/contour/webs.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <deque>

namespace hsdm {
namespace {

/// Per dual vertex the first one of its chain.
std::vector<Index> chains_of(const DualVertices& duals) {
    std::vector<Index> chain(duals.size());
    duals.for_each_chain([&](Index first, Index end) {
        for (Index v = first; v < end; ++v) chain[v] = first;
    });
    return chain;
}

/// The chains of a face's two links in one of its voxels, the lower number first.
using Chains = std::array<Index, 2>;

/// A face whose two links may change partners.
struct Face {
    FacetSide exit, other_exit;
    std::array<Chains, 2> chains; ///< in the lower and in the upper voxel
};

/// A face of a voxel with its chains there.
struct Place {
    Chains chains;
    Index face;
    unsigned end; ///< of the face: 0 the lower voxel
    auto operator<=>(const Place&) const = default;
};

class Webs {
public:
    Webs(const Crossings& crossings, const DualVertices& duals, Links& links)
        : crossings_(crossings),
          duals_(duals),
          links_(links),
          chain_(chains_of(duals)),
          touched_(duals.size(), 0) {
        gather();
    }

    std::size_t open() {
        std::size_t opened = 0;
        for (Index f = 0; f < faces_.size(); ++f)
            for (const unsigned end : {0u, 1u})
                if (is_one(faces_[f].chains[end])) opened += open_from(f, 1 - end);
        return opened;
    }

private:
    static bool is_one(const Chains& chains) { return chains[0] == chains[1]; }

    void gather() {
        for (auto begin = links_.crowded.begin(); begin != links_.crowded.end();) {
            const auto end = std::find(begin, links_.crowded.end(), no_side);
            for (auto a = begin; a != end; ++a)
                for (auto b = a + 1; b != end; ++b) add(*a, *b);
            begin = end + 1;
        }
        for (Index f = 0; f < faces_.size(); ++f)
            for (const unsigned end : {0u, 1u}) places_.push_back({faces_[f].chains[end], f, end});
        std::sort(places_.begin(), places_.end());
        came_from_.assign(faces_.size(), no_index);
    }

    void add(FacetSide exit, FacetSide other_exit) {
        const Link &one = links_.of(exit), &other = links_.of(other_exit);
        if (one.open() || other.open() || !(one.rim || other.rim)) return;
        const std::array<Index, 2> a = duals_.ends(exit), b = duals_.ends(other_exit);
        Face face{exit, other_exit, {}};
        for (const unsigned end : {0u, 1u}) {
            const auto [low, high] = std::minmax(chain_[a[end]], chain_[b[end]]);
            face.chains[end] = {low, high};
        }
        faces_.push_back(face);
    }

    bool is_touched(Index f) const {
        for (const Chains& chains : faces_[f].chains)
            if (touched_[chains[0]] || touched_[chains[1]]) return true;
        return false;
    }

    /// Opens the shortest row of faces that begins with this one, seen towards its given end.
    bool open_from(Index first, unsigned towards) {
        std::vector<Index> seen{first};
        std::deque<std::pair<Index, unsigned>> pending{{first, towards}};
        came_from_[first] = first;
        bool found = false;
        while (!pending.empty() && !found) {
            const auto [f, end] = pending.front();
            pending.pop_front();
            if (is_touched(f)) continue;
            const Chains& chains = faces_[f].chains[end];
            if (is_one(chains)) {
                found = changes_once(f);
                if (found) change_row(f);
                break;
            }
            for (auto at = std::lower_bound(places_.begin(), places_.end(), Place{chains, 0, 0});
                 at != places_.end() && at->chains == chains; ++at) {
                if (came_from_[at->face] != no_index) continue;
                came_from_[at->face] = f;
                seen.push_back(at->face);
                pending.emplace_back(at->face, 1 - at->end);
            }
        }
        for (const Index f : seen) came_from_[f] = no_index;
        return found;
    }

    /// Is each link of the row in one of its faces only, and each chain in one of its voxels' pairs? Else a
    /// change would meet what another has made.
    bool changes_once(Index last) {
        row_.clear();
        ends_.clear();
        for (Index f = last;; f = came_from_[f]) {
            row_.push_back(faces_[f].exit);
            row_.push_back(faces_[f].other_exit);
            ends_.insert(ends_.end(), faces_[f].chains.begin(), faces_[f].chains.end());
            if (came_from_[f] == f) break;
        }
        const auto repeats = [](auto& list) {
            std::sort(list.begin(), list.end());
            return std::adjacent_find(list.begin(), list.end()) != list.end();
        };
        if (repeats(row_)) return false;
        sort_unique(ends_);
        if (std::count_if(ends_.begin(), ends_.end(), is_one) != 2) return false;
        met_.clear();
        for (const Chains& chains : ends_)
            met_.insert(met_.end(), chains.begin() + is_one(chains), chains.end());
        return !repeats(met_);
    }

    /// The row's faces, from its last one back to the first.
    void change_row(Index f) {
        for (;; f = came_from_[f]) {
            change_partners(faces_[f]);
            for (const Chains& chains : faces_[f].chains) touched_[chains[0]] = touched_[chains[1]] = 1;
            if (came_from_[f] == f) return;
        }
    }

    void change_partners(const Face& face) {
        const FacetSide enter = links_.of(face.exit).twin, other_enter = links_.of(face.other_exit).twin;
        const auto join = [&](FacetSide a, FacetSide b) {
            const bool rim = opposed(crossings_.of(a), crossings_.of(b));
            links_.of(a) = {b, rim};
            links_.of(b) = {a, rim};
        };
        join(face.exit, other_enter);
        join(face.other_exit, enter);
    }

    const Crossings& crossings_;
    const DualVertices& duals_;
    Links& links_;
    std::vector<Index> chain_;
    std::vector<std::uint8_t> touched_; // per chain: changed in this round
    std::vector<Face> faces_;
    std::vector<Place> places_;    // sorted
    std::vector<Index> came_from_; // per face during a search, the one before it
    std::vector<FacetSide> row_;   // links of a row
    std::vector<Chains> ends_;     // its chains by voxel
    std::vector<Index> met_;       // and one by one
};

} // namespace

std::size_t open_webs(const Crossings& crossings, const DualVertices& duals, Links& links) {
    return Webs(crossings, duals, links).open();
}

std::size_t open_all_webs(const NormalSets& sets, double voxel_size, DualMesh& dual) {
    std::size_t opened = 0;
    while (const std::size_t rows = open_webs(dual.crossings, dual.duals, dual.links)) {
        opened += rows;
        dual.duals = build_dual_vertices(dual.grid, dual.crossings, sets, voxel_size, dual.links);
    }
    return opened;
}

} // namespace hsdm
