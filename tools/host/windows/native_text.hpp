// Texts, paths and errors between us and Windows. Its headers are included here and nowhere else than in folders of this
// name: they have macros for common words.
#pragma once

#include <winsock2.h>
// After winsock2.h, in place of which it else includes the predecessor.
#include <windows.h>

#include <string>
#include <string_view>

namespace s7200::tools {

/// UTF-8 to UTF-16 and back; what is wrong in the one becomes U+FFFD in the other.
std::wstring wide(std::string_view text);
std::string utf8(std::wstring_view text);

/// A path as Windows takes it: one that is too long for its old limit of 260 characters is written out from \\?\ on.
std::wstring native_path(const std::string& path);

/// Whether the last part of a path is the name of a device in every folder: NUL, COM1, also with an extension, COM1.txt.
/// Source: Naming Files, Paths, and Namespaces.
bool is_device_name(const std::string& path);
bool is_null_device(const std::string& path);

/// The errno that is nearest to an error of Windows.
int errno_of(DWORD error);

/// An error of Windows in words.
std::string words_of(DWORD error);

/// A handle that is closed.
class Handle {
 public:
  Handle() = default;
  explicit Handle(HANDLE handle) : handle_(handle == INVALID_HANDLE_VALUE ? nullptr : handle) {}
  ~Handle() {
    if (handle_ != nullptr) CloseHandle(handle_);
  }
  Handle(Handle&& other) noexcept : handle_(other.release()) {}
  Handle& operator=(Handle&& other) noexcept {
    if (handle_ != nullptr) CloseHandle(handle_);
    handle_ = other.release();
    return *this;
  }
  explicit operator bool() const { return handle_ != nullptr; }
  HANDLE get() const { return handle_; }
  HANDLE release() {
    HANDLE const handle = handle_;
    handle_ = nullptr;
    return handle;
  }

 private:
  HANDLE handle_ = nullptr;
};

}  // namespace s7200::tools
