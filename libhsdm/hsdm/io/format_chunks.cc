#include "hsdm/io/format_chunks.hh"

#include "hsdm/core/chunks.hh"

#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <vector>

namespace hsdm {

static_assert(std::endian::native == std::endian::little, "binary meshes are written in the machine's order");

void write_chunks(AtomicFile& file, std::size_t count,
                  const std::function<void(std::string& out, std::size_t begin, std::size_t end)>& format) {
    constexpr std::size_t chunk = 4096;
    // Few of a thread, so that they stay in its cache.
    const std::size_t chunks_at_once = 4 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    std::vector<std::string> texts(std::min(chunks_at_once, chunk_count(count, chunk)));
    for (std::size_t round = 0; round < count; round += chunk * chunks_at_once) {
        const std::size_t chunks = std::min(chunks_at_once, chunk_count(count - round, chunk));
        for_each_task(chunks, [&](std::size_t i) {
            const std::size_t begin = round + i * chunk;
            texts[i].clear();
            format(texts[i], begin, std::min(count, begin + chunk));
        });
        for (std::size_t i = 0; i < chunks; ++i) file.write(texts[i]);
    }
}

std::string
formatted(std::size_t count,
          const std::function<void(std::string& out, std::size_t begin, std::size_t end)>& format) {
    constexpr std::size_t chunk = 1024; // some for each thread of what one rank of many has at once
    std::vector<std::string> texts(chunk_count(count, chunk));
    for_each_task(texts.size(),
                  [&](std::size_t i) { format(texts[i], i * chunk, std::min(count, (i + 1) * chunk)); });
    std::size_t bytes = 0;
    for (const std::string& text : texts) bytes += text.size();
    std::string all;
    all.reserve(bytes);
    for (const std::string& text : texts) all += text;
    return all;
}

} // namespace hsdm
