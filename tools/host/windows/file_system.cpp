#include "tools/host/files/file_system.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <io.h>
#include <process.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "tools/host/files/file_obstacles.hpp"
#include "tools/host/windows/native_text.hpp"

namespace s7200::tools {

/// What goes to NUL is thrown away, and a record may be. A file that one of our commands writes may be read.
std::string why_not_to_be_written(const std::string& path) {
  if (is_null_device(path)) return {};
  if (is_device_name(path)) return "it is the name of a device of Windows; name another";
  const DWORD attributes = GetFileAttributesW(native_path(path).c_str());  // of a folder they do not protect what is in it
  const bool is_file = attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) == 0;
  if (is_file && (attributes & FILE_ATTRIBUTE_READONLY) != 0) return "it is write-protected; name another";
  const Handle file(CreateFileW(native_path(path).c_str(), GENERIC_READ,
                                FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr, OPEN_EXISTING, 0, nullptr));
  return !file && GetLastError() == ERROR_SHARING_VIOLATION ? words_of(ERROR_SHARING_VIOLATION) : "";
}

std::string error_text(int error) {
  switch (error) {
    case EBUSY:
      return words_of(ERROR_SHARING_VIOLATION);
    case ENOSPC:
      return words_of(ERROR_DISK_FULL);
    case EROFS:
      return words_of(ERROR_WRITE_PROTECT);
    case EINVAL:
      return words_of(ERROR_INVALID_NAME);
    case EPIPE:
      return words_of(ERROR_BROKEN_PIPE);
    default:
      return std::strerror(error);
  }
}

std::string error_text(const std::error_code& error) {
  if (error.category() == std::system_category()) return words_of(static_cast<DWORD>(error.value()));
  return error.category() == std::generic_category() ? error_text(error.value()) : error.message();
}

