#include "tools/host/files/write_all.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <optional>

#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(5);
constexpr int kLookAgain = 100;  // ms

}  // namespace

int write_all(int fd, std::string_view bytes) {
  std::optional<Clock::time_point> stuck_since;
  while (!bytes.empty()) {
    const ssize_t count = write(fd, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
      stuck_since.reset();
      continue;
    }
    if (errno != EINTR && errno != EAGAIN) return errno;
    if (errno == EAGAIN) {  // the descriptor is one that does not block
      pollfd writable{fd, POLLOUT, 0};
      poll(&writable, 1, kLookAgain);
    }
    if (!interrupted()) continue;
    if (!stuck_since) stuck_since = Clock::now();
    if (Clock::now() - *stuck_since > kPatience) return ETIMEDOUT;
  }
  return 0;
}

}  // namespace s7200::tools
