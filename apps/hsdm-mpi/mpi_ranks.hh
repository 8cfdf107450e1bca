#pragma once
// The processes that mpirun or srun has started.

#include "hsdm/core/ranks.hh"

namespace hsdm::command {

/// MPI from its beginning to its end: one a process. Waiting takes no processor time to speak of, so that
/// ranks may share cores.
class MpiRanks final : public Ranks {
public:
    /// Throws Error if MPI cannot be used.
    MpiRanks(int& argc, char**& argv);
    /// Others that wait for this rank hear that it is gone.
    ~MpiRanks() override;

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    std::unique_ptr<SharedFile> open_shared(const std::string& path) override;

private:
    std::vector<Bytes> gather_bytes(const Bytes& own) override;
    std::vector<Bytes> exchange_bytes(std::vector<Bytes>&& out,
                                      const std::vector<std::vector<std::uint64_t>>& sizes) override;
    [[noreturn]] void abort(const std::string& why) noexcept override;

    int rank_ = 0, size_ = 1;
};

} // namespace hsdm::command
