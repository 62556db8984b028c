#include "tools/command/terminal/line_editor.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <utility>

#include "tools/host/files/input_stream.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {

/// The console of Windows edits the line itself, and keeps the lines of this session: arrow keys, F7.
struct LineEditor::Implementation {
  /// Nothing at the end of the input, or when an interruption was noted.
  std::optional<std::string> read_line() {
    fmt::print("{}", prompt);
    std::fflush(stdout);
    std::array<char, 4096> piece{};
    for (;;) {
      if (const std::size_t end = typed.find('\n'); end != std::string::npos) {
        std::string line = typed.substr(0, end);
        typed.erase(0, end + 1);
        if (line.ends_with('\r')) line.pop_back();
        return line;
      }
      if (interrupted()) return {};
      const InputStream::Reading reading = standard_input().read(piece, kLookEvery);
      typed.append(piece.data(), reading.count);
      if (reading.came == InputStream::Came::Failure || (reading.came == InputStream::Came::End && typed.empty())) return {};
      if (reading.came == InputStream::Came::End) return std::exchange(typed, {});
    }
  }

  static constexpr std::chrono::milliseconds kLookEvery{100};  // at interruptions
  std::string prompt;
  std::string typed{};  // and not yet taken as a line
};

LineEditor::LineEditor(std::string_view prompt, std::string_view, Complete)
    : editor_(new Implementation{.prompt = std::string(prompt)}) {}

LineEditor::~LineEditor() = default;

void LineEditor::when_changed(std::function<void()>) {}

bool LineEditor::take_change() { return false; }

std::optional<std::string> LineEditor::read() { return editor_->read_line(); }

std::optional<std::string> LineEditor::ask(std::string_view question) {
  const std::string prompt = std::exchange(editor_->prompt, std::string(question));
  auto answer = editor_->read_line();
  editor_->prompt = prompt;
  return answer;
}

}  // namespace s7200::tools
