#include "tools/host/files/input_stream.hpp"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "tools/host/windows/native_text.hpp"

namespace s7200::tools {
namespace {

/// Windows cannot wait for a pipe with a time limit: a thread reads, and whoever wants the bytes waits for that. Nothing
/// ends its reading but the end of the process, which does not ask it.
class StandardInput final : public InputStream {
 public:
  StandardInput() : handle_(GetStdHandle(STD_INPUT_HANDLE)) {
    std::thread([this] { read_all(); }).detach();
  }

  Reading read(std::span<char> into, std::chrono::milliseconds at_most) override {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, at_most, [this] { return !bytes_.empty() || over_; });
    if (bytes_.empty()) return over_ ? end_ : Reading{};
    const std::size_t count = std::min(into.size(), bytes_.size());
    std::copy_n(bytes_.begin(), count, into.begin());
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(count));
    news_.notify_all();
    return {.came = Came::Bytes, .count = count};
  }

 private:
  static constexpr std::size_t kMostUnread = 1 << 20;

  void read_all() {
    DWORD mode = 0;
    const bool console = GetConsoleMode(handle_, &mode) != 0;
    while (console ? read_console() : read_bytes()) continue;
  }

  /// False at the end.
  bool read_bytes() {
    std::array<char, 65536> piece{};
    DWORD count = 0;
    if (ReadFile(handle_, piece.data(), static_cast<DWORD>(piece.size()), &count, nullptr) == 0) {
      const DWORD error = GetLastError();
      const bool ended = error == ERROR_BROKEN_PIPE || error == ERROR_HANDLE_EOF;
      return end(ended ? Reading{.came = Came::End} : Reading{.came = Came::Failure, .why = words_of(error)});
    }
    return count == 0 ? end({.came = Came::End}) : add({piece.data(), count});
  }

  /// A line that was typed; Ctrl-Z at its beginning is the end. Ctrl-C comes as no characters with an error.
  bool read_console() {
    constexpr wchar_t kCtrlZ = 26;
    std::array<wchar_t, 4096> line{};
    DWORD count = 0;
    SetLastError(0);
    if (ReadConsoleW(handle_, line.data(), static_cast<DWORD>(line.size()), &count, nullptr) == 0)
      return GetLastError() == ERROR_OPERATION_ABORTED || end({.came = Came::End});
    if (count > 0 && line[0] == kCtrlZ) return end({.came = Came::End});
    return count == 0 || add(utf8({line.data(), count}));
  }

  bool add(std::string_view bytes) {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [this] { return bytes_.size() < kMostUnread; });
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    news_.notify_all();
    return true;
  }

  bool end(Reading how) {
    const std::lock_guard lock(mutex_);
    over_ = true;
    end_ = std::move(how);
    news_.notify_all();
    return false;
  }

  HANDLE handle_;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable news_;
  std::deque<char> bytes_;
  bool over_ = false;
  Reading end_{};
};

}  // namespace

InputStream& standard_input() {
  static auto* const kInput = new StandardInput;  // its thread may outlive everything
  return *kInput;
}

}  // namespace s7200::tools
