#include "tools/host/windows/native_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

struct KnownError {
  DWORD error;
  int as_errno;
  std::string_view words;
};

/// Those that a user of the command meets: in the words of Linux where the same happens there, so that messages are alike, else
/// in ours.
constexpr std::array kKnownErrors{
    KnownError{ERROR_FILE_NOT_FOUND, ENOENT, "No such file or directory"},
    KnownError{ERROR_PATH_NOT_FOUND, ENOENT, "No such file or directory"},
    KnownError{ERROR_INVALID_DRIVE, ENOENT, "there is no such drive"},
    KnownError{ERROR_BAD_NETPATH, ENOENT, "the other computer or its share is not to be found"},
    KnownError{ERROR_BAD_NET_NAME, ENOENT, "the other computer or its share is not to be found"},
    KnownError{ERROR_INVALID_NAME, EINVAL, "this cannot be the name of a file"},
    KnownError{ERROR_ACCESS_DENIED, EACCES, "Permission denied"},
    KnownError{ERROR_WRITE_PROTECT, EROFS, "the disk is write-protected"},
    KnownError{ERROR_NOT_READY, EIO, "the drive is not ready"},
    KnownError{ERROR_SHARING_VIOLATION, EBUSY, "another program has it open"},
    KnownError{ERROR_LOCK_VIOLATION, EBUSY, "another program has it open"},
    KnownError{ERROR_USER_MAPPED_FILE, EBUSY, "another program has it open"},
    KnownError{ERROR_FILE_EXISTS, EEXIST, "File exists"},
    KnownError{ERROR_ALREADY_EXISTS, EEXIST, "File exists"},
    KnownError{ERROR_DISK_FULL, ENOSPC, "the disk is full"},
    KnownError{ERROR_HANDLE_DISK_FULL, ENOSPC, "the disk is full"},
    KnownError{ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG, "the path is too long"},
    KnownError{ERROR_BROKEN_PIPE, EPIPE, "the other end has been closed"},
    KnownError{ERROR_NO_DATA, EPIPE, "the other end has been closed"},
    KnownError{ERROR_GEN_FAILURE, EIO, "a device attached to the computer does not work"},
    KnownError{ERROR_NOT_ENOUGH_MEMORY, ENOMEM, "there is not enough memory"},
    KnownError{WSAECONNREFUSED, ECONNREFUSED, "Connection refused"},
    KnownError{WSAETIMEDOUT, ETIMEDOUT, "Connection timed out"},
    KnownError{WSAEADDRINUSE, EADDRINUSE, "Address already in use"},
    KnownError{WSAEACCES, EACCES,
               "another program has this port for itself, or Windows keeps it back: "
               "netsh interface ipv4 show excludedportrange tcp"},
    KnownError{WSAECONNRESET, ECONNRESET, "Connection reset by peer"},
    KnownError{WSAECONNABORTED, ECONNABORTED, "Connection reset by peer"},
    KnownError{WSAEHOSTUNREACH, EHOSTUNREACH, "No route to host"},
    KnownError{WSAENETUNREACH, ENETUNREACH, "No route to host"},
    KnownError{WSAHOST_NOT_FOUND, ENOENT, "Name or service not known"},
    KnownError{WSANO_DATA, ENOENT, "Name or service not known"},
    KnownError{WSAEADDRNOTAVAIL, EADDRNOTAVAIL, "this computer does not have this address"},
    KnownError{WSAEMFILE, EMFILE, "Windows has no more sockets for this program"},
    KnownError{WSAENOBUFS, ENOBUFS, "Windows has no more memory for connections"},
};

const KnownError* known(DWORD error) {
  const auto found = std::ranges::find(kKnownErrors, error, &KnownError::error);
  return found == kKnownErrors.end() ? nullptr : &*found;
}

/// The last part of a path up to its extension, in capitals.
std::string device_part(const std::string& path) {
  std::string name = path.substr(path.find_last_of("/\\") + 1);
  name = name.substr(0, name.find_first_of(".:"));
  name.erase(name.find_last_not_of(' ') + 1);
  return stl::upper_case(name);
}

}  // namespace

std::wstring wide(std::string_view text) {
  if (text.empty()) return {};
  const int size = static_cast<int>(text.size());
  std::wstring result(static_cast<std::size_t>(MultiByteToWideChar(CP_UTF8, 0, text.data(), size, nullptr, 0)), L'\0');
  MultiByteToWideChar(CP_UTF8, 0, text.data(), size, result.data(), static_cast<int>(result.size()));
  return result;
}

std::string utf8(std::wstring_view text) {
  if (text.empty()) return {};
  const int size = static_cast<int>(text.size());
  const int needed = WideCharToMultiByte(CP_UTF8, 0, text.data(), size, nullptr, 0, nullptr, nullptr);
  std::string result(static_cast<std::size_t>(needed), '\0');
  WideCharToMultiByte(CP_UTF8, 0, text.data(), size, result.data(), needed, nullptr, nullptr);
  return result;
}

std::wstring native_path(const std::string& path) {
  constexpr std::size_t kShort = 240;  // below it the old limit holds, also for a folder and for what is put beside a file
  std::wstring native = wide(path);
  std::array<wchar_t, 32'768> whole{};
  const DWORD length = GetFullPathNameW(native.c_str(), whole.size(), whole.data(), nullptr);
  if (length < kShort || length >= whole.size() || native.starts_with(L"\\\\?\\") || native.starts_with(L"\\\\.\\"))
    return native;
  const std::wstring_view absolute(whole.data(), length);
  return absolute.starts_with(L"\\\\") ? L"\\\\?\\UNC" + std::wstring(absolute.substr(1))
                                       : L"\\\\?\\" + std::wstring(absolute);
}

bool is_device_name(const std::string& path) {
  constexpr std::array<std::string_view, 6> kAlone{"NUL", "CON", "PRN", "AUX", "CONIN$", "CONOUT$"};
  constexpr std::string_view kNumbers[] = {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "¹", "²", "³"};
  const std::string name = device_part(path);
  const bool numbered = (name.starts_with("COM") || name.starts_with("LPT")) &&
                        std::ranges::find(kNumbers, std::string_view(name).substr(3)) != std::end(kNumbers);
  return numbered || std::ranges::find(kAlone, name) != kAlone.end() || path.starts_with("\\\\.\\");
}

/// NUL.txt is a file on Windows 11, and NUL before it: who writes that means neither.
bool is_null_device(const std::string& path) {
  const std::string name = stl::upper_case(path.substr(path.find_last_of("/\\") + 1));
  return name == "NUL" || name == "NUL:";
}

int errno_of(DWORD error) {
  const KnownError* const row = known(error);
  return row ? row->as_errno : EIO;
}

std::string words_of(DWORD error) {
  if (const KnownError* const row = known(error)) return std::string(row->words);
  std::array<wchar_t, 512> text{};
  const DWORD length = FormatMessageW(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, nullptr, error, 0,
                                      text.data(), static_cast<DWORD>(text.size()), nullptr);
  std::string words = utf8({text.data(), length});
  words.erase(words.find_last_not_of(" .\r\n") + 1);
  return words.empty() ? fmt::format("error {} of Windows", error) : fmt::format("{} (error {} of Windows)", words, error);
}

}  // namespace s7200::tools
