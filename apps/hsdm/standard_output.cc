#include "standard_output.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"

#include <cerrno>
#include <cstring>
#include <iostream>

namespace hsdm::command {

StandardOutput::StandardOutput() : before_(std::cout.rdbuf(this)) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
}

StandardOutput::~StandardOutput() {
    sync();
    std::cout.rdbuf(before_);
}

void StandardOutput::finish() {
    if (sync() == 0 && std::cout) return;
    throw Error("standard output", "could not be written"
                                       + (error_ ? std::string(": ") + std::strerror(error_) : "")
                                       + "; is the reader still there, and room on the disk?");
}

StandardOutput::int_type StandardOutput::overflow(int_type character) {
    if (sync() != 0) return traits_type::eof();
    if (!traits_type::eq_int_type(character, traits_type::eof())) sputc(traits_type::to_char_type(character));
    return traits_type::not_eof(character);
}

int StandardOutput::sync() {
    for (const char* next = pbase(); next < pptr() && error_ == 0;) {
        const auto written = os::write(os::standard_output, next, static_cast<std::size_t>(pptr() - next));
        if (written > 0)
            next += written;
        else if (written == 0 || errno != EINTR)
            error_ = written == 0 ? EIO : errno;
    }
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return error_ == 0 ? 0 : -1;
}

} // namespace hsdm::command
