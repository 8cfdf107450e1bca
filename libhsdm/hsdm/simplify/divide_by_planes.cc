#include "hsdm/simplify/divide_by_planes.hh"

#include "hsdm/simplify/constants.hh"

#include <algorithm>
#include <numeric>

namespace hsdm {
namespace {

/// Two adjacent parts, and the root mean square error of their joint planes.
struct Pair {
    Index a, b;
    double rms;
};

class Division {
public:
    Division(std::span<const Quadric> members, std::span<const std::pair<Index, Index>> adjacent,
             const Box& box)
        : planes_(members.begin(), members.end()), box_(box), part_(members.size()) {
        std::iota(part_.begin(), part_.end(), Index{0});
        for (const auto& [a, b] : adjacent) add(std::min(a, b), std::max(a, b));
    }

    std::vector<Index> run(double tolerance) {
        while (!pairs_.empty()) {
            const auto least = std::min_element(pairs_.begin(), pairs_.end(),
                                                [](const Pair& p, const Pair& q) { return p.rms < q.rms; });
            if (least->rms > tolerance) break;
            join(*least);
        }
        for (Index& part : part_)
            while (part_[part] != part) part = part_[part];
        std::size_t parts = 0;
        for (Index i = 0; i < part_.size(); ++i) parts += part_[i] == i;
        return parts <= leaf_parts::most_parts ? part_ : std::vector<Index>();
    }

private:
    void add(Index a, Index b) {
        if (std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& p) { return p.a == a && p.b == b; }))
            return;
        Quadric both = planes_[a];
        both += planes_[b];
        pairs_.push_back({a, b, both.rms(place_in(both, box_))});
    }

    void join(const Pair pair) {
        planes_[pair.a] += planes_[pair.b];
        part_[pair.b] = pair.a;
        std::vector<Pair> old;
        std::erase_if(pairs_, [&](const Pair& p) {
            const bool touched = p.a == pair.a || p.a == pair.b || p.b == pair.a || p.b == pair.b;
            if (touched) old.push_back(p);
            return touched;
        });
        for (const Pair& p : old) {
            const Index a = p.a == pair.b ? pair.a : p.a, b = p.b == pair.b ? pair.a : p.b;
            if (a != b) add(std::min(a, b), std::max(a, b));
        }
    }

    std::vector<Quadric> planes_;
    Box box_;
    std::vector<Index> part_; // per member, a member of the same part, itself for the part's least
    std::vector<Pair> pairs_;
};

} // namespace

Vec3 place_in(const Quadric& planes, const Box& box) {
    Vec3 p = planes.minimum();
    for (unsigned k = 0; k < 3; ++k) p[k] = std::clamp(p[k], box.lo[k], box.hi[k]);
    return p;
}

std::vector<Index> divide_by_planes(std::span<const Quadric> members,
                                    std::span<const std::pair<Index, Index>> adjacent, const Box& box,
                                    double tolerance) {
    if (members.size() > bounds::most_squared) return {};
    return Division(members, adjacent, box).run(tolerance);
}

} // namespace hsdm
