#include "support/rank_threads.hh"

#include <catch2/catch.hpp>

#include <atomic>

using namespace hsdm;

TEST_CASE("every rank gets what each rank sends it", "[core]") {
    for (const int count : {1, 2, 5}) {
        std::atomic<int> right = 0;
        const auto failures = support::run_ranks(count, [&](Ranks& ranks) {
            std::vector<Ranks::Bytes> out;
            for (int to = 0; to < count; ++to)
                out.emplace_back(static_cast<std::size_t>(to), static_cast<char>('a' + ranks.rank()));
            const auto got = ranks.exchange(std::move(out));
            for (int from = 0; from < count; ++from)
                right +=
                    got[static_cast<std::size_t>(from)]
                    == Ranks::Bytes(static_cast<std::size_t>(ranks.rank()), static_cast<char>('a' + from));
            right += ranks.sum(static_cast<std::uint64_t>(ranks.rank()))
                     == static_cast<std::uint64_t>(count * (count - 1) / 2);
            const int sizes = 8 * count, number = 8; // that all are told of
            right += ranks.bytes_sent()
                     == static_cast<std::size_t>(count * (count - 1) / 2 - ranks.rank()
                                                 + (sizes + number) * (count - 1));
            right += ranks.of_first(ranks.is_first());
        });
        CHECK(right == count * count + 3 * count);
        for (const std::string& failure : failures) CHECK(failure.empty());
    }
}

TEST_CASE("a rank that fails takes the others along, wherever they are", "[core]") {
    std::string expected = "the disk is full (rank 1 of 3)";
    bool late = GENERATE(false, true);
    std::atomic<bool> went_on = false;
    const auto failures = support::run_ranks(3, [&](Ranks& ranks) {
        if (late) ranks.sum(1);
        if (ranks.rank() == 1) throw Error("the disk is full");
        ranks.exchange(std::vector<Ranks::Bytes>(3));
        went_on = true;
    });
    CHECK_FALSE(went_on);
    CHECK(failures[0] == expected);
    CHECK(failures[1] == "the disk is full");
    CHECK(failures[2] == expected);
}

TEST_CASE("what one rank gives up all go on from, and a failure is told all the same", "[core]") {
    const int by = GENERATE(0, 1), and_by = GENERATE(1, 2);
    const bool fails = GENERATE(false, true);
    std::atomic<int> gave_up = 0, went_on = 0;
    const auto failures = support::run_ranks(3, [&](Ranks& ranks) {
        try {
            ranks.sum(1);
            if (ranks.rank() == by || ranks.rank() == and_by) throw Error("too wide");
            ranks.sum(1);
        } catch (const OtherRankGaveUp& error) {
            CHECK(std::string(error.what()).starts_with("too wide"));
            ++gave_up;
        } catch (const Error& error) {
            ranks.give_up(error.what());
            ++gave_up;
        }
        if (fails && ranks.rank() == 2) throw Error("the disk is full");
        went_on += static_cast<int>(ranks.sum(1));
    });
    CHECK(gave_up == 3);
    CHECK(went_on == (fails ? 0 : 9));
    for (const std::string& failure : failures)
        CHECK((fails ? failure.starts_with("the disk is full") : failure.empty()));
}

TEST_CASE("a rank that fails after the last exchange is known to all", "[core]") {
    const auto failures = support::run_ranks(2, [](Ranks& ranks) {
        if (ranks.rank() == 0) throw Error("the mesh cannot be written");
    });
    CHECK(failures[0] == "the mesh cannot be written");
    CHECK(failures[1] == "the mesh cannot be written (rank 0 of 2)");
}

TEST_CASE("what all ranks find wrong no rank is blamed for", "[core]") {
    const auto failures = support::run_ranks(3, [](Ranks&) { throw Error("the cloud has no normals"); });
    for (const std::string& failure : failures) CHECK(failure == "the cloud has no normals");
}

TEST_CASE("no rank waits for one that ends without a word", "[core]") {
    const bool early = GENERATE(true, false);
    const auto failures = support::run_ranks_apart(3, [&](Ranks& ranks) {
        if (early && ranks.rank() == 2) return ranks.leave();
        ranks.together([&] { ranks.sum(1); });
        ranks.leave(); // all have been told already
    });
    const std::string expected =
        early ? "a process has ended before the work of all was done (rank 2 of 3)" : "";
    CHECK(failures[0] == expected);
    CHECK(failures[1] == expected);
    CHECK(failures[2].empty());
}

TEST_CASE("a rank that leaves after a failure is not waited for", "[core]") {
    const auto failures = support::run_ranks_apart(2, [&](Ranks& ranks) {
        try {
            ranks.together([&] {
                if (ranks.rank() == 1) throw Error("the disk is full");
                ranks.sum(1);
            });
        } catch (const Error&) {
            ranks.leave();
            throw;
        }
    });
    CHECK(failures[0] == "the disk is full (rank 1 of 2)");
    CHECK(failures[1] == "the disk is full");
}

TEST_CASE("values go through bytes as they are", "[core]") {
    Ranks::Bytes bytes;
    put(1.5, bytes);
    put_vector(std::vector<int>{1, 2, 3}, bytes);
    put(std::uint8_t{7}, bytes);
    ByteReader reader(bytes);
    CHECK(reader.take<double>() == 1.5);
    CHECK(reader.take_vector<int>() == std::vector<int>{1, 2, 3});
    CHECK(reader.take<std::uint8_t>() == 7);
    CHECK(reader.at_end());
    CHECK_THROWS_AS(reader.take<int>(), Error);
}
