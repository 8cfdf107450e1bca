#include "solid_view.hh"

#include <algorithm>
#include <utility>

namespace hsdm::figures {
namespace {

Vec3 area_vector(const PolygonMesh& mesh, std::size_t facet) {
    const auto ring = mesh.facet(facet);
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        sum += (mesh.positions[ring[i]] - mesh.positions[ring[0]])
               % (mesh.positions[ring[i + 1]] - mesh.positions[ring[0]]);
    return sum;
}

Vec3 centre(const PolygonMesh& mesh, std::size_t facet) {
    Vec3 sum(0, 0, 0);
    for (Index v : mesh.facet(facet)) sum += mesh.positions[v];
    return sum / static_cast<double>(mesh.facet(facet).size());
}

} // namespace

SolidView::SolidView(std::span<const Vec3> positions, const Vec3& towards, const Vec2& corner, double size)
    : towards_(towards.normalized()),
      right_((Vec3(0, 0, 1) % towards_).normalized()),
      up_(towards_ % right_),
      panel_{corner, {1e300, 1e300}, {-1e300, -1e300}, 1} {
    for (const Vec3& p : positions) {
        panel_.lo.minimize(flat(p));
        panel_.hi.maximize(flat(p));
    }
    const Vec2 extent = panel_.hi - panel_.lo;
    panel_.scale = size / std::max(extent[0], extent[1]);
    panel_.corner += 0.5 * (Vec2(size, size) - panel_.size());
}

Vec2 SolidView::operator()(const Vec3& p) const {
    return panel_(flat(p));
}

std::vector<Index> SolidView::seen_vertices(const PolygonMesh& mesh) const {
    std::vector<Index> seen;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (faces(area_vector(mesh, f).normalized()))
            seen.insert(seen.end(), mesh.facet(f).begin(), mesh.facet(f).end());
    std::ranges::sort(seen);
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    return seen;
}

void SolidView::draw(Canvas& canvas, const PolygonMesh& mesh,
                     const std::function<std::string(std::size_t)>& fill, const Style& edges) const {
    const Vec3 light = (towards_ + 0.5 * up_ - 0.4 * right_).normalized();
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (faces(area_vector(mesh, f).normalized())) order.emplace_back(centre(mesh, f) | towards_, f);
    std::ranges::sort(order);
    std::vector<Vec2> corners;
    for (const auto& [depth, f] : order) {
        corners.clear();
        for (Index v : mesh.facet(f)) corners.push_back((*this)(mesh.positions[v]));
        const double lit = std::max(0.0, area_vector(mesh, f).normalized() | light);
        Style style = edges;
        style.fill = colour::darkened(fill(f), 0.62 + 0.38 * lit);
        canvas.polygon(corners, style);
    }
}

} // namespace hsdm::figures
