#include "page_words.hh"

#include "page_text.hh"
#include "summary.hh"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace hsdm::command {
namespace {

std::string paragraph(const std::string& text) {
    return "<p>" + text + "</p>\n";
}

std::string section(const std::string& title, const std::string& body) {
    return body.empty() ? "" : "<section class=\"card\"><h2>" + title + "</h2>\n" + body + "</section>\n";
}

std::string size_words(const Report& report) {
    const Vec3 size = report.input.bbox.size();
    return page_number(size[0]) + " × " + page_number(size[1]) + " × " + page_number(size[2]);
}

std::string input_words(const Report& report) {
    const std::size_t points = report.input.points;
    if (points == 0) return "";
    const bool normals = report.input.has_normals;
    const bool estimated = option_value(report, "normals") == "estimate";
    std::string text = "<b>" + counted(points, "point", "points") + "</b> from <b class=\"file\">"
                       + html_text(report.input.file) + "</b>, "
                       + (estimated ? normals ? "with normals, which were estimated anew"
                                              : "without normals, which were estimated"
                          : normals ? "with normals"
                                    : "without normals")
                       + ".";
    text += " They lie in a box of " + size_words(report) + " (the cloud’s units), about "
            + page_number(report.input.spacing, 3) + " apart.";
    text = paragraph(text);
    if (const std::size_t n = report.input.dropped_nonfinite)
        text += paragraph(counted(n, "point had", "points had") + " no finite coordinates and was left out.");
    if (const std::size_t n = report.input.merged_duplicates)
        text += paragraph(counted(n, "duplicate was", "duplicates were") + " merged.");
    if (rejected_count(report, "points_moved"))
        text += paragraph("The points are noisy: they were moved onto their surface first.");
    if (const std::size_t n = rejected_count(report, "normals_steadied"))
        text += paragraph("The normals are noisier than the points: " + counted(n, "one was", "of them were")
                          + " made anew from the points, each on its own side.");
    if (const std::size_t n = rejected_count(report, "normals_mended"))
        text += paragraph(counted(n, "normal was", "normals were") + " turned to the side of the others.");
    return text;
}

std::string resolution_words(const Report& report) {
    const double voxel = report.grid.voxel_size;
    if (!(voxel > 0)) return "";
    std::string text = "Voxels of edge <b>" + page_number(voxel) + "</b>, octree depth "
                       + std::to_string(report.grid.depth) + "; " + grouped(report.grid.voxels)
                       + " of them hold points. What is smaller is not " + "reproduced.";
    if (const std::string why = html_text(option_value(report, "resolution")); !why.empty())
        text += " The size is " + why + ".";
    text = paragraph(text);
    if (report.grid.kind == "adaptive") {
        const std::size_t beyond = report.grid.points_beyond;
        text += paragraph("Facets are as large as the bound of <b>" + page_number(report.grid.max_error, 3)
                          + "</b> allows; "
                          + (beyond == 0 ? "all points keep it."
                                         : counted(beyond, "point is", "points are")
                                               + " farther off, from the finest surface already."));
    }
    return text;
}

std::string mesh_words(const Report& report) {
    const std::size_t faces = report.mesh.faces;
    if (faces == 0) return "";
    const std::size_t quads = report.mesh.quads;
    const std::size_t larger = report.mesh.larger;
    std::string text = "<b>" + counted(faces, "facet", "facets") + "</b>: " + counted(quads, "quad", "quads")
                       + " (" + page_number(100 * static_cast<double>(quads) / static_cast<double>(faces), 3)
                       + " %), " + counted(report.mesh.triangles, "triangle", "triangles");
    if (larger) text += ", " + grouped(larger) + " with more corners";
    text += "; " + counted(report.mesh.vertices, "vertex", "vertices") + ", "
            + counted(report.mesh.edges, "edge", "edges") + ".";
    text = paragraph(text)
           + paragraph("<b>" + counted(report.features.sharp_edges, "edge is", "edges are")
                       + " sharp</b>, sharper than " + html_text(option_value(report, "crease-degrees"))
                       + "°; they meet in " + counted(report.features.corner_vertices, "corner", "corners")
                       + ".");
    for (const Report::Stage& stage : report.stages)
        text +=
            paragraph("Then <code>" + html_text(stage.call) + "</code>: " + html_text(stage.summary) + ".");
    return text;
}

std::string genus_words(long genus, std::size_t components) {
    if (genus == 0) return components == 1 ? "no through hole (genus 0)" : "no through holes (genus 0)";
    return (genus == 1 ? std::string("one through hole or handle")
                       : std::to_string(genus) + " through holes or handles")
           + " (genus " + std::to_string(genus) + ")";
}

std::string topology_sentence(const Report& report) {
    if (report.mesh.faces == 0) return "";
    const std::size_t components = report.mesh.components;
    const std::size_t loops = report.mesh.boundary_loops;
    std::string text =
        components == 1 ? "One connected surface, " : grouped(components) + " connected surfaces, ";
    text += report.mesh.closed ? "<b>closed</b> (watertight)"
                               : "<b>open</b>: " + counted(loops, "boundary loop", "boundary loops") + " of "
                                     + counted(report.mesh.boundary_edges, "edge", "edges");
    text += ", with " + genus_words(report.mesh.genus, components)
            + ". It is an oriented 2-manifold: no edge has more than two facets, and all facets agree on "
              "which side is "
              "out.";
    text = paragraph(text);
    std::size_t completed = 0;
    for (const Report::Loop& loop : report.loops) completed += loop.completed;
    if (completed)
        text += paragraph(
            counted(completed, "hole was", "holes were")
            + " closed by the surface that is missing; it is hatched, for no point was measured there.");
    if (report.mesh.intersections) {
        const std::size_t pairs = *report.mesh.intersections;
        text +=
            paragraph(pairs == 0 ? "No facet passes through another: all pairs were tested exactly."
                                 : counted(pairs, "pair", "pairs") + " of facets pass through each other.");
    }
    return text;
}

std::string error_words(const Report& report) {
    const double largest = report.error.points_to_mesh_max;
    if (!(largest > 0)) return "";
    return paragraph("No point that the mesh was made of is farther than <b>" + page_number(largest, 3)
                     + "</b> from it, " + page_number(100 * report.error.normalised_max, 3)
                     + " % of the diagonal of the points’ box. The mean distance is "
                     + page_number(report.error.points_to_mesh_mean, 3) + ", the root mean square "
                     + page_number(report.error.points_to_mesh_rms, 3) + ".");
}

std::string time_words(const Report& report) {
    const double total = report.seconds.total;
    if (!(total > 0)) return "";
    const std::size_t memory = report.peak_memory_bytes;
    std::string text = "<b>" + page_number(total, 3) + " seconds</b> on "
                       + counted(static_cast<std::size_t>(report.threads), "thread", "threads");
    if (memory)
        text += ", with at most " + page_number(static_cast<double>(memory) / 1e6, 3) + " MB of memory";
    text = paragraph(text + ".") + "<ul class=\"times\">\n";
    const Report::Seconds& s = report.seconds;
    const std::pair<const char*, double> phases[] = {
        {"read", s.read},         {"octree", s.octree}, {"normals", s.normals},
        {"graph", s.graph},       {"facets", s.facets}, {"mesh", s.mesh},
        {"features", s.features}, {"error", s.error},   {"write", s.write}};
    for (const auto& [phase, seconds] : phases) {
        const std::string share = page_number(100 * std::min(1.0, seconds / total), 3);
        text += std::string("<li><span>") + phase + "</span><span class=\"bar\"><i style=\"width:" + share
                + "%\"></i></span><span>" + page_number(seconds, 2) + " s</span></li>\n";
    }
    return text + "</ul>\n";
}

std::string option_words(const Report& report) {
    std::string rows;
    for (const auto& [name, value] : report.options)
        if (name != "resolution")
            rows +=
                "<tr><th scope=\"row\">" + html_text(name) + "</th><td>" + html_text(value) + "</td></tr>\n";
    return rows.empty() ? "" : "<table>\n" + rows + "</table>\n";
}

std::string figure(const std::string& value, const std::string& what) {
    return "<div class=\"figure\"><b>" + value + "</b><span>" + what + "</span></div>\n";
}

std::string numbers(const Vec3& place) {
    char text[96];
    std::snprintf(text, sizeof text, "%.17g %.17g %.17g", place[0], place[1], place[2]);
    return text;
}

std::string place_item(const std::string& kind, const std::string& place, const std::string& words,
                       const std::string& more) {
    const std::string text = "<b>" + words + "</b><span>" + more + "</span>";
    if (place.empty()) return "<li class=\"" + kind + "\"><span class=\"place\">" + text + "</span></li>\n";
    return "<li class=\"" + kind + "\"><button type=\"button\" class=\"place\" data-place=\"" + place + "\">"
           + text + "</button></li>\n";
}

} // namespace

