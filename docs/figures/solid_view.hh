#pragma once
// A mesh seen from a direction, far facets drawn first.

#include "canvas.hh"

#include "hsdm/polygon_mesh.hh"

#include <functional>

namespace hsdm::figures {

class SolidView {
public:
    /// Positions fit a square of `size` pixels whose upper left corner is `corner`. `towards`: from the solid
    /// to the viewer; z points up.
    SolidView(std::span<const Vec3> positions, const Vec3& towards, const Vec2& corner, double size);

    Vec2 operator()(const Vec3& p) const;
    bool faces(const Vec3& normal) const { return (normal | towards_) > 0.02; }
    /// Vertices of facets that face the viewer.
    std::vector<Index> seen_vertices(const PolygonMesh& mesh) const;
    /// The facets that face the viewer, shaded; `fill` gives the colour of one.
    void draw(Canvas& canvas, const PolygonMesh& mesh, const std::function<std::string(std::size_t)>& fill,
              const Style& edges) const;

private:
    Vec2 flat(const Vec3& p) const { return {right_ | p, up_ | p}; }

    Vec3 towards_, right_, up_;
    Panel panel_;
};

} // namespace hsdm::figures
