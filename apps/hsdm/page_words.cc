#include "page_words.hh"

#include "summary.hh"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>

namespace hsdm::command {
namespace {

/// The value behind a few keys, or the other one where a report does not have it.
template <class Value>
Value at(const PageReport& report, std::initializer_list<const char*> keys, Value otherwise) {
    const PageReport* here = &report;
    for (const char* key : keys) {
        if (!here->is_object() || !here->contains(key)) return otherwise;
        here = &(*here)[key];
    }
    try {
        return here->get<Value>();
    } catch (const PageReport::exception&) { // of another kind
        return otherwise;
    }
}

std::size_t count_at(const PageReport& report, std::initializer_list<const char*> keys) {
    return at<std::size_t>(report, keys, 0);
}

double number_at(const PageReport& report, std::initializer_list<const char*> keys) {
    return at<double>(report, keys, 0);
}

std::string text_at(const PageReport& report, std::initializer_list<const char*> keys) {
    return html_text(at<std::string>(report, keys, ""));
}

PageReport list_at(const PageReport& report, const char* key) {
    return at<PageReport>(report, {key}, PageReport::array());
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
    return grouped(count) + ' ' + (count == 1 ? one : many);
}

std::string paragraph(const std::string& text) {
    return "<p>" + text + "</p>\n";
}

std::string section(const std::string& title, const std::string& body) {
    return body.empty() ? "" : "<section class=\"card\"><h2>" + title + "</h2>\n" + body + "</section>\n";
}

std::string size_words(const PageReport& report) {
    const auto lo = at<std::vector<double>>(report, {"input", "bbox_min"}, {});
    const auto hi = at<std::vector<double>>(report, {"input", "bbox_max"}, {});
    if (lo.size() != 3 || hi.size() != 3) return "";
    std::string text;
    for (unsigned k = 0; k < 3; ++k) text += (k ? " × " : "") + page_number(hi[k] - lo[k]);
    return text;
}

std::string input_words(const PageReport& report) {
    const std::size_t points = count_at(report, {"input", "points"});
    if (points == 0) return "";
    const bool normals = at(report, {"input", "has_normals"}, false);
    const bool estimated = at<std::string>(report, {"options", "normals"}, "") == "estimate";
    std::string text = "<b>" + counted(points, "point", "points") + "</b> from <b class=\"file\">"
                       + text_at(report, {"input", "file"}) + "</b>, "
                       + (estimated ? normals ? "with normals, which were estimated anew"
                                              : "without normals, which were estimated"
                          : normals ? "with normals"
                                    : "without normals")
                       + ".";
    if (const std::string size = size_words(report); !size.empty())
        text += " They lie in a box of " + size + " (the cloud’s units), about "
                + page_number(number_at(report, {"input", "spacing"}), 3) + " apart.";
    text = paragraph(text);
    if (const std::size_t n = count_at(report, {"input", "dropped_nonfinite"}))
        text += paragraph(counted(n, "point had", "points had") + " no finite coordinates and was left out.");
    if (const std::size_t n = count_at(report, {"input", "merged_duplicates"}))
        text += paragraph(counted(n, "duplicate was", "duplicates were") + " merged.");
    if (count_at(report, {"rejected", "points_moved"}))
        text += paragraph("The points are noisy: they were moved onto their surface first.");
    if (const std::size_t n = count_at(report, {"rejected", "normals_mended"}))
        text += paragraph(counted(n, "normal was", "normals were") + " turned to the side of the others.");
    return text;
}

std::string resolution_words(const PageReport& report) {
    const double voxel = number_at(report, {"grid", "voxel_size"});
    if (!(voxel > 0)) return "";
    std::string text = "Voxels of edge <b>" + page_number(voxel) + "</b>, octree depth "
                       + grouped(count_at(report, {"grid", "depth"})) + "; "
                       + grouped(count_at(report, {"grid", "voxels"}))
                       + " of them hold points. What is smaller is not " + "reproduced.";
    if (const std::string why = text_at(report, {"options", "resolution"}); !why.empty())
        text += " The size is " + why + ".";
    text = paragraph(text);
    if (at<std::string>(report, {"grid", "kind"}, "") == "adaptive") {
        const std::size_t beyond = count_at(report, {"grid", "points_beyond"});
        text += paragraph("Facets are as large as the bound of <b>"
                          + page_number(number_at(report, {"grid", "max_error"}), 3) + "</b> allows; "
                          + (beyond == 0 ? "all points keep it."
                                         : counted(beyond, "point is", "points are")
                                               + " farther off, from the finest surface already."));
    }
    return text;
}

std::string mesh_words(const PageReport& report) {
    const std::size_t faces = count_at(report, {"mesh", "faces"});
    if (faces == 0) return "";
    const std::size_t quads = count_at(report, {"mesh", "quads"});
    const std::size_t larger = count_at(report, {"mesh", "larger"});
    std::string text = "<b>" + counted(faces, "facet", "facets") + "</b>: " + counted(quads, "quad", "quads")
                       + " (" + page_number(100 * static_cast<double>(quads) / static_cast<double>(faces), 3)
                       + " %), " + counted(count_at(report, {"mesh", "triangles"}), "triangle", "triangles");
    if (larger) text += ", " + grouped(larger) + " with more corners";
    text += "; " + counted(count_at(report, {"mesh", "vertices"}), "vertex", "vertices") + ", "
            + counted(count_at(report, {"mesh", "edges"}), "edge", "edges") + ".";
    text =
        paragraph(text)
        + paragraph("<b>" + counted(count_at(report, {"features", "sharp_edges"}), "edge is", "edges are")
                    + " sharp</b>, sharper than " + text_at(report, {"options", "crease-degrees"})
                    + "°; they meet in "
                    + counted(count_at(report, {"features", "corner_vertices"}), "corner", "corners") + ".");
    for (const PageReport& stage : list_at(report, "stages"))
        text += paragraph("Then <code>" + text_at(stage, {"call"}) + "</code>: " + text_at(stage, {"summary"})
                          + ".");
    return text;
}

std::string genus_words(long genus, std::size_t components) {
    if (genus == 0) return components == 1 ? "no through hole (genus 0)" : "no through holes (genus 0)";
    return (genus == 1 ? std::string("one through hole or handle")
                       : std::to_string(genus) + " through holes or handles")
           + " (genus " + std::to_string(genus) + ")";
}

std::string topology_sentence(const PageReport& report) {
    if (count_at(report, {"mesh", "faces"}) == 0) return "";
    const std::size_t components = count_at(report, {"mesh", "components"});
    const std::size_t loops = count_at(report, {"mesh", "boundary_loops"});
    std::string text =
        components == 1 ? "One connected surface, " : grouped(components) + " connected surfaces, ";
    text += at(report, {"mesh", "closed"}, false)
                ? "<b>closed</b> (watertight)"
                : "<b>open</b>: " + counted(loops, "boundary loop", "boundary loops") + " of "
                      + counted(count_at(report, {"mesh", "boundary_edges"}), "edge", "edges");
    text += ", with " + genus_words(at<long>(report, {"mesh", "genus"}, 0), components)
            + ". It is an oriented 2-manifold: no edge has more than two facets, and all facets agree on "
              "which side is "
              "out.";
    text = paragraph(text);
    std::size_t completed = 0;
    for (const PageReport& loop : list_at(report, "loops")) completed += at(loop, {"completed"}, false);
    if (completed)
        text += paragraph(
            counted(completed, "hole was", "holes were")
            + " closed by the surface that is missing; it is hatched, for no point was measured there.");
    const PageReport mesh = at(report, {"mesh"}, PageReport::object());
    if (mesh.contains("intersections")) {
        const std::size_t pairs = count_at(report, {"mesh", "intersections"});
        text +=
            paragraph(pairs == 0 ? "No facet passes through another: all pairs were tested exactly."
                                 : counted(pairs, "pair", "pairs") + " of facets pass through each other.");
    }
    return text;
}

std::string error_words(const PageReport& report) {
    const double largest = number_at(report, {"error", "points_to_mesh_max"});
    if (!(largest > 0)) return "";
    return paragraph("No point that the mesh was made of is farther than <b>" + page_number(largest, 3)
                     + "</b> from it, " + page_number(100 * number_at(report, {"error", "normalised_max"}), 3)
                     + " % of the diagonal of the points’ box. The mean distance is "
                     + page_number(number_at(report, {"error", "points_to_mesh_mean"}), 3)
                     + ", the root mean square "
                     + page_number(number_at(report, {"error", "points_to_mesh_rms"}), 3) + ".");
}

std::string time_words(const PageReport& report) {
    const double total = number_at(report, {"seconds", "total"});
    if (!(total > 0)) return "";
    const std::size_t memory = count_at(report, {"peak_memory_bytes"});
    std::string text = "<b>" + page_number(total, 3) + " seconds</b> on "
                       + counted(count_at(report, {"threads"}), "thread", "threads");
    if (memory)
        text += ", with at most " + page_number(static_cast<double>(memory) / 1e6, 3) + " MB of memory";
    text = paragraph(text + ".") + "<ul class=\"times\">\n";
    for (const char* phase :
         {"read", "octree", "normals", "graph", "facets", "mesh", "features", "error", "write"}) {
        const double seconds = number_at(report, {"seconds", phase});
        const std::string share = page_number(100 * std::min(1.0, seconds / total), 3);
        text += std::string("<li><span>") + phase + "</span><span class=\"bar\"><i style=\"width:" + share
                + "%\"></i></span><span>" + page_number(seconds, 2) + " s</span></li>\n";
    }
    return text + "</ul>\n";
}

std::string option_words(const PageReport& report) {
    std::string rows;
    const PageReport options = at(report, {"options"}, PageReport::object());
    for (const auto& [name, value] : options.items())
        if (value.is_string() && name != "resolution")
            rows += "<tr><th scope=\"row\">" + html_text(name) + "</th><td>"
                    + html_text(value.get<std::string>()) + "</td></tr>\n";
    return rows.empty() ? "" : "<table>\n" + rows + "</table>\n";
}

std::string figure(const std::string& value, const std::string& what) {
    return "<div class=\"figure\"><b>" + value + "</b><span>" + what + "</span></div>\n";
}

/// A place of the report, or nothing.
std::string place_of(const PageReport& entry) {
    const auto where = at<std::vector<double>>(entry, {"where"}, {});
    if (where.size() != 3) return "";
    char text[96];
    std::snprintf(text, sizeof text, "%.17g %.17g %.17g", where[0], where[1], where[2]);
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

PageReport parse_report(const std::string& text) {
    PageReport report = PageReport::parse(text, nullptr, false);
    return report.is_object() ? report : PageReport::object();
}

double largest_error_of(const PageReport& report) {
    return number_at(report, {"error", "points_to_mesh_max"});
}

std::string page_number(double value, int digits) {
    if (value == std::floor(value) && std::abs(value) < 1e9)
        return (value < 0 ? "−" : "") + grouped(static_cast<std::size_t>(std::abs(value)));
    char text[48];
    std::snprintf(text, sizeof text, "%.*g", digits, std::abs(value));
    return (value < 0 ? "−" : "") + std::string(text);
}

std::string verdict_items(const PageReport& report) {
    if (count_at(report, {"mesh", "faces"}) == 0) return "";
    const std::size_t warnings = list_at(report, "warnings").size();
    const bool closed = at(report, {"mesh", "closed"}, false);
    return std::string("<li class=\"") + (closed ? "good\">Closed" : "note\">Open") + "</li>\n"
           + "<li class=\"good\">2-manifold</li>\n"
           + (warnings == 0 ? "<li class=\"good\">No warnings</li>\n"
                            : "<li class=\"warn\">" + counted(warnings, "warning", "warnings") + "</li>\n");
}

std::string key_figures(const PageReport& report) {
    std::string text;
    if (const std::size_t n = count_at(report, {"input", "points"})) text += figure(grouped(n), "points");
    if (const std::size_t n = count_at(report, {"mesh", "faces"})) {
        text += figure(grouped(n), "facets");
        text += figure(page_number(100 * static_cast<double>(count_at(report, {"mesh", "quads"}))
                                       / static_cast<double>(n),
                                   3)
                           + " %",
                       "quads");
        text += figure(grouped(count_at(report, {"features", "sharp_edges"})), "sharp edges");
    }
    if (const double voxel = number_at(report, {"grid", "voxel_size"}); voxel > 0)
        text += figure(page_number(voxel, 3), "voxel edge");
    if (const double largest = number_at(report, {"error", "points_to_mesh_max"}); largest > 0) {
        text += figure(page_number(largest, 3), "largest deviation");
        text += figure(page_number(number_at(report, {"error", "points_to_mesh_mean"}), 3), "mean deviation");
    }
    return text;
}

std::string report_sections(const PageReport& report) {
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

std::string places_to_look(const PageReport& report, const DeviationFigures& figures) {
    std::string items;
    for (const PageReport& warning : list_at(report, "warnings"))
        items += place_item("warn", place_of(warning), "Warning: " + text_at(warning, {"what"}),
                            page_number(number_at(warning, {"how_much"}), 6) + "; the first is here");
    for (const PageReport& dropped : list_at(report, "dropped"))
        items += place_item("drop", place_of(dropped), "Left out: " + text_at(dropped, {"what"}),
                            grouped(count_at(dropped, {"count"})) + "; the first was here");
    constexpr std::size_t most_loops = 20;
    const PageReport loops = list_at(report, "loops");
    for (std::size_t i = 0; i < std::min(most_loops, loops.size()); ++i)
        items += place_item(at(loops[i], {"completed"}, false) ? "done" : "loop", place_of(loops[i]),
                            at(loops[i], {"completed"}, false) ? "Hole that was completed"
                                                               : "Border of the surface",
                            counted(count_at(loops[i], {"edges"}), "edge", "edges") + ", "
                                + page_number(number_at(loops[i], {"length"}), 3) + " long");
    if (loops.size() > most_loops)
        items +=
            place_item("loop", "", "And " + grouped(loops.size() - most_loops) + " more borders or holes",
                       "they stand in the JSON report");
    for (std::size_t i = 0; i < figures.farthest.size(); ++i) {
        char place[96];
        const Vec3& p = figures.farthest[i];
        std::snprintf(place, sizeof place, "%.17g %.17g %.17g", p[0], p[1], p[2]);
        const double d = figures.farthest_deviations[i];
        items +=
            place_item("far", place, i == 0 ? "Farthest point" : "Far point, no. " + std::to_string(i + 1),
                       (d > 0 ? "+" : "") + page_number(d, 3) + (d > 0 ? ", outside" : ", inside"));
    }
    return items;
}

} // namespace hsdm::command
