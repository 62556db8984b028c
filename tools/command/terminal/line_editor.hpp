// A line from a terminal, edited with libedit: arrow keys, the lines of earlier sessions, completion with the tab key.
//
// Only for a terminal on standard input and output. Ctrl-C is noted as everywhere (host/interruption.hpp) and ends the line
// being typed; a terminal that changes its size is redrawn.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace s7200::tools {

/// What the word that ends at the cursor may become; each begins as it does, in whatever capitals.
struct Completions {
  std::size_t word = 0;  ///< its length
  std::vector<std::string> candidates{};
};

class LineEditor {
 public:
  using Complete = std::function<Completions(std::string_view before_cursor)>;

  /// `history`: the name of the file that keeps the lines.
  LineEditor(std::string_view prompt, std::string_view history, Complete complete);
  ~LineEditor();
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;

  /// Told when the terminal has another size, or the process was stopped and goes on.
  void when_changed(std::function<void()> told);

  /// The same while no line is read: whether it has happened since it was last told or asked.
  bool take_change();

  /// Nothing at the end of the input, or when a signal was noted.
  std::optional<std::string> read();

  /// The answer to a question, which is asked instead of the prompt; it is not kept.
  std::optional<std::string> ask(std::string_view question);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> editor_;
};

}  // namespace s7200::tools
