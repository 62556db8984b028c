#include "tools/command/console.hpp"

#include <chrono>
#include <iostream>

#include "interpreter/base/text.hpp"
#include "tools/command/line_editor.hpp"
#include "tools/command/screen.hpp"
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

Debugger::Error switch_layout(Screen& screen, bool on) {
  std::string why;
  if (!on) screen.switch_off();
  if (on && !screen.on() && !screen.switch_on(why)) return why;
  return {};
}

/// The terminal has another size, or the process has been stopped and goes on.
void fit(Screen& screen, Debugger& debugger) {
  std::string why;
  if (!screen.on()) return;
  if (screen.fit(why))
    screen.draw(debugger.view(screen.view_rows()));
  else
    std::cout << why << '\n' << std::flush;
}

}  // namespace

void talk(Debugger& debugger) {
  LineEditor editor(Debugger::kPrompt, "debug_history", [&debugger](std::string_view before) {
    auto [word, candidates] = debugger.completions(before);
    return Completions{word, std::move(candidates)};
  });
  Screen screen({.name = "layout", .fewest_columns = 80, .fewest_rows = 24, .view = [](int, int) { return kLayoutRows; }});
  auto drawn = std::chrono::steady_clock::now();
  const auto refresh = [&] {
    const auto now = std::chrono::steady_clock::now();
    if (now - drawn < kRefreshEvery) return;
    drawn = now;
    if (editor.take_change())
      fit(screen, debugger);
    else
      screen.draw(debugger.view(screen.view_rows()));
  };
  debugger.set_layout({.turn = [&screen](bool on) { return switch_layout(screen, on); },
                       .shown = [&screen] { return screen.on(); },
                       .refresh = refresh});
  editor.when_changed([&screen, &debugger] { fit(screen, debugger); });
  std::string last;
  while (!debugger.quit_asked()) {
    forget_ctrl_c();  // it has ended the run, and is not meant for the view after it
    if (screen.on()) screen.draw(debugger.view(screen.view_rows()));
    const auto line = read_line(editor, last);
    if (!line) break;
    if (const auto error = debugger.execute(*line)) std::cout << stl::printable(*error) << '\n';
    last = debugger.repeatable();
  }
  debugger.set_layout({});
}

}  // namespace s7200::tools
