#include "tools/host/files/file_system.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "tools/host/files/file_obstacles.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {

std::string why_not_to_be_written(const std::string&) { return {}; }

std::string error_text(int error) { return std::strerror(error); }

std::string error_text(const std::error_code& error) { return error.message(); }

namespace file_system {
namespace {

Found found(const struct stat& status) {
  const auto kind = S_ISREG(status.st_mode)    ? Found::Kind::File
                    : S_ISDIR(status.st_mode)  ? Found::Kind::Folder
                    : S_ISCHR(status.st_mode)  ? Found::Kind::Device
                    : S_ISFIFO(status.st_mode) ? Found::Kind::Pipe
                    : S_ISLNK(status.st_mode)  ? Found::Kind::Link
                                               : Found::Kind::Other;
  return {kind, {status.st_dev, status.st_ino}, static_cast<std::uint64_t>(status.st_size)};
}

}  // namespace

std::optional<Found> look_at(const std::string& path) {
  struct stat status {};
  return lstat(path.c_str(), &status) == 0 ? std::optional(found(status)) : std::nullopt;
}

std::optional<Found> look_behind(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? std::optional(found(status)) : std::nullopt;
}

std::optional<Found> look_at_descriptor(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 ? std::optional(found(status)) : std::nullopt;
}

bool is_same_name(const std::string& one, const std::string& other) { return one == other; }

bool begins_with(const std::string& path, const std::string& beginning) {
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  std::string first(beginning.size(), '\0');
  const bool read_all = file >= 0 && read(file, first.data(), first.size()) == static_cast<ssize_t>(first.size());
  if (file >= 0) ::close(file);
  return read_all && first == beginning;
}

/// The writer holds a lock on it while it is open.
bool is_being_written(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return locked;
}

int why_no_new_file(const std::string& folder) { return access(folder.c_str(), W_OK | X_OK) == 0 ? 0 : errno; }

int create_new(const std::string& path, const std::string& like) {
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) return fd;
  flock(fd, LOCK_EX | LOCK_NB);  // see is_being_written
  struct stat old {};
  if (lstat(like.c_str(), &old) != 0 || !S_ISREG(old.st_mode) || fchmod(fd, old.st_mode & 07777) == 0) return fd;
  const int error = errno;
  ::close(fd);
  unlink(path.c_str());
  errno = error;
  return -1;
}

int open_stream(const std::string& path) {
  int fd = -1;
  do fd = open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  while (fd < 0 && errno == EINTR && !interrupted());
  if (fd < 0) return fd;
  const auto there = look_at_descriptor(fd);
  if (!there || there->is_stream()) return fd;
  ::close(fd);
  errno = EEXIST;
  return -1;
}

/// Unlike rename(2) it replaces nothing. File systems that cannot do it in one step may know hard links; FAT does not.
int rename_to_new_name(const std::string& from, const std::string& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  if (link(from.c_str(), to.c_str()) == 0) return unlink(from.c_str()) == 0 ? 0 : errno;
  if (errno != EPERM && errno != EOPNOTSUPP) return errno;
  if (look_at(to)) return EEXIST;
  return rename_over(from, to);
}

int rename_over(const std::string& from, const std::string& to) {
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

int write_through(int fd) { return fsync(fd) == 0 ? 0 : errno; }

void write_names_through(const std::string& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  ::close(folder);
}

int close(int fd) { return ::close(fd) == 0 ? 0 : errno; }

void remove(const std::string& path) { unlink(path.c_str()); }

int process_number() { return getpid(); }

}  // namespace file_system
}  // namespace s7200::tools
