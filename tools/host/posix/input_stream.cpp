#include "tools/host/files/input_stream.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tools/host/posix/descriptor_stream.hpp"

namespace s7200::tools {
namespace {

class StandardInput final : public InputStream {
 public:
  Reading read(std::span<char> into, std::chrono::milliseconds at_most) override {
    return read_descriptor(STDIN_FILENO, into, at_most);
  }
};

}  // namespace

InputStream::Reading read_descriptor(int fd, std::span<char> into, std::chrono::milliseconds at_most) {
  using Came = InputStream::Came;
  pollfd readable{fd, POLLIN, 0};
  if (poll(&readable, 1, static_cast<int>(at_most.count())) <= 0) return {};
  const ssize_t count = ::read(fd, into.data(), into.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return {};
  if (count < 0) return {.came = Came::Failure, .why = std::strerror(errno)};
  return count == 0 ? InputStream::Reading{.came = Came::End}
                    : InputStream::Reading{.came = Came::Bytes, .count = static_cast<std::size_t>(count)};
}

InputStream& standard_input() {
  static StandardInput input;
  return input;
}

}  // namespace s7200::tools
