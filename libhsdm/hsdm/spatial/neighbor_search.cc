#include "hsdm/spatial/neighbor_search.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/lanes.hh"
#include "hsdm/core/radix_sort.hh"
#include "hsdm/point_cloud.hh"
#include "hsdm/spatial/point_triangle.hh"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <tbb/parallel_invoke.h>

#include <cmath>
#include <limits>
#include <memory_resource>
#include <mutex>
#include <numeric>

// FLANN's k-d tree is all in its headers. Four members are specialised for a metric that is nobody else's:
// what it would take from lz4, how it asks for memory (an allocation that fails would print a line and end in
// a null pointer) and that it does so for every query.
namespace hsdm::kd_tree {

/// Memory of nodes, all freed at once.
class Nodes {
public:
    void* take(std::size_t bytes, std::size_t alignment) {
        const std::lock_guard lock(mutex_);
        return memory_.allocate(bytes, alignment);
    }

private:
    std::mutex mutex_;
    std::pmr::monotonic_buffer_resource memory_;
};

/// Squared distance.
struct Metric : flann::L2_3D<double> {
    explicit Metric(Nodes& memory) : nodes(&memory) {}
    Nodes* nodes;
};

/// Points of a subtree that is worth a task of its own.
constexpr int least_task = 1 << 14;

/// What takes the points that a search comes past, and the search's own memory.
struct Taker : flann::ResultSet<double> {
    std::vector<double> sides; ///< squared distance from the box of the points looked at, by axis
};

} // namespace hsdm::kd_tree

namespace flann {

using HsdmTree = KDTreeSingleIndex<hsdm::kd_tree::Metric>;

template <>
inline void HsdmTree::saveIndex(FILE*) {}
template <>
inline void HsdmTree::loadIndex(FILE*) {}

/// Builds the tree over the points vind_[left] .. vind_[right - 1], whose box becomes `box`.
template <>
inline auto HsdmTree::divideTree(int left, int right, BoundingBox& box) -> NodePtr {
    Node* const node = new (distance_.nodes->take(sizeof(Node), alignof(Node))) Node();
    node->left = left;
    node->right = right;
    if (right - left <= leaf_max_size_) {
        hsdm::Box tight;
        for (auto i = vind_.begin() + left; i != vind_.begin() + right; ++i) {
            const double* const p = points_[static_cast<std::size_t>(*i)];
            tight.add(hsdm::Vec3(p[0], p[1], p[2]));
        }
        for (unsigned axis = 0; axis < 3; ++axis)
            box[axis].low = tight.lo[axis], box[axis].high = tight.hi[axis];
        return node;
    }
    int count = 0;
    double cut = 0;
    middleSplit(vind_.data() + left, right - left, count, node->divfeat, cut, box);
    const auto axis = static_cast<std::size_t>(node->divfeat);
    BoundingBox low(box), high(box);
    low[axis].high = high[axis].low = cut;
    const auto build_low = [&] { node->child1 = divideTree(left, left + count, low); };
    const auto build_high = [&] { node->child2 = divideTree(left + count, right, high); };
    if (right - left < hsdm::kd_tree::least_task) {
        build_low();
        build_high();
    } else {
        tbb::parallel_invoke(build_low, build_high);
    }
    node->divlow = low[axis].high;
    node->divhigh = high[axis].low;
    for (std::size_t k = 0; k < 3; ++k) {
        box[k].low = std::min(low[k].low, high[k].low);
        box[k].high = std::max(low[k].high, high[k].high);
    }
    return node;
}

/// `result` is a Taker.
template <>
inline void HsdmTree::findNeighbors(ResultSet<double>& result, const double* place,
                                    const SearchParams&) const {
    std::vector<double>& sides = static_cast<hsdm::kd_tree::Taker&>(result).sides;
    sides.assign(3, 0);
    const double squared = computeInitialDistances(place, sides);
    searchLevel<false>(result, place, root_node_, squared, sides, 1);
}

} // namespace flann

namespace hsdm {
namespace {

/// Squared distance and index: the order of points by nearness.
using Near = std::pair<double, Index>;

/// The nearest of the points that a search comes past, from when it is full a heap with the farthest in
/// front.
class Nearest final : public kd_tree::Taker {
public:
    /// At most `count` points within a squared distance.
    Nearest(std::size_t count, double limit)
        : count_(count), limit_(std::min(limit, std::numeric_limits<double>::max())) {}