std::string page_number(double value, int digits) {
    if (value == std::floor(value) && std::abs(value) < 1e9)
        return (value < 0 ? "−" : "") + grouped(static_cast<std::size_t>(std::abs(value)));
    char text[48];
    std::snprintf(text, sizeof text, "%.*g", digits, std::abs(value));
    return (value < 0 ? "−" : "") + std::string(text);
}

std::string verdict_items(const Report& report) {
    if (report.mesh.faces == 0) return "";
    const std::size_t warnings = report.warnings.size();
    const bool closed = report.mesh.closed;
    return std::string("<li class=\"") + (closed ? "good\">Closed" : "note\">Open") + "</li>\n"
           + "<li class=\"good\">2-manifold</li>\n"
           + (warnings == 0 ? "<li class=\"good\">No warnings</li>\n"
                            : "<li class=\"warn\">" + counted(warnings, "warning", "warnings") + "</li>\n");
}

std::string key_figures(const Report& report) {
    std::string text;
    if (const std::size_t n = report.input.points) text += figure(grouped(n), "points");
    if (const std::size_t n = report.mesh.faces) {
        text += figure(grouped(n), "facets");
        text += figure(page_number(100 * static_cast<double>(report.mesh.quads) / static_cast<double>(n), 3)
                           + " %",
                       "quads");
        text += figure(grouped(report.features.sharp_edges), "sharp edges");
    }
    if (const double voxel = report.grid.voxel_size; voxel > 0)
        text += figure(page_number(voxel, 3), "voxel edge");
    if (const double largest = report.error.points_to_mesh_max; largest > 0) {
        text += figure(page_number(largest, 3), "largest deviation");
        text += figure(page_number(report.error.points_to_mesh_mean, 3), "mean deviation");
    }
    return text;
}

