#include "tools/host/process.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "tools/host/windows/native_text.hpp"

// After the types of Windows.
#include <shellapi.h>

namespace s7200::tools {
namespace {

/// A word as CommandLineToArgvW takes it apart again.
std::wstring quoted(const std::string& word) {
  std::wstring text = L"\"";
  std::size_t backslashes = 0;
  for (const wchar_t c : wide(word)) {
    if (c == L'"') text.append(backslashes + 1, L'\\');
    backslashes = c == L'\\' ? backslashes + 1 : 0;
    text += c;
  }
  return text.append(backslashes, L'\\') + L"\"";
}

/// Of each word of a command line, whether it has quotation marks, which CommandLineToArgvW takes away.
std::vector<bool> are_quoted(std::wstring_view line) {
  std::vector<bool> result;
  bool in_word = false, in_quotes = false;
  std::size_t backslashes = 0;
  for (const wchar_t c : line) {
    const bool is_mark = c == L'"' && backslashes % 2 == 0;
    backslashes = c == L'\\' ? backslashes + 1 : 0;
    if (is_mark) in_quotes = !in_quotes;
    const bool was_in_word = std::exchange(in_word, in_quotes || is_mark || (c != L' ' && c != L'\t'));
    if (in_word && !was_in_word) result.push_back(false);
    if (is_mark) result.back() = true;
  }
  return result;
}

/// The files that a word such as *.awl stands for, in the order of their names; the word itself if there is none.
std::vector<std::string> files_meant(const std::string& word) {
  const std::string folder = word.substr(0, word.find_last_of("/\\:") + 1);
  const bool is_pattern = !word.starts_with('-') && word.find_first_of("*?", folder.size()) != std::string::npos;
  std::vector<std::string> files;
  WIN32_FIND_DATAW found{};
  const HANDLE search = is_pattern ? FindFirstFileW(native_path(word).c_str(), &found) : INVALID_HANDLE_VALUE;
  if (search == INVALID_HANDLE_VALUE) return {word};
  do
    if ((found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) == 0) files.push_back(folder + utf8(found.cFileName));
  while (FindNextFileW(search, &found) != 0);
  FindClose(search);
  if (files.empty()) files.push_back(word);
  std::ranges::sort(files);
  return files;
}

}  // namespace

/// The console of Windows leaves it to programs to look for the files that a pattern stands for; one in quotation marks stands
/// for itself, as in shells, unless a blank in its path needs them. The words that the runtime hands to main() are in the code page of the system, which lacks most
/// characters.
std::vector<std::string> words_of_command_line(int, char**) {
  int count = 0;
  LPWSTR* const words = CommandLineToArgvW(GetCommandLineW(), &count);
  const std::vector<bool> quoted = are_quoted(GetCommandLineW());
  std::vector<std::string> result;
  for (int i = 0; i < count; ++i) {
    std::string word = utf8(words[i]);
    const auto place = static_cast<std::size_t>(i);
    if (place < quoted.size() && quoted[place] && word.find(' ') == std::string::npos) {
      result.push_back(std::move(word));
    } else {
      for (std::string& file : files_meant(word)) result.push_back(std::move(file));
    }
  }
  LocalFree(words);
  return result;
}

std::string own_executable() {
  std::array<wchar_t, 32'768> path{};
  return utf8({path.data(), GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()))});
}

std::chrono::nanoseconds processor_time() {
  FILETIME created{}, ended{}, kernel{}, user{};
  GetProcessTimes(GetCurrentProcess(), &created, &ended, &kernel, &user);
  const auto hundreds_of_ns = [](const FILETIME& time) {
    return std::int64_t{time.dwHighDateTime} << 32 | std::int64_t{time.dwLowDateTime};
  };
  return std::chrono::nanoseconds(100 * (hundreds_of_ns(kernel) + hundreds_of_ns(user)));
}

struct StartedProcess::Handles {
  Handle out, process;
};

StartedProcess::StartedProcess(const std::vector<std::string>& words) : handles_(std::make_unique<Handles>()) {
  const auto check = [&words](BOOL done) {
    if (done == 0) throw std::runtime_error(words[0] + ": " + words_of(GetLastError()));
  };
  SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
  HANDLE read = nullptr, write = nullptr;
  check(CreatePipe(&read, &write, &inherited, 0));
  handles_->out = Handle(read);
  const Handle its_end(write);
  SetHandleInformation(read, HANDLE_FLAG_INHERIT, 0);
  std::wstring line;
  for (const std::string& word : words) line += quoted(word) + L' ';
  STARTUPINFOW start{};
  start.cb = sizeof start;
  start.dwFlags = STARTF_USESTDHANDLES;
  start.hStdInput = GetStdHandle(STD_INPUT_HANDLE);
  start.hStdOutput = write;
  start.hStdError = GetStdHandle(STD_ERROR_HANDLE);
  PROCESS_INFORMATION started{};
  check(CreateProcessW(wide(words[0]).c_str(), line.data(), nullptr, nullptr, TRUE, 0, nullptr, nullptr, &start, &started));
  CloseHandle(started.hThread);
  handles_->process = Handle(started.hProcess);
}

StartedProcess::~StartedProcess() {
  handles_->out = Handle();
  WaitForSingleObject(handles_->process.get(), INFINITE);
}

bool StartedProcess::wait_for_output() const {
  char first = 0;
  DWORD count = 0;
  return ReadFile(handles_->out.get(), &first, 1, &count, nullptr) != 0 && count > 0;
}

}  // namespace s7200::tools
