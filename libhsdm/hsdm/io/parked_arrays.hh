#pragma once
// Large arrays that wait on scratch while nothing reads them.

#include "hsdm/core/large_vector.hh"
#include "hsdm/core/system.hh"
#include "hsdm/io/scratch_bytes.hh"

#include <functional>
#include <optional>

namespace hsdm {

/// Its file goes with it, whether what it holds was restored or not.
class ParkedArrays {
public:
    /// Without a place arrays stay where they are. Throws Error as ScratchBytes.
    explicit ParkedArrays(const ScratchPlace* place) {
        if (place) file_.emplace(*place);
    }
    ParkedArrays(const ParkedArrays&) = delete;
    ParkedArrays& operator=(const ParkedArrays&) = delete;

    /// Writes arrays to scratch and gives their memory back. They must outlive this. Throws Error if the disk
    /// has no room for all.
    template <class... T>
    void park(std::vector<T>&... arrays) {
        if (!file_) return;
        file_->check_room(what_, (... + (arrays.size() * sizeof(T))));
        (park_one(arrays), ...);
        os::give_back_freed_memory();
    }
    /// Reads all back. Throws Error if scratch cannot be read.
    void restore() {
        for (const auto& read : reads_) read();
        reads_.clear();
    }

private:
    template <class T>
    void park_one(std::vector<T>& values) {
        const std::size_t count = values.size(), at = file_->append(what_, values);
        release(values);
        reads_.emplace_back([this, at, count, &values] {
            resize_unwritten(values, count);
            file_->read(at, values.data(), count * sizeof(T));
        });
    }

    static constexpr const char* what_ = "arrays of the mesh that wait";
    std::optional<ScratchBytes> file_;
    std::vector<std::function<void()>> reads_;
};

} // namespace hsdm
