#include "hsdm/normals/outliers.hh"

#include "hsdm/chunks.hh"

#include <algorithm>

namespace hsdm {
namespace {

constexpr std::size_t points_per_chunk = 4096;

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

template <class T>
void keep(std::vector<T>& values, const std::vector<std::uint8_t>& dropped) {
    if (values.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < dropped.size(); ++i)
        if (!dropped[i]) values[kept++] = values[i];
    values.resize(kept);
}

} // namespace

std::size_t drop_outliers(Octree& octree, const Neighbors& neighbors, const OutlierOptions& options) {
    if (neighbors.count == 0) return 0;
    std::vector<double> all = neighbors.reach;
    const double far = options.most_sparseness * median(all);
    std::vector<std::uint8_t> dropped(octree.size(), 0);
    for_chunks(octree.size(), points_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<double> around;
        for (std::size_t i = begin; i < end; ++i) {
            const double reach = neighbors.reach[i];
            around.clear();
            for (Index n : neighbors.of(i)) around.push_back(neighbors.reach[n]);
            dropped[i] = reach > far || reach > options.most_stretch * median(around);
        }
    });
    const auto count = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
    if (count == 0) return 0;
    keep(octree.codes, dropped);
    keep(octree.positions, dropped);
    keep(octree.normals, dropped);
    keep(octree.source, dropped);
    return count;
}

} // namespace hsdm
