#pragma once
// The other direction of io/lzf.hh, for test files.

#include <string>
#include <string_view>

namespace hsdm::test {

/// LZF of the bytes: literals, and references to the last place where the same three bytes began.
std::string pack_lzf(std::string_view bytes);

} // namespace hsdm::test
