#include "io/pack_lzf.hh"

#include <algorithm>
#include <map>

namespace hsdm::test {
namespace {

constexpr std::size_t farthest = 8192, longest = 264, most_literals = 32;

void append_literals(std::string& out, std::string_view literals) {
    for (; !literals.empty(); literals.remove_prefix(std::min(most_literals, literals.size()))) {
        const std::string_view run = literals.substr(0, most_literals);
        out += static_cast<char>(run.size() - 1);
        out += run;
    }
}

void append_reference(std::string& out, std::size_t length, std::size_t distance) {
    const std::size_t l = length - 2, d = distance - 1;
    out += static_cast<char>(std::min<std::size_t>(l, 7) << 5 | d >> 8);
    if (l >= 7) out += static_cast<char>(l - 7);
    out += static_cast<char>(d & 255);
}

} // namespace

std::string pack_lzf(std::string_view bytes) {
    std::string out;
    std::map<std::string_view, std::size_t> last;
    std::size_t literals = 0; // where those not yet written begin
    for (std::size_t at = 0; at < bytes.size();) {
        const std::string_view three = bytes.substr(at, 3);
        const auto found = three.size() == 3 ? last.find(three) : last.end();
        if (found == last.end() || at - found->second > farthest) {
            if (three.size() == 3) last[three] = at;
            ++at;
            continue;
        }
        std::size_t length = 3;
        const std::size_t from = found->second;
        while (length < longest && at + length < bytes.size() && bytes[from + length] == bytes[at + length])
            ++length;
        append_literals(out, bytes.substr(literals, at - literals));
        append_reference(out, length, at - from);
        last[three] = at;
        at += length;
        literals = at;
    }
    append_literals(out, bytes.substr(literals));
    return out;
}

} // namespace hsdm::test
