#pragma once
// Connected components of a few things that all may be joined with each other.

#include <array>
#include <cstddef>
#include <cstdint>

namespace hsdm {

/// Labels the connected components of up to 255 things from 0, in order of their first: `label(i)` refers to
/// the label of the i-th. `joined(i, j)`, symmetric, is asked for i on a component and j not yet on any.
/// Returns how many components there are. O(count^2).
template <class Label, class Joined>
std::uint8_t label_components(std::size_t count, Label&& label, Joined&& joined) {
    constexpr std::uint8_t none = 0xff;
    std::array<std::uint8_t, none> pending;
    for (std::size_t i = 0; i < count; ++i) label(i) = none;
    std::uint8_t components = 0;
    for (std::size_t start = 0; start < count; ++start) {
        if (label(start) != none) continue;
        std::size_t waiting = 0;
        pending[waiting++] = static_cast<std::uint8_t>(start);
        label(start) = components;
        while (waiting > 0) {
            const std::size_t from = pending[--waiting];
            for (std::size_t to = start + 1; to < count; ++to) {
                if (label(to) != none || !joined(from, to)) continue;
                label(to) = components;
                pending[waiting++] = static_cast<std::uint8_t>(to);
            }
        }
        ++components;
    }
    return components;
}

} // namespace hsdm
