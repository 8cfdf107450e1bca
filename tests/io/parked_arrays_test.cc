#include "hsdm/errors.hh"
#include "hsdm/io/parked_arrays.hh"
#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <numeric>

using namespace hsdm;

TEST_CASE("arrays that were parked come back as they were", "[io]") {
    const support::Folder folder;
    const ScratchPlace place{folder.path()};
    std::vector<double> numbers(100000);
    std::iota(numbers.begin(), numbers.end(), 0.5);
    std::vector<char> none, letters{'a', 'b'};
    const std::vector<double> before = numbers;
    {
        ParkedArrays parked(&place);
        parked.park(numbers, none);
        parked.park(letters);
        CHECK(numbers.capacity() + letters.capacity() == 0);
        CHECK(folder.names().empty()); // a file without a name
        parked.restore();
        CHECK(numbers == before);
        CHECK(none.empty());
        CHECK(letters == std::vector<char>{'a', 'b'});
        parked.park(letters);
        letters = {'c'};
        parked.restore();
        CHECK(letters == std::vector<char>{'a', 'b'});
    }
    CHECK(folder.names().empty());
}

TEST_CASE("without a place arrays stay", "[io]") {
    std::vector<int> values{1, 2, 3};
    ParkedArrays parked(nullptr);
    parked.park(values);
    CHECK(values == std::vector<int>{1, 2, 3});
    parked.restore();
    CHECK(values == std::vector<int>{1, 2, 3});
}

TEST_CASE("a folder that is none is told", "[io]") {
    const ScratchPlace nowhere{"/nonexistent/folder"};
    CHECK_THROWS_AS(ParkedArrays(&nowhere), Error);
}
