#pragma once
// How the command ends before its time: by a signal, or where an exception can go no further.

namespace hsdm::command {

/// To be called once, before any thread is started. From then on SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU
/// end the process at once, whatever it is at: temporary files are removed, one message says what stands, and
/// the status is 128 + the signal. A thread of its own waits for them. Signals that were ignored stay so
/// (nohup), but for SIGINT and SIGQUIT, which shells ignore for every job in the background. SIGPIPE and
/// SIGXFSZ are ignored: writing fails with an error instead. std::terminate ends with a message and status 1.
void handle_signals();

} // namespace hsdm::command
