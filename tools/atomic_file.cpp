#include "tools/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace s7200::tools {
namespace {

namespace fs = std::filesystem;

bool failed(std::string& why) {
  why = std::strerror(errno);
  return false;
}

std::string folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

std::string behind_links(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(path, error);
  return error ? path : target.string();
}

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return fsync(file) == 0;
}

/// With the rights of the file it is to replace.
bool write_new(const std::string& path, const std::string& replaced, std::string_view text, std::string& why) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return failed(why);
  struct stat old {};
  bool good = stat(replaced.c_str(), &old) != 0 || fchmod(file, old.st_mode & 07777) == 0;
  good = good && write_all(file, text);
  if (!good) failed(why);
  if (close(file) != 0 && good) good = failed(why);
  return good;
}

}  // namespace

bool can_be_written(const std::string& path, std::string& why) {
  const std::string target = behind_links(path);
  std::error_code error;
  const fs::file_status found = fs::status(target, error);
  if (fs::exists(found) && !fs::is_regular_file(found)) {
    why = fs::is_directory(found) ? "it is a directory" : "it is a device or a pipe, not a file";
    return false;
  }
  return access(folder_of(target).c_str(), W_OK | X_OK) == 0 || failed(why);
}

bool write_atomically(const std::string& path, std::string_view text, std::string& why) {
  if (!can_be_written(path, why)) return false;
  const std::string target = behind_links(path);
  const std::string beside = fmt::format("{}.{}.new", target, getpid());
  if (!write_new(beside, target, text, why)) {
    if (errno != EEXIST) unlink(beside.c_str());
    return false;
  }
  if (std::rename(beside.c_str(), target.c_str()) != 0) {
    failed(why);
    unlink(beside.c_str());
    return false;
  }
  // The new name itself on the disk as well; not every file system knows how, and the content is safe already.
  if (const int folder = open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); folder >= 0) {
    fsync(folder);
    close(folder);
  }
  return true;
}

}  // namespace s7200::tools
