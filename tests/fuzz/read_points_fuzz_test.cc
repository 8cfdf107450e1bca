#include "fuzz/point_files.hh"
#include "hsdm/io/formats.hh"

#include <catch2/catch.hpp>

#include <sstream>

using namespace hsdm;
using namespace hsdm::test;

TEST_CASE("the files that damage is done to are valid themselves", "[fuzz]") {
    for (const NamedContent& file : valid_point_files()) {
        CAPTURE(file.content);
        std::istringstream stream(file.content);
        CHECK(io::read_points(io::SourceBytes::read(stream, file.name), {}).cloud.size() >= 2);
    }
}

TEST_CASE("damaged point files give an error or a cloud that fits together", "[fuzz]") {
    CHECK(fuzz_reading(1, 150) == "");
}