namespace file_system {
namespace {

constexpr DWORD kShareAll = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

Found::Kind kind_of(const BY_HANDLE_FILE_INFORMATION& info) {
  if ((info.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0) return Found::Kind::Link;
  return (info.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0 ? Found::Kind::Folder : Found::Kind::File;
}

std::optional<Found> look_at_handle(HANDLE handle) {
  BY_HANDLE_FILE_INFORMATION info{};
  switch (GetFileType(handle)) {
    case FILE_TYPE_CHAR:
      return Found{.kind = Found::Kind::Device};
    case FILE_TYPE_PIPE:
      return Found{.kind = Found::Kind::Pipe};
    case FILE_TYPE_DISK:
      if (GetFileInformationByHandle(handle, &info) == 0) return {};
      return Found{kind_of(info),
                   {info.dwVolumeSerialNumber, std::uint64_t{info.nFileIndexHigh} << 32 | info.nFileIndexLow},
                   std::uint64_t{info.nFileSizeHigh} << 32 | info.nFileSizeLow};
    default:
      return {};
  }
}

/// Devices are known by their names: to open one could do something.
std::optional<Found> look(const std::string& path, DWORD flags) {
  if (is_device_name(path)) return Found{.kind = is_null_device(path) ? Found::Kind::Device : Found::Kind::Other};
  const Handle handle(CreateFileW(native_path(path).c_str(), FILE_READ_ATTRIBUTES, kShareAll, nullptr, OPEN_EXISTING,
                                  FILE_FLAG_BACKUP_SEMANTICS | flags, nullptr));
  return handle ? look_at_handle(handle.get()) : std::nullopt;
}

/// A file that another program has open, in whatever way, and one that may not be written give the same error when they are to be
/// replaced.
int why_not_replaced(const std::string& path) {
  constexpr DWORD kShareNothing = 0;
  const Handle file(CreateFileW(native_path(path).c_str(), DELETE, kShareNothing, nullptr, OPEN_EXISTING,
                                FILE_FLAG_OPEN_REPARSE_POINT, nullptr));
  return !file && GetLastError() == ERROR_SHARING_VIOLATION ? EBUSY : EACCES;
}

/// 0 or the error; tried again for a moment, because a virus scanner or an index may have a new file open just now.
int move_file(const std::string& from, const std::string& to, DWORD flags) {
  constexpr int kTries = 20;
  for (int tries = 1;; ++tries) {
    if (MoveFileExW(native_path(from).c_str(), native_path(to).c_str(), flags | MOVEFILE_WRITE_THROUGH) != 0) return 0;
    const DWORD error = GetLastError();
    const bool held = error == ERROR_SHARING_VIOLATION || error == ERROR_ACCESS_DENIED;
    if (!held || tries == kTries)
      return error == ERROR_ACCESS_DENIED && look_at(to) ? why_not_replaced(to) : errno_of(error);
    Sleep(50);
  }
}

}  // namespace

std::optional<Found> look_at(const std::string& path) { return look(path, FILE_FLAG_OPEN_REPARSE_POINT); }

std::optional<Found> look_behind(const std::string& path) { return look(path, 0); }

std::optional<Found> look_at_descriptor(int fd) {
  const DWORD which = fd == 0 ? STD_INPUT_HANDLE : fd == 1 ? STD_OUTPUT_HANDLE : STD_ERROR_HANDLE;
  return look_at_handle(GetStdHandle(which));
}

/// Without regard to case, as the file systems of Windows are unless a folder is set otherwise; blanks and periods at the
/// end do not count.
bool is_same_name(const std::string& one, const std::string& other) {
  const auto counting = [](const std::string& name) {
    std::wstring text = wide(name);
    text.erase(text.find_last_not_of(L" .") + 1);
    return text;
  };
  const std::wstring a = counting(one), b = counting(other);
  return CompareStringOrdinal(a.data(), static_cast<int>(a.size()), b.data(), static_cast<int>(b.size()), TRUE) ==
         CSTR_EQUAL;
}

bool begins_with(const std::string& path, const std::string& beginning) {
  const Handle file(CreateFileW(native_path(path).c_str(), GENERIC_READ, kShareAll, nullptr, OPEN_EXISTING,
                                FILE_FLAG_OPEN_REPARSE_POINT, nullptr));
  std::string first(beginning.size(), '\0');
  DWORD count = 0;
  return file && ReadFile(file.get(), first.data(), static_cast<DWORD>(first.size()), &count, nullptr) != 0 &&
         count == first.size() && first == beginning;
}

/// What one program has open and lets nobody write, another cannot open for writing.
bool is_being_written(const std::string& path) {
  const Handle file(CreateFileW(native_path(path).c_str(), GENERIC_WRITE, kShareAll, nullptr, OPEN_EXISTING,
                                FILE_ATTRIBUTE_NORMAL, nullptr));
  return !file && GetLastError() == ERROR_SHARING_VIOLATION;
}

/// Rights are lists in Windows that only an attempt decides.
int why_no_new_file(const std::string& folder) {
  const auto found = look_behind(folder);
  if (!found) return ENOENT;
  if (found->kind != Found::Kind::Folder) return ENOTDIR;
  const std::string probe = (file_path(folder) / fmt::format("s7200.{}.new", process_number())).string();
  const Handle file(CreateFileW(native_path(probe).c_str(), GENERIC_WRITE | DELETE, kShareAll, nullptr, CREATE_NEW,
                                FILE_FLAG_DELETE_ON_CLOSE | FILE_ATTRIBUTE_TEMPORARY, nullptr));
  return file ? 0 : errno_of(GetLastError());
}

int create_new(const std::string& path, const std::string&) {
  Handle file(CreateFileW(native_path(path).c_str(), GENERIC_WRITE | DELETE, FILE_SHARE_READ | FILE_SHARE_DELETE, nullptr,
                          CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr));
  if (!file) {
    errno = errno_of(GetLastError());
    return -1;
  }
  return _open_osfhandle(reinterpret_cast<intptr_t>(file.release()), _O_WRONLY | _O_BINARY | _O_NOINHERIT);
}

int open_stream(const std::string& path) {
  Handle file(CreateFileW(native_path(path).c_str(), GENERIC_WRITE, kShareAll, nullptr, OPEN_EXISTING, 0, nullptr));
  if (!file) {
    errno = errno_of(GetLastError());
    return -1;
  }
  return _open_osfhandle(reinterpret_cast<intptr_t>(file.release()), _O_WRONLY | _O_BINARY | _O_NOINHERIT);
}

int rename_to_new_name(const std::string& from, const std::string& to) { return move_file(from, to, 0); }

int rename_over(const std::string& from, const std::string& to) { return move_file(from, to, MOVEFILE_REPLACE_EXISTING); }

int write_through(int fd) { return _commit(fd) == 0 ? 0 : errno; }

/// NTFS keeps the names in its journal.
void write_names_through(const std::string&) {}

int close(int fd) { return ::_close(fd) == 0 ? 0 : errno; }

void remove(const std::string& path) { DeleteFileW(native_path(path).c_str()); }

int process_number() { return _getpid(); }

}  // namespace file_system
}  // namespace s7200::tools
