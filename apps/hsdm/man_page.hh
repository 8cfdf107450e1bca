#pragma once
// Manual pages, in roff for man(7).

#include "option_table.hh"

namespace hsdm::command {

/// The page of section 1 for a command or a subcommand, whose page's name is `hsdm-NAME`.
std::string man_page(const CommandText& command);

/// "hsdm-reconstruct": how man(1) is asked for the page.
std::string page_name(const CommandText& command);

} // namespace hsdm::command
