#include "standard_output.hh"

#include "hsdm/errors.hh"

#include <cerrno>
#include <cstring>
#include <iostream>

#include <unistd.h>

namespace hsdm::command {

StandardOutput::StandardOutput() : before_(std::cout.rdbuf(this)) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
}

StandardOutput::~StandardOutput() {
    sync();
    std::cout.rdbuf(before_);
}

void StandardOutput::finish() {
    if (sync() != 0)
        throw Error("standard output", std::string("could not be written: ") + std::strerror(error_)
                                           + "; is the reader still there, and room on the disk?");
}

StandardOutput::int_type StandardOutput::overflow(int_type character) {
    if (sync() != 0) return traits_type::eof();
    if (!traits_type::eq_int_type(character, traits_type::eof())) sputc(traits_type::to_char_type(character));
    return traits_type::not_eof(character);
}

int StandardOutput::sync() {
    for (const char* next = pbase(); next < pptr() && error_ == 0;) {
        const auto written = write(STDOUT_FILENO, next, static_cast<std::size_t>(pptr() - next));
        if (written >= 0)
            next += written;
        else if (errno != EINTR)
            error_ = errno;
    }
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return error_ == 0 ? 0 : -1;
}

} // namespace hsdm::command
