#include "hsdm/core/shared_file.hh"

#include "hsdm/core/system.hh"

#include <cerrno>
#include <cstring>

namespace hsdm {
namespace {

class PositionedFile final : public SharedFile {
public:
    explicit PositionedFile(int descriptor) : descriptor_(descriptor) {}
    ~PositionedFile() override { os::close(descriptor_); }

    std::string write_at(std::uint64_t offset, std::string_view bytes) override {
        return os::write_all_at(descriptor_, bytes, offset) ? std::string() : std::strerror(errno);
    }
    std::string close() override {
        return os::flush_to_disk(descriptor_) ? std::string() : std::strerror(errno);
    }

private:
    int descriptor_;
};

} // namespace

std::unique_ptr<SharedFile> open_positioned(const std::string& path) {
    const int descriptor = os::open_entry_to_write(path);
    return descriptor < 0 ? nullptr : std::make_unique<PositionedFile>(descriptor);
}

} // namespace hsdm
