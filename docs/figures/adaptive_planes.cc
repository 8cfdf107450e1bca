// Planar patches and strips of a fillet, and what becomes of them.

#include "solid_view.hh"
#include "steps.hh"

#include "hsdm/simplify/planar_patches.hh"
#include "hsdm/simplify/simplify.hh"

namespace hsdm::figures {

Canvas draw_patches() {
    const Fine fine(support::rounded_block(0.35), 60000, 5);
    const double error = 0.002 * fine.octree.bounds.diagonal();
    const PlanarPatches patches = find_planar_patches(fine.mesh, 0.5 * error);
    const AdaptiveMesh coarse =
        simplify(fine.mesh, fine.octree.positions, fine.octree.extent, fine.depth, {.max_error = error});
    Canvas canvas(728, 366);
    const Vec3 towards(0.75, 1, 0.75);
    const SolidView left(fine.mesh.positions, towards, {14, 14}, 340);
    const auto fill = [&](std::size_t f) {
        return patches.patch[f] == no_index ? colour::white : colour::patch(patches.patch[f]);
    };
    left.draw(canvas, fine.mesh, fill, {.stroke = "#666666", .width = 0.4});
    const SolidView right(fine.mesh.positions, towards, {374, 14}, 340);
    right.draw(canvas, coarse.mesh, [](std::size_t) { return std::string("#ececec"); }, {.width = 1.2});
    canvas.text({184, 352}, "the fine mesh: " + std::to_string(fine.mesh.facet_count()) + " facets", 13,
                "middle");
    canvas.text({544, 352}, "the result: " + std::to_string(coarse.mesh.facet_count()) + " facets", 13,
                "middle");
    return canvas;
}

} // namespace hsdm::figures
