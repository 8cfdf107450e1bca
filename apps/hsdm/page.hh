#pragma once
// One page to look at: a mesh to turn, its deviations, what it may be wrong for, its report in words.

#include "hsdm/polygon_mesh.hh"
#include "hsdm/report.hh"

#include <span>
#include <string>
#include <string_view>

namespace hsdm::command {

/// Whether three.js was there when this command was built; without it there are no pages.
bool can_write_pages();
/// What to say where it was not.
inline constexpr std::string_view without_three =
    "this build has no three.js to draw with; install libjs-three (Debian) and configure and build anew";

/// What a page shows. Nothing is copied: all must stay while the page is made.
struct PageContent {
    std::string title;                ///< may hold any bytes
    const PolygonMesh& mesh;          ///< at least one facet; with hsdm_... properties, if it has them
    std::span<const Vec3> points{};   ///< that the mesh was made of, or none
    const Report* report = nullptr;   ///< if there is one; its largest error tells strays among the points
    std::size_t points_shown = 60000; ///< at most so many of the points are drawn; figures are those of all
};

/// The page as HTML text, whole in itself: it loads nothing. Same content, same bits, for any number of
/// threads. Throws Error if can_write_pages() is false, or for a mesh without a facet or of more than two
/// million.
std::string page_of(const PageContent& content);

/// `<script>` elements: three.js with its notice, then the viewer, which is the function `hsdm.view(canvas,
/// data)` of page/viewer.js. To stand once in a page.
std::string viewer_scripts();
/// `<style>` of the pages.
std::string page_styles();

/// An element `<script type="application/json" id=ID>` that `hsdm.view` draws: the mesh, cut as the STL
/// writer cuts it, its edges and marks, and how far `points` deviate from it, if there are any. docs/page.md
/// tells the format.
std::string mesh_element(const std::string& id, const PageContent& content);

} // namespace hsdm::command
