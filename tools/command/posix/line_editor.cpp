#include "tools/command/terminal/line_editor.hpp"

#include <fmt/format.h>
#include <histedit.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <clocale>
#include <cstdio>
#include <cwchar>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/command/posix/line_history.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

constexpr int kLookEvery = 100;  // ms, at signals
constexpr std::size_t kMostShown = 100;

std::atomic<bool> changed = false;

void note_change(int) { changed = true; }

/// What all candidates begin with, as the first of them writes it.
std::string common_beginning(const std::vector<std::string>& candidates) {
  std::string common = candidates.front();
  for (const std::string& candidate : candidates) {
    std::size_t same = 0;
    while (same < common.size() && same < candidate.size() &&
           stl::upper_case(common.substr(same, 1)) == stl::upper_case(candidate.substr(same, 1)))
      ++same;
    common.resize(same);
  }
  return common;
}

}  // namespace

struct LineEditor::Implementation {
  Implementation(std::string_view text, std::string_view history_file, Complete offers)
      : prompt(text), complete(std::move(offers)), kept(history_file) {
    std::setlocale(LC_CTYPE, "");
    edit = el_init_fd("s7200", stdin, stdout, stderr, STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO);
    lines = history_init();
    HistEvent event;
    ::history(lines, &event, H_SETSIZE, static_cast<int>(LineHistory::kMost));
    ::history(lines, &event, H_SETUNIQUE, 1);
    for (const std::string& line : kept.lines()) ::history(lines, &event, H_ENTER, line.c_str());
    el_set(edit, EL_CLIENTDATA, this);
    el_set(edit, EL_PROMPT, &prompt_of);
    el_set(edit, EL_EDITOR, "emacs");
    el_set(edit, EL_SIGNAL, 0);
    el_set(edit, EL_GETCFN, &read_character);
    el_set(edit, EL_HIST, ::history, lines);
    el_set(edit, EL_ADDFN, "complete-word", "complete the word", &complete_word);
    el_set(edit, EL_BIND, "^I", "complete-word", nullptr);
    el_set(edit, EL_BIND, "^R", "em-inc-search-prev", nullptr);
    struct sigaction action {};
    action.sa_handler = note_change;
    sigaction(SIGWINCH, &action, &before_resize);
    sigaction(SIGCONT, &action, &before_continue);
  }
  ~Implementation() {
    sigaction(SIGWINCH, &before_resize, nullptr);
    sigaction(SIGCONT, &before_continue, nullptr);
    history_end(lines);
    el_end(edit);
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  static Implementation& of(EditLine* edit) {
    void* self = nullptr;
    el_get(edit, EL_CLIENTDATA, &self);
    return *static_cast<Implementation*>(self);
  }

  static char* prompt_of(EditLine* edit) { return of(edit).prompt.data(); }

  /// 1, 0 at the end of the input, -1 when a signal was noted.
  static int read_byte(EditLine* edit, char& byte) {
    for (;;) {
      if (interrupted()) return -1;
      if (changed.exchange(false)) of(edit).look_again();
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (poll(&input, 1, kLookEvery) <= 0) continue;
      const ssize_t got = ::read(STDIN_FILENO, &byte, 1);
      if (got >= 0) return static_cast<int>(got);
      if (errno != EINTR && errno != EAGAIN) return -1;
    }
  }

  /// Where the line being edited could not be seen. Nothing at the end of the input, and when a signal was noted.
  std::optional<std::string> read_unedited() {
    fmt::print("{}", prompt);
    std::fflush(stdout);
    std::string line;
    for (;;) {
      char byte = 0;
      const int got = read_byte(edit, byte);
      if (got < 0 || (got == 0 && line.empty())) return {};
      if (got == 0 || byte == '\n') return line;
      line += byte;
    }
  }

  std::optional<std::string> read_line() {
    if (isatty(STDOUT_FILENO) == 0) return read_unedited();
    std::fflush(stdout);
    el_set(edit, EL_PREP_TERM, 1);  // before the prompt is there: keys that follow it at once are not lost
    int count = 0;
    const char* typed = el_gets(edit, &count);
    if (!typed || count <= 0) return {};
    std::string line(typed, static_cast<std::size_t>(count));
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
    return line;
  }

  static int read_character(EditLine* edit, wchar_t* character) {
    std::mbstate_t state{};
    for (;;) {
      char byte = 0;
      if (const int got = read_byte(edit, byte); got <= 0) return got;
      const std::size_t used = std::mbrtowc(character, &byte, 1, &state);
      if (used == static_cast<std::size_t>(-2)) continue;
      if (used == static_cast<std::size_t>(-1)) *character = L'?';
      if (used == 0) *character = L'\0';
      return 1;
    }
  }

  static unsigned char complete_word(EditLine* edit, int) {
    const LineInfo* line = el_line(edit);
    const std::string_view before(line->buffer, static_cast<std::size_t>(line->cursor - line->buffer));
    const Completions found = of(edit).complete(before);
    if (found.candidates.empty()) return CC_ERROR;
    const std::string common = common_beginning(found.candidates);
    const bool only = found.candidates.size() == 1;
    const bool goes_on = common.ends_with('/') || common.ends_with(':');
    if (common.size() > found.word || only) {
      el_deletestr(edit, static_cast<int>(found.word));
      el_insertstr(edit, (common + (only && !goes_on ? " " : "")).c_str());
      return CC_REFRESH;
    }
    of(edit).show(found.candidates);
    return CC_REDISPLAY;
  }

  void look_again() {
    el_set(edit, EL_PREP_TERM, 1);
    el_resize(edit);
    fmt::print("{}", can_redraw(stdout) ? "\r\x1b[J" : "\r");  // the line is written anew, from its beginning
    std::fflush(stdout);
    if (when_changed) when_changed();
    el_set(edit, EL_REFRESH);
  }

  void show(const std::vector<std::string>& candidates) const {
    std::string text = "\n";
    for (std::size_t i = 0; i < std::min(candidates.size(), kMostShown); ++i)
      text += stl::printable(candidates[i]) + (i + 1 < candidates.size() ? "  " : "");
    if (candidates.size() > kMostShown) text += fmt::format("… {} in all", candidates.size());
    fmt::print("{}\n", text);
    std::fflush(stdout);
  }

  std::string prompt;
  Complete complete;
  LineHistory kept;
  EditLine* edit = nullptr;
  ::History* lines = nullptr;
  std::function<void()> when_changed{};
  struct sigaction before_resize {
  }, before_continue{};
};

LineEditor::LineEditor(std::string_view prompt, std::string_view history, Complete complete)
    : editor_(std::make_unique<Implementation>(prompt, history, std::move(complete))) {}

LineEditor::~LineEditor() = default;

void LineEditor::when_changed(std::function<void()> told) { editor_->when_changed = std::move(told); }

bool LineEditor::take_change() {
  const bool now = changed.exchange(false);
  if (now) el_resize(editor_->edit);
  return now;
}

std::optional<std::string> LineEditor::read() {
  auto line = editor_->read_line();
  if (!line || line->find_first_not_of(" \t") == std::string::npos) return line;
  HistEvent event;
  ::history(editor_->lines, &event, H_ENTER, line->c_str());
  editor_->kept.add(*line);
  return line;
}

std::optional<std::string> LineEditor::ask(std::string_view question) {
  const std::string prompt = std::exchange(editor_->prompt, std::string(question));
  auto answer = editor_->read_line();
  editor_->prompt = prompt;
  return answer;
}

}  // namespace s7200::tools
