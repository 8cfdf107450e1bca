#include "hsdm/io/long_text.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/io/format_chunks.hh"

#include <algorithm>
#include <atomic>

namespace hsdm {
namespace {

constexpr std::size_t stretch_elements = std::size_t{1} << 15;

} // namespace

void LongText::add(std::string text) {
    parts_.push_back(
        {1, [text = std::move(text)](std::string& out, std::size_t, std::size_t) { out += text; }});
}

void LongText::add(std::size_t count, Format format) {
    if (count > 0) parts_.push_back({count, std::move(format)});
}

std::uint64_t LongText::size() const {
    std::atomic<std::uint64_t> bytes = 0;
    for (const Part& part : parts_)
        for_chunks(part.count, chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::string out;
            part.format(out, begin, end);
            bytes += out.size();
        });
    return bytes;
}

std::size_t LongText::stretches() const {
    std::size_t count = 0;
    for (const Part& part : parts_) count += chunk_count(part.count, stretch_elements);
    return count;
}

std::string LongText::stretch(std::size_t i) const {
    for (const Part& part : parts_) {
        const std::size_t count = chunk_count(part.count, stretch_elements);
        if (i >= count) {
            i -= count;
            continue;
        }
        const std::size_t first = i * stretch_elements;
        return formatted(std::min(stretch_elements, part.count - first),
                         [&](std::string& out, std::size_t begin, std::size_t end) {
                             part.format(out, first + begin, first + end);
                         });
    }
    return {};
}

} // namespace hsdm
