#include "hsdm/io/tagged.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/columns.hh"
#include "hsdm/io/formats.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm::io {
namespace {

/// The contents of one piece of the text.
struct Chunk {
    std::vector<Vec3> positions, normals, colors;
    std::size_t faces = 0, ends = 0;
    const char* error_at = nullptr;
    std::string error;
};

bool equals(std::string_view word, std::string_view tag) {
    return !tag.empty() && word.size() == tag.size()
           && std::equal(word.begin(), word.end(), tag.begin(),
                         [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

class ChunkReader {
public:
    ChunkReader(const Text& text, const Tags& tags) : text_(text), tags_(tags) {}

    void run(const char* at, const char* end, Chunk& chunk) const {
        while (at != end && !chunk.error_at) {
            std::string_view line = trim(text_.line(at));
            const std::size_t length =
                static_cast<std::size_t>(std::find_if(line.begin(), line.end(), is_blank) - line.begin());
            const std::string_view tag = line.substr(0, length);
            line = trim(line.substr(length));
            if (equals(tag, tags_.position))
                read_position(line, chunk);
            else if (equals(tag, tags_.normal))
                read_normal(line, chunk);
            else if (equals(tag, tags_.face))
                ++chunk.faces;
            else if (equals(tag, tags_.end))
                ++chunk.ends;
        }
    }

private:
    using Numbers = std::array<double, 7>;

    /// The numbers of a line, at most 7; fewer than 3 or a bad one is an error.
    std::size_t read_numbers(std::string_view line, Chunk& chunk, Numbers& numbers) const {
        const char* at = line.data();
        const char* end = at + line.size();
        std::size_t count = 0;
        while (at != end && *at != '#' && count < numbers.size()) {
            const char* next = parse_number(at, end, numbers[count]);
            if (!next || (next != end && !is_blank(*next))) {
                const char* field_end = std::find_if(at, end, is_blank);
                chunk.error_at = at;
                chunk.error = io::quoted({at, static_cast<std::size_t>(field_end - at)})
                              + " is not a number; correct the line";
                return 0;
            }
            ++count;
            for (at = next; at != end && is_blank(*at);) ++at;
        }
        if (count < 3) {
            chunk.error_at = line.data();
            chunk.error = std::to_string(count) + (count == 1 ? " number, but " : " numbers, but ")
                          + "x, y and z are needed; complete or remove the line";
            return 0;
        }
        return count;
    }

    void read_position(std::string_view line, Chunk& chunk) const {
        Numbers v;
        const std::size_t count = read_numbers(line, chunk, v);
        if (count == 0) return;
        chunk.positions.emplace_back(v[0], v[1], v[2]);
        // Six numbers: a colour behind the position; seven: a weight between them.
        if (count >= 6) chunk.colors.emplace_back(v[count - 3], v[count - 2], v[count - 1]);
    }

    void read_normal(std::string_view line, Chunk& chunk) const {
        Numbers n;
        if (read_numbers(line, chunk, n) > 0) chunk.normals.emplace_back(n[0], n[1], n[2]);
    }

    const Text& text_;
    const Tags& tags_;
};

void append(std::vector<Vec3>& all, const std::vector<Vec3>& part) {
    all.insert(all.end(), part.begin(), part.end());
}

void set_colors(PointCloud& cloud, const std::vector<Vec3>& colors) {
    double max = 0;
    bool fractions = false;
    for (const Vec3& color : colors)
        for (double value : color) {
            if (std::isfinite(value)) max = std::max(max, value);
            fractions |= value != std::floor(value);
        }
    const double factor = color_factor(max, fractions || max <= 1);
    cloud.colors.resize(colors.size(), {0, 0, 0, 255});
    for (std::size_t i = 0; i < colors.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double value = std::round(colors[i][k] * factor);
            cloud.colors[i][k] =
                value > 0 ? static_cast<std::uint8_t>(std::min(value, 255.0)) : std::uint8_t(0);
        }
}

[[noreturn]] void fail_without_points(const Text& text, std::string_view tag) {
    throw Error(text.file(),
                "holds no points: no line begins with " + io::quoted(tag) + "; check the format");
}

} // namespace

TaggedLines read_tagged(const Text& text, const Tags& tags) {
    const auto pieces = text.chunks();
    std::vector<Chunk> chunks(pieces.size());
    for_each_task(pieces.size(), [&](std::size_t i) {
        ChunkReader(text, tags).run(pieces[i].first, pieces[i].second, chunks[i]);
    });
    TaggedLines lines;
    std::vector<Vec3> colors;
    for (Chunk& chunk : chunks) {
        if (chunk.error_at) text.fail(chunk.error_at, chunk.error);
        append(lines.cloud.positions, chunk.positions);
        append(lines.cloud.normals, chunk.normals);
        append(colors, chunk.colors);
        lines.faces += chunk.faces;
        lines.ends += chunk.ends;
        chunk = {};
    }
    if (lines.cloud.positions.size() >= no_index)
        throw Error(text.file(), "holds more points than can be numbered; split the file");
    if (colors.size() == lines.cloud.positions.size()) set_colors(lines.cloud, colors);
    return lines;
}

PointFile read_obj(const SourceBytes& bytes) {
    const Text text(bytes);
    TaggedLines lines = read_tagged(text, {"v", "vn", "f", ""});
    if (lines.cloud.positions.empty()) fail_without_points(text, "v");
    // Normals of corners, not of points, come in any other number.
    if (lines.cloud.normals.size() != lines.cloud.positions.size()) lines.cloud.normals.clear();
    return {std::move(lines.cloud), "obj", lines.faces};
}

PointFile read_hoppe(const SourceBytes& bytes) {
    const Text text(bytes);
    TaggedLines lines = read_tagged(text, {"p", "", "", ""});
    if (lines.cloud.positions.empty()) fail_without_points(text, "p");
    return {std::move(lines.cloud), "hoppe", 0};
}

} // namespace hsdm::io
