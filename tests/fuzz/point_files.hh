#pragma once
// Small valid point files of every format, and random damage to them.

#include "support/random.hh"

#include <string>
#include <vector>

namespace hsdm::test {

struct NamedContent {
    std::string name; ///< as a reader would see it: the extension counts
    std::string content;
};

std::vector<NamedContent> valid_point_files();

/// One to eight random changes: bits, bytes and pieces overwritten, taken out, put in, doubled, cut off, or
/// replaced by what readers trip over (huge counts, signs, line ends, words of headers).
std::string damaged(const std::string& content, support::Random& random);

/// Reads damaged files until `rounds` of each are done. Returns the first fault found, empty if none: an
/// exception that is no hsdm::Error, or a cloud whose arrays do not fit each other.
std::string fuzz_reading(std::uint64_t seed, int rounds);

} // namespace hsdm::test
