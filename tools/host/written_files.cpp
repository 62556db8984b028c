#include "tools/host/written_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "tools/host/write_all.hpp"

namespace s7200::tools {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

FileIdentity identity(const struct stat& status) { return {status.st_dev, status.st_ino}; }

/// The file that a name stands for, without following a link.
std::optional<struct stat> look_at(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return {};
  return status;
}

bool begins_with(const std::string& path, const std::string& beginning) {
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  std::string first(beginning.size(), '\0');
  const bool read_all = file >= 0 && read(file, first.data(), first.size()) == static_cast<ssize_t>(first.size());
  if (file >= 0) close(file);
  return read_all && first == beginning;
}

bool is_stream(const struct stat& status) { return S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode); }

/// Why nothing can be written under a name that stands for this; empty if a record can go there as it is.
std::string why_not(const std::string& path, const struct stat& found, const FileKind& kind) {
  struct stat target {};
  const bool leads_somewhere = stat(path.c_str(), &target) == 0;
  if (leads_somewhere && is_stream(target))
    return kind.record ? "" : fmt::format("cannot write {}: it is a device or a pipe, not a file", path);
  if (S_ISLNK(found.st_mode)) return fmt::format("{} is a link; it is left alone, and so is what it leads to", path);
  return fmt::format("cannot write {}: it is {}", path, S_ISDIR(found.st_mode) ? "a folder" : "not a file");
}

/// Whether what is there now, maybe hours after it was claimed, may be replaced.
bool may_replace(const Destination& destination, const struct stat& found) {
  if (!S_ISREG(found.st_mode)) return false;
  const auto& replaced = destination.replaced;
  if (replaced && identity(found) == replaced->file && (!replaced->empty || found.st_size == 0)) return true;
  const std::string& beginning = destination.kind.beginning;
  return !beginning.empty() && begins_with(destination.path, beginning);
}

/// Whether a file is being written: its writer holds a lock on it while it is open. File systems without locks know no
/// writer.
bool is_being_written(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  return locked;
}

/// Unlike rename(2) it replaces nothing. File systems that cannot do it in one step may know hard links; FAT does not.
int rename_to_new_name(const std::string& from, const std::string& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  if (link(from.c_str(), to.c_str()) == 0) return unlink(from.c_str()) == 0 ? 0 : errno;
  if (errno != EPERM && errno != EOPNOTSUPP) return errno;
  if (look_at(to)) return EEXIST;
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

}  // namespace

// --- claims ---

WrittenFiles::WrittenFiles(std::ostream* standard_output) : standard_output_(standard_output) {
  for (const auto& [fd, name] : {std::pair(STDOUT_FILENO, "standard output"), std::pair(STDERR_FILENO, "standard error")}) {
    struct stat status {};
    if (fstat(fd, &status) == 0 && !S_ISCHR(status.st_mode)) places_.push_back({name, identity(status), {}, {}});
  }
}

WrittenFiles::Place WrittenFiles::place_of(std::string user, const std::string& path) {
  Place place{std::move(user), {}, {}, fs::path(path).filename().string()};
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) place.file = identity(status);
  if (stat(folder_of(path).c_str(), &status) == 0) place.folder = identity(status);
  return place;
}

void WrittenFiles::reads(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode)) places_.push_back(place_of("", path));
}

void WrittenFiles::links(std::string_view option, const std::string& path) {
  if (!path.empty()) places_.push_back(place_of(std::string(option), path));
}

std::optional<Destination> WrittenFiles::claim(std::string_view option, const std::string& path, FileKind kind,
                                               Replace replace, std::string& why) {
  const auto refuse = [&why](std::string message) {
    why = std::move(message);
    return std::nullopt;
  };
  Destination destination{.path = path, .kind = std::move(kind)};
  const auto found = look_at(path);
  struct stat target {};
  const bool device = stat(path.c_str(), &target) == 0 && S_ISCHR(target.st_mode);
  const Place here = place_of(std::string(option), path);
  for (const Place& other : places_) {
    const bool same_file = here.file && here.file == other.file;
    const bool same_name = here.folder && here.folder == other.folder && here.name == other.name;
    if (device || !(same_file || same_name)) continue;
    return refuse(other.user.empty()
                      ? fmt::format("{} {}: the command reads this file; name another", option, path)
                      : fmt::format("{} {}: this file is named twice; {} has it already", option, path, other.user));
  }
  places_.push_back(here);

  if (found && !S_ISREG(found->st_mode)) {
    if (std::string reason = why_not(path, *found, destination.kind); !reason.empty()) return refuse(std::move(reason));
    destination.stream = true;
    return destination;
  }
  const bool holds_something = found && found->st_size != 0;
  if (holds_something && replace == Replace::Own && !begins_with(path, destination.kind.beginning))
    return refuse(fmt::format("{} exists and is not {}; it is left alone", path, destination.kind.name));
  if (holds_something && replace == Replace::Never) return refuse(fmt::format("{} exists", path));
  if (found && is_being_written(path))
    return refuse(fmt::format("{} {}: another command is still writing it; name another", option, path));
  if (access(folder_of(path).c_str(), W_OK | X_OK) != 0)
    return refuse(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  if (found) destination.replaced = {identity(*found), found->st_size == 0};
  return destination;
}

// --- writing ---

NewFile::~NewFile() {
  close();
  if (!beside_.empty()) unlink(beside_.c_str());
}

/// Creates the new file with the rights of the file that it is to replace.
int NewFile::create(const Destination& destination) {
  const std::string beside = fmt::format("{}.{}.new", destination.path, getpid());
  fd_ = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd_ < 0) return errno;
  beside_ = beside;
  flock(fd_, LOCK_EX | LOCK_NB);  // see is_being_written
  const auto old = look_at(destination.path);
  return old && S_ISREG(old->st_mode) && fchmod(fd_, old->st_mode & 07777) != 0 ? errno : 0;
}

int NewFile::put(const Destination& destination) {
  const auto found = look_at(destination.path);
  if (found && !may_replace(destination, *found)) return EEXIST;
  const int error = !found ? rename_to_new_name(beside_, destination.path)
                    : std::rename(beside_.c_str(), destination.path.c_str()) == 0 ? 0
                                                                                  : errno;
  if (error == 0) beside_.clear();
  return error;
}

int NewFile::close() {
  if (fd_ < 0) return 0;
  const int error = ::close(fd_) == 0 ? 0 : errno;
  fd_ = -1;
  return error;
}

bool GrowingResult::check(int error, std::string& why) const {
  if (error != 0) why = fmt::format("cannot write {}: {}", destination_.path, std::strerror(error));
  return error == 0;
}

bool GrowingResult::begin(const Destination& destination, std::string& why) {
  destination_ = destination;
  return check(file_.create(destination_), why);
}

bool GrowingResult::add(std::string_view text, std::string& why) { return check(write_all(file_.fd(), text), why); }

bool GrowingResult::complete(std::string& why) {
  int error = fsync(file_.fd()) != 0 ? errno : 0;
  if (error == 0) error = file_.close();
  if (error == 0) error = file_.put(destination_);
  if (!check(error, why)) return false;
  // The new name itself on the disk as well; not every file system knows how, and the content is safe already.
  if (const int folder = open(folder_of(destination_.path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); folder >= 0) {
    fsync(folder);
    close(folder);
  }
  return true;
}

bool write_result(const Destination& destination, std::string_view text, std::string& why) {
  GrowingResult result;
  return result.begin(destination, why) && result.add(text, why) && result.complete(why);
}

}  // namespace s7200::tools
