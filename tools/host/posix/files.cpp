#include "tools/host/files/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <span>

#include "interpreter/base/result.hpp"

namespace s7200::tools {
namespace {

/// Larger than any program; a pipe may never end.
constexpr std::size_t kLargestFile = 64 << 20;

/// A file or a pipe, and nothing else: reading from a serial port would wait for ever, and steal another program's data.
struct OpenFile {
  // Otherwise opening a serial port would wait for its carrier, and opening a pipe for its writer.
  explicit OpenFile(const std::string& path) : fd(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (fd >= 0) close(fd);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  Result<> can_be_read() const {
    struct stat status {};
    if (fd < 0 || fstat(fd, &status) != 0) return Trouble{std::strerror(errno)};
    if (S_ISREG(status.st_mode) || S_ISFIFO(status.st_mode)) return {};
    return Trouble{S_ISDIR(status.st_mode) ? "it is a folder" : "it is a device, not a file"};
  }

  const int fd;
};

/// Reads, and waits for a writer. Returns -1 with EINTR after a signal, so that Ctrl-C ends the wait for a pipe without a
/// writer.
ssize_t read_some(int fd, std::span<char> piece) {
  pollfd written{fd, POLLIN, 0};
  return poll(&written, 1, -1) < 0 ? -1 : read(fd, piece.data(), piece.size());
}

Result<std::string> read_all(int fd) {
  std::string bytes;
  std::array<char, 65536> piece{};
  for (;;) {
    const ssize_t count = read_some(fd, piece);
    if (count == 0) return bytes;
    if (count < 0) return Trouble{std::strerror(errno)};
    bytes.append(piece.data(), static_cast<std::size_t>(count));
    if (bytes.size() > kLargestFile) return trouble("it is larger than {} MB", kLargestFile >> 20);
  }
}

class HostFiles final : public FileSource {
 public:
  Result<std::string> read(const std::string& path) const override { return read_file(path); }
  bool exists(const std::string& path) const override { return access(path.c_str(), F_OK) == 0; }
};

}  // namespace

Result<std::string> read_file(const std::string& path) {
  const OpenFile file(path);
  if (const auto done = file.can_be_read(); !done) return done.trouble();
  return read_all(file.fd);
}

Result<std::string> read_text(const std::string& path) { return host_files().read_text(path); }

Result<std::string> read_standard_input() { return read_all(STDIN_FILENO); }

const FileSource& host_files() {
  static const HostFiles kFiles;
  return kFiles;
}

}  // namespace s7200::tools