std::string report_sections(const Report& report) {
    return section("What went in", input_words(report)) + section("Resolution", resolution_words(report))
           + section("What came out", mesh_words(report)) + section("Topology", topology_sentence(report))
           + section("How close it is", error_words(report)) + section("Time and memory", time_words(report))
           + section("Options", option_words(report));
}

std::string deviation_rows(const DeviationFigures& figures) {
    if (figures.points == 0) return "";
    const auto row = [](const std::string& name, const std::string& value) {
        return "<tr><th scope=\"row\">" + name + "</th><td>" + value + "</td></tr>\n";
    };
    const auto signed_number = [](double value) { return (value > 0 ? "+" : "") + page_number(value, 3); };
    return row("Highest", signed_number(figures.highest)) + row("Lowest", signed_number(figures.lowest))
           + row("Mean", signed_number(figures.mean))
           + row("Standard deviation", page_number(figures.spread, 3))
           + row("Half lie within", "±" + page_number(figures.median, 3))
           + row("95 % lie within", "±" + page_number(figures.p95, 3))
           + row("99 % lie within", "±" + page_number(figures.p99, 3))
           + row("Points", grouped(figures.points))
           + (figures.strays ? row("Strays, left out", grouped(figures.strays)) : "");
}

std::string places_to_look(const Report& report, const DeviationFigures& figures) {
    std::string items;
    for (const Report::Warning& warning : report.warnings)
        items += place_item("warn", numbers(warning.where), "Warning: " + html_text(warning.what),
                            page_number(warning.how_much, 6) + "; the first is here");
    for (const Report::Dropped& dropped : report.dropped)
        items += place_item("drop", numbers(dropped.where), "Left out: " + html_text(dropped.what),
                            grouped(dropped.count) + "; the first was here");
    constexpr std::size_t most_loops = 20;
    const std::vector<Report::Loop>& loops = report.loops;
    for (std::size_t i = 0; i < std::min(most_loops, loops.size()); ++i)
        items += place_item(loops[i].completed ? "done" : "loop", numbers(loops[i].where),
                            loops[i].completed ? "Hole that was completed" : "Border of the surface",
                            counted(loops[i].edges, "edge", "edges") + ", " + page_number(loops[i].length, 3)
                                + " long");
    if (loops.size() > most_loops)
        items +=
            place_item("loop", "", "And " + grouped(loops.size() - most_loops) + " more borders or holes",
                       "they stand in the JSON report");
    for (std::size_t i = 0; i < figures.farthest.size(); ++i) {
        const double d = figures.farthest_deviations[i];
        items += place_item("far", numbers(figures.farthest[i]),
                            i == 0 ? "Farthest point" : "Far point, no. " + std::to_string(i + 1),
                            (d > 0 ? "+" : "") + page_number(d, 3) + (d > 0 ? ", outside" : ", inside"));
    }
    return items;
}

} // namespace hsdm::command
