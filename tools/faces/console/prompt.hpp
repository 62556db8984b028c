// The prompt of `s7200 debug`: line in, text out. What the lines mean is in the table of commands.
#pragma once

#include <atomic>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/faces/console/view.hpp"
#include "tools/host/host_time.hpp"
#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/rows/completion.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools {

struct PromptSettings {
  SessionSetup session{};
  History::Settings history{};  ///< with the records, which watch the CPU too
  /// Ends a run that follows the clock when it becomes true, so that what was typed meanwhile can be carried out; null if
  /// nobody types.
  std::atomic<bool>* pause = nullptr;
  bool colour = false;  ///< what is forced, and errors, are shown in red, stops in bold, trouble of a trace in yellow
  /// Shows how far a long command has come, in place of what it showed before; "" takes that away. None: nothing is shown.
  std::function<void(std::string_view text)> progress{};
  Time patience = 2 * kSecond;  ///< of the host: how long a command runs before it is shown
};

struct ScriptError {
  std::size_t line = 0;
  std::string message;
};

class Prompt final : private Onlooker {
 public:
  static constexpr std::string_view kText = "(s7200) ";

  /// A message when a command is wrong: what was expected.
  using Error = std::optional<std::string>;

  /// The simulation has been powered up; `restart` goes back to how it is now. Of a system it is seen from each of its PLCs,
  /// in their order. All must live as long as this.
  Prompt(const std::vector<serial::Simulation*>& stations, std::ostream& out, const PromptSettings& settings);

  /// Runs a recording instead of what has run, and goes to a moment of it. False if it does not come to its end here.
  /// `failed`: memory that was not as expected there, which `why` is about as long as it stands there.
  bool open(Recording recording, const Moment& at, const std::vector<MemoryRange>& failed = {});

  /// Where it stands, and what is displayed.
  void show_place();

  /// One line: commands separated by `;`, a comment after `//`, or after `#` at its beginning. Ends with the first wrong
  /// one. After a stop request the rest is not done, which is said.
  Error execute(std::string_view line);

  /// Executes line by line, each command echoed after the prompt, to the first wrong one, to `quit`, to a stop request or
  /// the end. After a stop request it says how many commands were left: up to the end of the script if it is there as a
  /// whole, of a pipe up to the end of the line.
  std::optional<ScriptError> run_script(std::istream& in, bool is_whole = true);

  /// What the word that ends `line` may become: commands, addresses and symbols, places, files.
  Offers completions(std::string_view line) const { return tools::completions(session_, line); }

  /// Who shows view() steadily, and hears what is typed while a run goes on. Without it there is neither.
  struct Layout {
    std::function<Error(bool on)> turn{};  ///< switches it on or off, and returns why that cannot be
    std::function<bool()> shown{};
    std::function<void()> refresh{};  ///< called often while a run goes on
    /// A line that was typed while a run goes on; nothing if there is none. Asked often, while it follows the clock.
    std::function<std::optional<std::string>()> typed{};
  };
  void set_layout(Layout layout) { layout_ = std::move(layout); }

  /// What is kept in view: up to `rows` lines.
  std::vector<std::string> view(std::size_t rows) { return view_.lines(session_, rows); }

  /// As what is wrong is shown on a terminal that is to have colours.
  std::string red(std::string text) const { return emphasized(std::move(text), Emphasis::Trouble); }

  bool quit_asked() const { return session_.quit_asked; }

  /// Whether the last command was an 'expect' that did not hold: it was no wrong one.
  bool expectation_failed() const { return session_.expectation_failed; }

  /// Where it stands, things have happened after that.
  bool in_the_past() const { return history_.in_the_past(); }

  /// All that has run on the branch where it stands, to be run again.
  Recording recording() const { return history_.recording(); }

  /// The last line, if it makes sense to give it again: `step`, `over`, `continue` … Empty otherwise.
  const std::string& repeatable() const { return repeatable_; }

 private:
  void tell(std::string_view lines) override;
  std::string emphasized(std::string text, Emphasis how) const override;
  void run_begins(bool of_all) override;
  void run_ended() override;
  void executed(const InstructionRecord& record) override { view_.note(session_, record); }
  std::optional<bool> carry_out_asked() override;
  bool shows_memory() const override { return layout_.shown && layout_.shown(); }
  Error show_layout(bool on) override { return layout_.turn ? layout_.turn(on) : Onlooker::show_layout(on); }

  Error execute_line(std::string_view line);
  Error execute_one(std::string_view text);
  void report_undone();
  void show_progress();
  void hide_progress();

  std::ostream& out_;
  PromptSettings settings_;
  Layout layout_{};
  View view_{};
  History history_;
  Session session_;
  std::size_t undone_ = 0;  ///< commands, after a stop request
  bool echoing_ = false;    ///< commands are printed after the prompt
  std::string repeatable_;
  Time progress_at_ = kNever;  ///< of the host: when progress is shown next
  bool progress_shown_ = false;
  bool is_typed_to_ = false;            ///< a run goes on that follows the clock: what is typed is carried out
  std::optional<std::string> typed_{};  ///< a line that waits for that
};

}  // namespace s7200::tools
