#include "page.hh"

#include "embedded.hh"
#include "page_mesh.hh"
#include "page_text.hh"
#include "page_words.hh"

#include "hsdm/errors.hh"
#include "hsdm/version.hh"

#include <functional>
#include <map>

namespace hsdm::command {
namespace {

/// JSON text in a script element: nothing in it can end the element or begin a comment.
std::string json_in_script(std::string text) {
    for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
        text.replace(at, 1, "\\u003c");
    return text;
}

/// The template with `{{NAME}}` replaced; what is put in is not looked at again.
std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& parts) {
    std::string result;
    for (std::size_t begin; (begin = text.find("{{")) != std::string_view::npos;) {
        const std::size_t end = text.find("}}", begin);
        result += text.substr(0, begin);
        result += parts.at(std::string(text.substr(begin + 2, end - begin - 2)));
        text.remove_prefix(end + 2);
    }
    return result += text;
}

} // namespace

bool can_write_pages() {
    return !embedded::three_js.empty();
}

std::string viewer_scripts() {
    return "<script>\n/*\n" + whole_text(embedded::three_notice) + "*/\n" + whole_text(embedded::three_js)
           + "\n</script>\n<script>\n" + whole_text(embedded::mesh_js) + "</script>\n<script>\n"
           + whole_text(embedded::viewer_js) + "</script>\n";
}

std::string page_styles() {
    return "<style>\n" + whole_text(embedded::page_css) + "</style>\n";
}

std::string mesh_element(const std::string& id, const PageContent& content) {
    return describe_mesh(id, content).html;
}

std::string page_of(const PageContent& content) {
    if (!can_write_pages()) throw Error(std::string("no page can be written: ") + std::string(without_three));
    const Report none, &report = content.report ? *content.report : none;
    const MeshElement mesh = describe_mesh("mesh", content);
    return filled(whole_text(embedded::page_html),
                  {{"title", html_text(content.title)},
                   {"version", html_text(version)},
                   {"styles", page_styles()},
                   {"verdict", verdict_items(report)},
                   {"figures", key_figures(report)},
                   {"deviations", deviation_rows(mesh.figures)},
                   {"places", places_to_look(report, mesh.figures)},
                   {"report", report_sections(report)},
                   {"mesh", mesh.html},
                   {"json", json_in_script(to_json(report))},
                   {"viewer", viewer_scripts()},
                   {"page", "<script>\n" + whole_text(embedded::page_js) + "</script>\n"}});
}

} // namespace hsdm::command
