#pragma once
// The list of stages.

namespace hsdm::command {

/// Prints the stages that are built in, then the modules there are, or why they cannot be used. Runs no code
/// of theirs. Returns the exit status.
int list_stages(bool as_json);

} // namespace hsdm::command
