#include "tools/host/files/files.hpp"

#include <fmt/format.h>

#include <array>

#include "interpreter/base/result.hpp"
#include "tools/host/files/file_system.hpp"
#include "tools/host/files/input_stream.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/windows/native_text.hpp"

namespace s7200::tools {
namespace {

/// Larger than any program; a pipe may never end.
constexpr std::size_t kLargestFile = 64 << 20;
constexpr std::chrono::milliseconds kLookAgain{100};

/// Trouble if they are too many.
Result<> add(std::string& bytes, std::string_view piece) {
  bytes.append(piece);
  if (bytes.size() <= kLargestFile) return {};
  return trouble("it is larger than {} MB", kLargestFile >> 20);
}

class HostFiles final : public FileSource {
 public:
  Result<std::string> read(const std::string& path) const override { return read_file(path); }
  bool exists(const std::string& path) const override {
    return GetFileAttributesW(native_path(path).c_str()) != INVALID_FILE_ATTRIBUTES;
  }
};

}  // namespace

Result<std::string> read_file(const std::string& path) {
  using Kind = file_system::Found::Kind;
  const auto found = file_system::look_behind(path);
  if (is_device_name(path)) return Trouble{"it is the name of a device of Windows, not a file"};
  if (found && found->kind == Kind::Folder) return Trouble{"it is a folder"};
  const Handle file(CreateFileW(native_path(path).c_str(), GENERIC_READ,
                                FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr, OPEN_EXISTING,
                                FILE_FLAG_SEQUENTIAL_SCAN, nullptr));
  const bool is_pattern = path.find_first_of("*?") != std::string::npos;
  if (!file) return Trouble{is_pattern ? "no file fits this pattern, or quotation marks keep it from being one" : words_of(GetLastError())};
  std::string bytes;
  for (std::array<char, 65536> piece{};;) {
    DWORD count = 0;
    const bool read = ReadFile(file.get(), piece.data(), static_cast<DWORD>(piece.size()), &count, nullptr) != 0;
    const DWORD error = read ? 0 : GetLastError();
    if (error != 0 && error != ERROR_BROKEN_PIPE) return Trouble{words_of(error)};
    if (count == 0) return bytes;
    if (const auto done = add(bytes, {piece.data(), count}); !done) return done.trouble();
  }
}

Result<std::string> read_text(const std::string& path) { return host_files().read_text(path); }

Result<std::string> read_standard_input() {
  std::string bytes;
  for (std::array<char, 65536> piece{};;) {
    const InputStream::Reading reading = standard_input().read(piece, kLookAgain);
    if (reading.came == InputStream::Came::End) return bytes;
    if (reading.came == InputStream::Came::Failure) return Trouble{reading.why};
    if (reading.came == InputStream::Came::Nothing && interrupted()) return Trouble{"interrupted"};
    if (const auto done = add(bytes, {piece.data(), reading.count}); !done) return done.trouble();
  }
}

const FileSource& host_files() {
  static const HostFiles kFiles;
  return kFiles;
}

}  // namespace s7200::tools
