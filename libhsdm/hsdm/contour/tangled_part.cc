#include "hsdm/contour/tangled_part.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/mesh/remove_facets.hh"

#include <algorithm>
#include <atomic>

namespace hsdm {
namespace {

bool overlap(const Box& a, const Box& b, double margin) {
    for (unsigned k = 0; k < 3; ++k)
        if (a.lo[k] > b.hi[k] + margin || b.lo[k] > a.hi[k] + margin) return false;
    return true;
}

} // namespace

TangledPart::TangledPart(const PolygonMesh& mesh, const std::vector<std::array<Index, 2>>& pairs,
                         double nearby) {
    std::vector<Box> trouble;
    for (const auto& pair : pairs)
        for (Index f : pair) trouble.push_back(box_of(mesh, f));
    std::sort(trouble.begin(), trouble.end(), [](const Box& a, const Box& b) { return a.lo[0] < b.lo[0]; });
    double widest = 0;
    for (const Box& box : trouble) widest = std::max(widest, box.hi[0] - box.lo[0]);
    facets_ = indices_where(mesh.facet_count(), chunks::usual, [&](Index f) {
        const Box box = box_of(mesh, f);
        const auto first = std::lower_bound(trouble.begin(), trouble.end(), box.lo[0] - nearby - widest,
                                            [](const Box& b, double x) { return b.lo[0] < x; });
        for (auto t = first; t != trouble.end() && t->lo[0] <= box.hi[0] + nearby; ++t)
            if (overlap(*t, box, nearby)) return true;
        return false;
    });
    part = part_of(mesh, facets_, &of_vertex_);
    // A vertex that has facets outside must stay: not all of its neighbours are known here.
    inner_.assign(part.vertex_count(), 1);
    for_chunks(mesh.facet_count(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        auto next = std::ranges::lower_bound(facets_, begin);
        for (std::size_t f = begin; f < end; ++f) {
            if (next != facets_.end() && *next == f) {
                ++next;
                continue;
            }
            for (Index v : mesh.facet(f))
                if (of_vertex_[v] != no_index)
                    std::atomic_ref(inner_[of_vertex_[v]]).store(0, std::memory_order_relaxed);
        }
    });
}

std::vector<Index> TangledPart::vertices() const {
    std::vector<Index> of_part(part.vertex_count());
    for (std::size_t v = 0; v < of_vertex_.size(); ++v)
        if (of_vertex_[v] != no_index) of_part[of_vertex_[v]] = static_cast<Index>(v);
    return of_part;
}

void TangledPart::write_back(PolygonMesh& mesh) const {
    for (std::size_t v = 0; v < of_vertex_.size(); ++v)
        if (of_vertex_[v] != no_index) mesh.positions[v] = part.positions[of_vertex_[v]];
}

void TangledPart::replace_facets(PolygonMesh& mesh) const {
    write_back(mesh);
    std::size_t next = 0;
    remove_facets(mesh, [&](std::size_t f) {
        const bool out = next < facets_.size() && facets_[next] == f;
        next += out;
        return out;
    });
    const std::vector<Index> of_part = vertices();
    std::vector<Index> corners;
    for (std::size_t f = 0; f < part.facet_count(); ++f) {
        corners.clear();
        for (Index v : part.facet(f)) corners.push_back(of_part[v]);
        mesh.add_facet(corners);
    }
}

} // namespace hsdm
