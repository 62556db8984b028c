#include "tools/command/terminal/console.hpp"

#include <array>
#include <chrono>
#include <iostream>

#include "interpreter/base/text/text.hpp"
#include "tools/command/terminal/line_editor.hpp"
#include "tools/command/terminal/screen.hpp"
#include "tools/host/files/input_stream.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

constexpr int kLayoutRows = 15;
constexpr auto kRefreshEvery = std::chrono::milliseconds(100);  // while a run goes on

/// A line from the terminal; an empty one stands for `last`. Ctrl-C ends a run, and at the prompt the line being typed:
/// reading is not taken up again, and an empty prompt comes with nothing to repeat. Nothing at the end of the input, and
/// when something else than Ctrl-C ends the command.
std::optional<std::string> read_line(LineEditor& editor, std::string& last) {
  while (true) {
    forget_ctrl_c();
    if (interrupted()) return {};
    std::cout << std::flush;
    if (auto line = editor.read()) return line->empty() ? last : *line;
    std::cout << '\n';
    if (!interrupted()) return {};
    last.clear();
  }
}

/// A line that was typed while nobody reads one: the terminal hands over whole lines then. Nothing if there is none.
std::optional<std::string> typed_line() {
  constexpr std::size_t kLongest = 4096;  // of a line of a terminal
  std::array<char, kLongest> line{};
  const InputStream::Reading reading = standard_input().read(line, std::chrono::milliseconds(0));
  if (reading.came != InputStream::Came::Bytes) return {};
  const std::string_view typed(line.data(), reading.count);
  return std::string(typed.substr(0, typed.find_last_not_of("\r\n") + 1));
}

/// The layout: while it is wanted, it is shown whenever the terminal has room for it.
class LayoutScreen {
 public:
  explicit LayoutScreen(Prompt& debugger) : debugger_(debugger) {}

  Prompt::Error turn(bool on) {
    if (!on) screen_.switch_off();
    if (on && !screen_.on())
      if (const auto done = screen_.switch_on(); !done) return done.why();
    wanted_ = on;
    return {};
  }
  bool shown() const { return screen_.on(); }
  void draw() {
    if (shown()) screen_.draw(debugger_.view(screen_.view_rows()));
  }

  /// The terminal has another size, or the process has been stopped and goes on.
  void fit() {
    const bool was_shown = shown();
    if (!wanted_) return;
    const auto done = was_shown ? screen_.fit() : screen_.switch_on();
    if (done)
      draw();
    else if (was_shown)
      std::cout << done.why() << "; it comes back when there is room\n" << std::flush;
  }

 private:
  Prompt& debugger_;
  Screen screen_{{.name = "layout", .fewest_columns = 80, .fewest_rows = 24, .view = [](int, int) { return kLayoutRows; }}};
  bool wanted_ = false;
};

}  // namespace

void talk(Prompt& debugger) {
  LineEditor editor(Prompt::kText, "debug_history", [&debugger](std::string_view before) {
    auto [word, candidates] = debugger.completions(before);
    return Completions{word, std::move(candidates)};
  });
  LayoutScreen view(debugger);
  auto drawn = std::chrono::steady_clock::now();
  const auto refresh = [&] {
    const auto now = std::chrono::steady_clock::now();
    if (now - drawn < kRefreshEvery) return;
    drawn = now;
    if (editor.take_change())
      view.fit();
    else
      view.draw();
  };
  debugger.set_layout({.turn = [&view](bool on) { return view.turn(on); },
                       .shown = [&view] { return view.shown(); },
                       .refresh = refresh,
                       .typed = typed_line});
  editor.when_changed([&view] { view.fit(); });
  std::string last;
  while (!debugger.quit_asked()) {
    forget_ctrl_c();  // it has ended the run, and is not meant for the view after it
    view.draw();
    const auto line = read_line(editor, last);
    if (!line) break;
    if (const auto error = debugger.execute(*line)) std::cout << debugger.red(stl::printable(*error)) << '\n';
    last = debugger.repeatable();
  }
  debugger.set_layout({});
}

}  // namespace s7200::tools