    void clear() { near_.clear(); }
    bool full() const override { return near_.size() >= count_; }
    /// What is nearer is looked at: more than what counts, so that equally near points are and none is missed
    /// by rounding. Squared distances from boxes are sums of as many numbers as the tree is deep, thousands
    /// at most.
    double worstDist() const override {
        return std::nextafter((full() ? near_.front().first : limit_) * (1 + 0x1p-40), Box::inf);
    }
    void addPoint(double squared, std::size_t index) override {
        if (!(squared <= limit_)) return;
        const Near candidate(squared, static_cast<Index>(index));
        if (!full()) {
            near_.push_back(candidate);
            if (full()) std::make_heap(near_.begin(), near_.end());
        } else if (candidate < near_.front()) {
            std::pop_heap(near_.begin(), near_.end());
            near_.back() = candidate;
            std::push_heap(near_.begin(), near_.end());
        }
    }
    /// Nearest first; it is to be cleared then.
    std::span<const Near> sorted() {
        std::sort(near_.begin(), near_.end());
        return near_;
    }

private:
    std::size_t count_;
    double limit_;
    std::vector<Near> near_;
};

std::size_t positive(int count) {
    check_option(count > 0, "count of nearest points", count, "be at least 1");
    return static_cast<std::size_t>(count);
}

void check_places(std::span<const Vec3> places) {
    if (!all_finite(places))
        throw Error("a place to search from has a coordinate that is not finite; leave it out");
}

void check_found(std::size_t found, std::size_t wanted) {
    if (found < wanted)
        throw Error("a place to search from lies too far from the points for double precision, or nowhere; "
                    "leave it out");
}

/// The result of places that have so many points each.
NearPoints room_for(std::size_t places, std::size_t count) {
    NearPoints result;
    result.first.resize(places + 1);
    for (std::size_t p = 0; p <= places; ++p) result.first[p] = p * count;
    result.index.resize(places * count);
    result.distance.resize(places * count);
    return result;
}

} // namespace

struct NeighborSearch::Tree {
    Tree(std::span<const Vec3> points, const Box& bounds);
    std::vector<Index> order_of(std::span<const Vec3> places) const;
    void find(const Vec3& place, Nearest& found) const {
        const Vec3 scaled = unit == 1 ? place : place / unit;
        index.findNeighbors(found, scaled.data(), {});
    }
    template <class Put>
    void search(std::span<const Vec3> places, std::span<const Index> order, const Nearest& nearest,
                const Put& put) const;
    NearPoints collect(std::span<const Vec3> places, const Nearest& nearest) const;
    double limit(double radius) const;
    double distance(const Near& near) const { return std::sqrt(near.first) * unit; }
    void put(const Near& near, std::size_t at, NearPoints& result) const {
        result.index[at] = near.second;
        result.distance[at] = distance(near);
    }
    void put(std::span<const Near> near, std::size_t at, NearPoints& result) const {
        for (const Near& one : near) put(one, at++, result);
    }

    /// Once it is built the tree has copies of the points; FLANN keeps the addresses of those given too.
    struct Points : flann::HsdmTree {
        using flann::HsdmTree::HsdmTree;
        void forget_given() { std::vector<double*>().swap(this->flann::NNIndex<kd_tree::Metric>::points_); }
    };
    double unit; ///< of the tree's lengths, in the points' units
    Box box;     ///< of the points, as they were given
    kd_tree::Nodes nodes;
    Points index;
};

NeighborSearch::Tree::Tree(std::span<const Vec3> points, const Box& bounds)
    : unit(CloudFrame(bounds).unit()),
      box(bounds),
      index(flann::KDTreeSingleIndexParams(), kd_tree::Metric(nodes)) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    std::vector<Vec3> scaled;
    if (unit != 1) {
        scaled.assign(points.begin(), points.end());
        for (Vec3& p : scaled) p /= unit;
        points = scaled;
    }
    // FLANN has no matrix of constants; it does not write into it.
    index.buildIndex(flann::Matrix<double>(const_cast<double*>(points.front().data()), points.size(), 3));
    index.forget_given();
}

/// The places by cells of a grid over the points' box, in Morton order: searches that follow each other find
/// in the cache what they need.
std::vector<Index> NeighborSearch::Tree::order_of(std::span<const Vec3> places) const {
    constexpr int level = 10;
    constexpr double last = (1 << level) - 1;
    const Vec3 lo = box.lo / unit;
    const double extent = (box.hi / unit - lo).max(), scale = extent > 0 ? (last + 1) / extent : 0;
    std::vector<CodeIndex> keys(places.size());
    for_each_index(places.size(), chunks::quick, [&](Index p) {
        std::array<std::uint32_t, 3> cell{};
        for (unsigned k = 0; k < 3; ++k)
            if (const double x = (places[p][k] / unit - lo[k]) * scale; x > 0)
                cell[k] = static_cast<std::uint32_t>(std::min(x, last));
        keys[p] = {morton_encode(cell[0], cell[1], cell[2]), p};
    });
    radix_sort(keys, 3 * level);
    std::vector<Index> order(places.size());
    for_each_index(order.size(), chunks::light, [&](Index i) { order[i] = keys[i].index; });
    return order;
}

