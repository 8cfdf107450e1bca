#include "hsdm/io/format_chunks.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <bit>
#include <vector>

namespace hsdm {

static_assert(std::endian::native == std::endian::little, "binary meshes are written in the machine's order");

void write_chunks(AtomicFile& file, std::size_t count,
                  const std::function<void(std::string& out, std::size_t begin, std::size_t end)>& format) {
    constexpr std::size_t chunk = 4096, chunks_at_once = 64;
    std::vector<std::string> texts(std::min(chunks_at_once, (count + chunk - 1) / chunk));
    for (std::size_t round = 0; round < count; round += chunk * chunks_at_once) {
        const std::size_t chunks = std::min(chunks_at_once, (count - round + chunk - 1) / chunk);
        for_each_task(chunks, [&](std::size_t i) {
            const std::size_t begin = round + i * chunk;
            texts[i].clear();
            format(texts[i], begin, std::min(count, begin + chunk));
        });
        for (std::size_t i = 0; i < chunks; ++i) file.write(texts[i]);
    }
}

} // namespace hsdm
