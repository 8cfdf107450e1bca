#include "hsdm/io/json_text.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <vector>

using hsdm::JsonText;
using Json = nlohmann::ordered_json;

TEST_CASE("JSON text is written as by nlohmann's library", "[report]") {
    JsonText text;
    text.begin_object();
    text.member("name", "a \"b\"\n\xff");
    text.member("numbers", std::vector<double>{0, -0.0, 1, 0.1, 1e-7, 1e22, 1.0 / 3});
    text.member("nothing", std::vector<double>());
    text.key("inner");
    text.begin_object();
    text.member("flag", true);
    text.member("count", std::uint64_t(1) << 63);
    text.key("empty");
    text.begin_object();
    text.end();
    text.end();
    text.member("last", -3);
    text.end();
    const Json same = {
        {"name", "a \"b\"\n\xff"},
        {"numbers", {0.0, -0.0, 1.0, 0.1, 1e-7, 1e22, 1.0 / 3}},
        {"nothing", Json::array()},
        {"inner", {{"flag", true}, {"count", std::uint64_t(1) << 63}, {"empty", Json::object()}}},
        {"last", -3}};
    CHECK(std::move(text).take() == same.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

TEST_CASE("a JSON text becomes a part of another", "[report]") {
    JsonText part;
    part.begin_object();
    part.member("x", 1);
    part.end();
    JsonText whole;
    whole.begin_array();
    const std::string text = std::move(part).take();
    for (int i = 0; i < 2; ++i) whole.document(text);
    whole.end();
    const Json same = Json::array({{{"x", 1}}, {{"x", 1}}});
    CHECK(std::move(whole).take() == same.dump(2) + '\n');
}
