#pragma once
// The report of a case of a suite: that of its reconstruction, and what a suite may ask beyond it.

#include "comparison_json.hh"

#include "hsdm/report.hh"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace hsdm::command {

/// A mesh that was written and read again.
struct WrittenAndRead {
    std::string format;              ///< off, stl, ply, obj, om
    std::size_t bytes = 0;           ///< of the file
    std::size_t vertices = 0,        ///< as read
        faces = 0;                   ///< as read
    std::string digest;              ///< mesh_digest() as read
    bool text_for_precision = false; ///< STL as text, for floats are too coarse
};

/// What is held against the expectations of a case, in the report's order of keys.
struct CaseReport {
    Report report;
    std::optional<Comparison> reference; ///< of the mesh and the true surface
    std::optional<WrittenAndRead> output;
};

/// The report's JSON with the objects `reference` and `output` where there are any.
nlohmann::ordered_json to_json(const CaseReport& all);

/// One with every key that a case may expect, but for those in lists, options and rejected.
const nlohmann::ordered_json& model_report();

} // namespace hsdm::command
