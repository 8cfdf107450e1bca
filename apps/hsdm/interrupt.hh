#pragma once
// How the command ends before its time: by a signal, or where an exception can go no further.

#include <functional>
#include <mutex>

namespace hsdm::command {

/// To be called once, before any thread is started. From then on SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU
/// end the process at once, whatever it is at (but see hold_end()): temporary files are removed, one message
/// says what stands, and the status is 128 + the signal. A thread of its own waits for them. Signals that
/// were ignored stay so (nohup), but for SIGINT and SIGQUIT, which shells ignore for every job in the
/// background. SIGPIPE and SIGXFSZ are ignored: writing fails with an error instead. std::terminate ends with
/// a message and status 1.
void handle_signals();

/// A signal that comes while this is held ends the process once it is not, or after five seconds.
std::unique_lock<std::mutex> hold_end();

/// While it lives, a signal has the work done before it ends the process, by the thread that waits for
/// signals. The work must come to an end soon; its exceptions are dropped. One at a time.
class LastWork {
public:
    explicit LastWork(std::function<void()> work);
    /// Waits for the end of the process if the work has begun.
    ~LastWork();
    LastWork(const LastWork&) = delete;
    LastWork& operator=(const LastWork&) = delete;

    /// To be held while what the work reads is changed. Once the work has begun, it is waited for for ever.
    std::unique_lock<std::mutex> lock() { return hold_end(); }

private:
    std::function<void()> work_;
};

} // namespace hsdm::command
