#pragma once
// How fast the machine is just now.

namespace hsdm::command {

/// Seconds of a fixed piece of work, about 10 ms of one processor and a few MB of memory: the lesser of two
/// rounds. It is none of the library's, so that it stays what it is when the library changes. Only ratios of
/// two such times mean anything.
double time_fixed_work();

} // namespace hsdm::command
