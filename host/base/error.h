// The one exception of the program.
//
// A programmer's error is an assert; the world's error (file, scene, device, memory) is an Error, caught once
// in main(); an expected absence is a std::optional. The message of an Error names the thing, the place, the
// cause and the remedy, and ends without a full stop or line feed.
#pragma once

#include <stdexcept>
#include <string>

namespace candela {

// What callers tell apart.
enum class ErrorKind {
    other,
    request,  // What was asked for makes no sense, or is not there: an option, the name of a camera.
    no_device,
    device_lost,
    out_of_memory,
};

class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& message, ErrorKind kind = ErrorKind::other)
        : std::runtime_error(message), kind_(kind) {}

    ErrorKind kind() const { return kind_; }

  private:
    ErrorKind kind_;
};

}  // namespace candela
