#include "tools/command/terminal/standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ext/stdio_sync_filebuf.h>
#include <iostream>

#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/write_all.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

std::atomic<int> output_error = 0;  // why standard output takes nothing more

/// As glibc does for programs that change their user (csu/check_fds.c): opened the wrong way round, it can neither be read
/// (0) nor written (1, 2).
void fill_closed_descriptors() {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd)
    if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY) != fd) _exit(kUnusable);
}

// The streams see no error: fmt::print would throw it, and what is under way would end without its files.

ssize_t write_results(void*, const char* bytes, std::size_t size) {
  if (output_error != 0) return static_cast<ssize_t>(size);
  if (const int error = write_all(STDOUT_FILENO, {bytes, size}); error != 0) {
    output_error = error;
    interrupt_quietly();
  }
  return static_cast<ssize_t>(size);
}

ssize_t write_message(void*, const char* bytes, std::size_t size) {
  write_all(STDERR_FILENO, {bytes, size});
  return static_cast<ssize_t>(size);
}

/// Null if there is no memory for it.
std::FILE* stream(ssize_t (*write)(void*, const char*, std::size_t), int buffering) {
  std::FILE* const file = fopencookie(nullptr, "w", {nullptr, write, nullptr, nullptr});
  if (!file) _exit(kUnusable);
  std::setvbuf(file, nullptr, buffering, BUFSIZ);
  return file;
}

/// They live as long as the process, whose last act may be to flush them.
std::streambuf* buffer_of(std::FILE* file) { return new __gnu_cxx::stdio_sync_filebuf<char>(file); }

}  // namespace

void open_standard_streams() {
  fill_closed_descriptors();
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  // The GNU C library lets these be set (manual, 12.2 Standard Streams).
  stdout = stream(write_results, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF);
  stderr = stream(write_message, _IONBF);
  std::cout.rdbuf(buffer_of(stdout));
  std::cerr.rdbuf(buffer_of(stderr));
  std::clog.rdbuf(std::cerr.rdbuf());
}

int close_standard_streams(int exit_code) {
  std::fflush(stdout);
  if (output_error == 0) return exit_code;
  if (output_error == EPIPE) {
    signal(SIGPIPE, SIG_DFL);
    raise(SIGPIPE);
  }
  print_error(fmt::format("cannot write to standard output: {}", std::strerror(output_error)));
  return kUnusable;
}

}  // namespace s7200::tools
