#pragma once
#include "stand_in.h"

#include <exception>
#include <thread>

namespace tbb {

/// One piece of work beside the caller's, on a thread of its own.
class task_group {
public:
    ~task_group() {
        if (thread_.joinable()) thread_.join();
    }

    template <class Work>
    void run(const Work& work) {
        thread_ = std::thread([this, &work] {
            try {
                work();
            } catch (...) {
                failure_ = std::current_exception();
            }
        });
    }

    void cancel() {}

    void wait() {
        if (thread_.joinable()) thread_.join();
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    std::thread thread_;
    std::exception_ptr failure_;
};

} // namespace tbb
