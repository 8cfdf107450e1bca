#pragma once
// Ctrl-C: a clean end with status 130.

namespace hsdm::command {

/// From now on SIGINT and SIGTERM are noted; a second one ends the process at once.
void handle_interrupts();

/// True once one has come.
bool interrupted();

/// While one of these lives nothing is open for writing (reading, which may wait for a pipe), so an interrupt
/// ends the process at once, with status 130.
class InterruptEndsProcess {
public:
    InterruptEndsProcess();
    ~InterruptEndsProcess();
    InterruptEndsProcess(const InterruptEndsProcess&) = delete;
    InterruptEndsProcess& operator=(const InterruptEndsProcess&) = delete;
};

} // namespace hsdm::command
