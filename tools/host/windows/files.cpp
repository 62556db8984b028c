#include "tools/host/files/files.hpp"

#include <fmt/format.h>

#include <array>

#include "tools/host/files/file_system.hpp"
#include "tools/host/files/input_stream.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/windows/native_text.hpp"

namespace s7200::tools {
namespace {

/// Larger than any program; a pipe may never end.
constexpr std::size_t kLargestFile = 64 << 20;
constexpr std::chrono::milliseconds kLookAgain{100};

/// False, and `why`, if they are too many.
bool add(std::string& bytes, std::string_view piece, std::string& why) {
  bytes.append(piece);
  if (bytes.size() <= kLargestFile) return true;
  why = fmt::format("it is larger than {} MB", kLargestFile >> 20);
  return false;
}

class HostFiles final : public FileSource {
 public:
  std::optional<std::string> read(const std::string& path, std::string& why) const override { return read_file(path, why); }
  bool exists(const std::string& path) const override {
    return GetFileAttributesW(native_path(path).c_str()) != INVALID_FILE_ATTRIBUTES;
  }
};

}  // namespace

std::optional<std::string> read_file(const std::string& path, std::string& why) {
  using Kind = file_system::Found::Kind;
  const auto found = file_system::look_behind(path);
  if (is_device_name(path)) return why = "it is the name of a device of Windows, not a file", std::nullopt;
  if (found && found->kind == Kind::Folder) return why = "it is a folder", std::nullopt;
  const Handle file(CreateFileW(native_path(path).c_str(), GENERIC_READ,
                                FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr, OPEN_EXISTING,
                                FILE_FLAG_SEQUENTIAL_SCAN, nullptr));
  if (!file) return why = words_of(GetLastError()), std::nullopt;
  std::string bytes;
  for (std::array<char, 65536> piece{};;) {
    DWORD count = 0;
    const bool read = ReadFile(file.get(), piece.data(), static_cast<DWORD>(piece.size()), &count, nullptr) != 0;
    const DWORD error = read ? 0 : GetLastError();
    if (error != 0 && error != ERROR_BROKEN_PIPE) return why = words_of(error), std::nullopt;
    if (count == 0) return bytes;
    if (!add(bytes, {piece.data(), count}, why)) return {};
  }
}

std::optional<std::string> read_text(const std::string& path, std::string& why) { return host_files().read_text(path, why); }

std::optional<std::string> read_standard_input(std::string& why) {
  std::string bytes;
  for (std::array<char, 65536> piece{};;) {
    const InputStream::Reading reading = standard_input().read(piece, kLookAgain);
    if (reading.came == InputStream::Came::End) return bytes;
    if (reading.came == InputStream::Came::Failure) return why = reading.why, std::nullopt;
    if (reading.came == InputStream::Came::Nothing && interrupted()) return why = "interrupted", std::nullopt;
    if (!add(bytes, {piece.data(), reading.count}, why)) return {};
  }
}

const FileSource& host_files() {
  static const HostFiles kFiles;
  return kFiles;
}

}  // namespace s7200::tools
