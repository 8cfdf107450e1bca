#pragma once
// Options out of their range.

#include "hsdm/errors.hh"

namespace hsdm {

/// Throws OptionError `NAME VALUE: must MUST` unless it holds.
template <class Value>
void check_option(bool holds, const std::string& name, Value value, const std::string& must) {
    if (!holds) throw OptionError(name + " " + std::to_string(value) + ": must " + must);
}

} // namespace hsdm
