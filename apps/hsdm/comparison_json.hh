#pragma once
// Distances between two surfaces in the words of `hsdm compare --json`.

#include "hsdm/io/json_text.hh"
#include "hsdm/quality/compare.hh"

namespace hsdm::command {

/// Members of an object that is open: the distances of a from b and of b from a, each an object under the key
/// given for it, `hausdorff` and `diagonal`.
void fill_comparison(JsonText& json, const Comparison& comparison, const char* a_to_b, const char* b_to_a);

} // namespace hsdm::command