/// Calls put(place, nearest points, chunk) for every place: in parallel by chunks, each in the given order.
template <class Put>
void NeighborSearch::Tree::search(std::span<const Vec3> places, std::span<const Index> order,
                                  const Nearest& nearest, const Put& put) const {
    for_chunks(order.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        Nearest found = nearest;
        for (std::size_t i = begin; i < end; ++i) {
            found.clear();
            find(places[order[i]], found);
            put(order[i], found.sorted(), chunk);
        }
    });
}

/// The squared distance of points at the radius.
double NeighborSearch::Tree::limit(double radius) const {
    check_option(std::isfinite(radius) && radius >= 0, "radius", radius, "be a number that is not negative");
    return square(radius / unit);
}

/// What a search finds for each place, as much as that is.
NearPoints NeighborSearch::Tree::collect(std::span<const Vec3> places, const Nearest& nearest) const {
    check_places(places);
    const std::vector<Index> order = order_of(places);
    NearPoints result;
    result.first.assign(places.size() + 1, 0);
    std::vector<std::vector<Near>> parts(chunk_count(places.size(), chunks::heavy));
    search(places, order, nearest, [&](Index place, std::span<const Near> near, std::size_t chunk) {
        parts[chunk].insert(parts[chunk].end(), near.begin(), near.end());
        result.first[place + 1] = near.size();
    });
    std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
    result.index.resize(result.first.back());
    result.distance.resize(result.first.back());
    for_chunks(places.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        std::span<const Near> rest = parts[chunk];
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t at = result.first[order[i]], count = result.first[order[i] + 1] - at;
            put(rest.first(count), at, result);
            rest = rest.subspan(count);
        }
    });
    return result;
}

NeighborSearch::NeighborSearch(std::span<const Vec3> points) : points_(points) {
    if (points.empty()) throw Error("no points to search; give at least one");
    if (points.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw Error("more than 2147483647 points to search; take a part of them");
    if (!all_finite(points))
        throw Error("a point to search has a coordinate that is not finite; drop_nonfinite() removes such");
    const Box box = bounds_of(points);
    CloudFrame(box).check_reach();
    tree_ = std::make_unique<Tree>(points, box);
}

NeighborSearch::NeighborSearch(NeighborSearch&& other) noexcept = default;
NeighborSearch::~NeighborSearch() = default;

NearPoint NeighborSearch::nearest(const Vec3& place) const {
    Nearest found(1, Box::inf);
    tree_->find(place, found);
    const auto near = found.sorted();
    check_found(near.size(), 1);
    return {near.front().second, tree_->distance(near.front())};
}

NearPoints NeighborSearch::nearest(std::span<const Vec3> places, int count) const {
    const std::size_t wanted = std::min(positive(count), size());
    check_places(places);
    NearPoints result = room_for(places.size(), wanted);
    tree_->search(places, tree_->order_of(places), Nearest(wanted, Box::inf),
                  [&](Index place, std::span<const Near> near, std::size_t) {
                      check_found(near.size(), wanted);
                      tree_->put(near, result.first[place], result);
                  });
    return result;
}

NearPoints NeighborSearch::nearest_within(std::span<const Vec3> places, int count, double radius) const {
    return tree_->collect(places, Nearest(std::min(positive(count), size()), tree_->limit(radius)));
}

NearPoints NeighborSearch::within(std::span<const Vec3> places, double radius) const {
    return tree_->collect(places, Nearest(size(), tree_->limit(radius)));
}

NearPoints NeighborSearch::neighbors(int count) const {
    const std::size_t wanted = std::min(positive(count), size() - 1);
    NearPoints result = room_for(size(), wanted);
    tree_->search(points_, tree_->order_of(points_), Nearest(wanted + 1, Box::inf),
                  [&](Index point, std::span<const Near> near, std::size_t) {
                      std::size_t at = result.first[point];
                      for (const Near& other : near)
                          if (other.second != point && at < result.first[point + 1])
                              tree_->put(other, at++, result);
                  });
    return result;
}

} // namespace hsdm
