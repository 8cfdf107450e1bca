#include "messages.hh"

#include "hsdm/errors.hh"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <optional>
#include <vector>

namespace hsdm::command {
namespace {

/// Length of the UTF-8 character that the text begins with; 0 if it is none, or a control character.
std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) return byte(0) >= 0x20 && byte(0) != 0x7f;
    const std::size_t length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
    if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    // The second byte also rules out what two bytes would do for, surrogates, numbers beyond the last, and
    // C1.
    const unsigned char second = byte(1);
    const bool wrong = (byte(0) == 0xc2 && second < 0xa0) || (byte(0) == 0xe0 && second < 0xa0)
                       || (byte(0) == 0xed && second > 0x9f) || (byte(0) == 0xf0 && second < 0x90)
                       || (byte(0) == 0xf4 && second > 0x8f);
    return wrong ? 0 : length;
}

/// How many letters must be put in, left out or changed to make one word of the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t(0));
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

/// The library's options that the command leaves to it.
constexpr std::pair<std::string_view, std::string_view> option_names[] = {{"voxel_size", "--voxel-size"},
                                                                          {"columns", "--columns"},
                                                                          {"format", "--input-format"},
                                                                          {"module", "--module"}};

std::string in_option_words(const std::string& message) {
    for (const auto& [library, command] : option_names)
        if (message.starts_with(library) && message.find_first_of(" :") == library.size())
            return std::string(command) + message.substr(library.size());
    return message;
}

} // namespace

std::string printable(std::string_view text) {
    constexpr char digits[] = "0123456789abcdef";
    std::string result;
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        if (length > 0) {
            result += text.substr(0, length);
        } else {
            const auto byte = static_cast<unsigned char>(text[0]);
            result += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result;
}

std::string words_of(const std::exception& error) {
    if (dynamic_cast<const OptionError*>(&error)) return in_option_words(error.what());
    if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
        return file->path1().string() + ": cannot be used: " + file->code().message() + "; check the path";
    return error.what();
}

std::string suggestion(std::string_view word, std::span<const std::string> known) {
    const std::string* nearest = nullptr;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& name : known) {
        // So many letters at least are put in or left out: very long words cost no time.
        if (std::max(word.size(), name.size()) - std::min(word.size(), name.size()) >= least) continue;
        const std::size_t distance = edit_distance(word, name);
        if (distance >= least) continue;
        least = distance;
        nearest = &name;
    }
    return nullptr == nearest ? "" : "; did you mean " + *nearest + "?";
}

} // namespace hsdm::command
