#include "comparison_json.hh"

namespace hsdm::command {
namespace {

void fill(JsonText& json, const Distance& distance, const Percentiles& percentiles, double diagonal) {
    json.begin_object();
    json.member("max", distance.max);
    json.member("mean", distance.mean);
    json.member("rms", distance.rms);
    json.member("median", percentiles.median);
    json.member("p95", percentiles.p95);
    json.member("p99", percentiles.p99);
    json.member("normalised_max", diagonal > 0 ? distance.max / diagonal : 0);
    json.end();
}

} // namespace

void fill_comparison(JsonText& json, const Comparison& comparison, const char* a_to_b, const char* b_to_a) {
    json.key(a_to_b);
    fill(json, comparison.a_to_b, comparison.a_to_b_percentiles, comparison.diagonal);
    json.key(b_to_a);
    fill(json, comparison.b_to_a, comparison.b_to_a_percentiles, comparison.diagonal);
    json.member("hausdorff", comparison.hausdorff());
    json.member("diagonal", comparison.diagonal);
}

} // namespace hsdm::command
