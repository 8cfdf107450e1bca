#include "case_report.hh"

#include <utility>

namespace hsdm::command {
namespace {

nlohmann::ordered_json to_json(const Comparison& reference) {
    JsonText text;
    text.begin_object();
    fill_comparison(text, reference, "mesh_to_reference", "reference_to_mesh");
    text.end();
    return nlohmann::ordered_json::parse(std::move(text).take());
}

nlohmann::ordered_json to_json(const WrittenAndRead& output) {
    return {{"format", output.format},     {"bytes", output.bytes},
            {"vertices", output.vertices}, {"faces", output.faces},
            {"digest", output.digest},     {"text_for_precision", output.text_for_precision}};
}

} // namespace

nlohmann::ordered_json to_json(const CaseReport& all) {
    auto json = nlohmann::ordered_json::parse(hsdm::to_json(all.report));
    if (all.reference) json["reference"] = to_json(*all.reference);
    if (all.output) json["output"] = to_json(*all.output);
    return json;
}

const nlohmann::ordered_json& model_report() {
    static const nlohmann::ordered_json model = [] {
        CaseReport all{{}, Comparison{}, WrittenAndRead{}};
        all.report.input.bbox = {{0, 0, 0}, {0, 0, 0}}; // what is not finite would be left out
        all.report.input.first_nonfinite = 0;
        all.report.mesh.details.emplace();
        all.report.mesh.intersections = 0;
        return to_json(all);
    }();
    return model;
}

} // namespace hsdm::command
