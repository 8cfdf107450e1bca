#pragma once
// Files of page/, and three.js, as they were when the command was built (cmake/embed.cmake).

#include <span>
#include <string_view>

namespace hsdm::command::embedded {

/// A file's text, in parts that follow each other; none if the file was not there.
using Text = std::span<const std::string_view>;

extern const Text three_js, three_notice, mesh_js, viewer_js, page_js, page_css, page_html, suite_js,
    suite_css;

} // namespace hsdm::command::embedded
