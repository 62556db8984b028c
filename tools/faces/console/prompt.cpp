#include "tools/faces/console/prompt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <istream>
#include <ostream>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/rows/command_table.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

History::Settings settings_of(const PromptSettings& settings, std::function<void()> progress) {
  History::Settings history = settings.history;
  history.stop_request = settings.session.stop_request;
  history.progress = std::move(progress);
  return history;
}

std::string_view escape_of(Emphasis how) {
  switch (how) {
    case Emphasis::Trouble:
      return "\x1b[31m";
    case Emphasis::Warning:
      return "\x1b[33m";
    case Emphasis::Place:
      return "\x1b[1m";
  }
  return {};
}

/// Ends what escape_of() begins.
constexpr std::string_view kPlain = "\x1b[0m";

}  // namespace

Prompt::Prompt(const std::vector<serial::Simulation*>& stations, std::ostream& out, const PromptSettings& settings)
    : out_(out),
      settings_(settings),
      history_(stations, settings_of(settings_, [this] { show_progress(); })),
      session_(history_, settings_.session, *this) {
  session_.setup.colour = settings_.colour;
  session_.setup.bound = settings_.history.bound;
  session_.stepper.pause_when(settings_.pause);
}

bool Prompt::open(Recording recording, const Moment& at, const std::vector<MemoryRange>& failed) {
  if (!history_.replay(std::move(recording))) return false;
  history_.go_to(at);
  session_.failed = {session_.focus(), history_.now(), failed};
  return true;
}

void Prompt::show_place() {
  tools::show_place(session_);
  out_ << session_.take_said();
}

Prompt::Error Prompt::execute(std::string_view line) {
  undone_ = 0;
  Error error = execute_line(line);
  report_undone();
  return error;
}

/// Up to the first wrong command, to `quit` or to a stop request: what comes after that one is not done.
Prompt::Error Prompt::execute_line(std::string_view line) {
  const std::vector<std::string> commands = commands_in(line);
  repeatable_.clear();
  for (std::size_t i = 0; i < commands.size() && !quit_asked(); ++i) {
    if (Error error = execute_one(commands[i])) return error;
    if (!session_.stop_requested()) continue;
    undone_ += commands.size() - i - 1;
    return {};
  }
  return {};
}

/// After a stop request.
void Prompt::report_undone() {
  if (undone_ != 0) out_ << fmt::format("not done any more: {}\n", counted(undone_, "command"));
}

Prompt::Error Prompt::execute_one(std::string_view text) {
  const Words words = command_words(text);
  if (echoing_) out_ << kText << stl::printable(joined(words)) << '\n';
  if (settings_.progress) progress_at_ = host_time() + settings_.patience;
  const Reply reply = tools::execute(session_, words);
  hide_progress();
  out_ << reply.text;
  const auto command = find_command(words.front());
  repeatable_ = command && command->repeats ? session_.command : "";
  if (typed_) carry_out_asked();  // the run has ended meanwhile
  return reply.error;
}

std::optional<ScriptError> Prompt::run_script(std::istream& in, bool is_whole) {
  std::size_t number = 0;
  echoing_ = true;
  undone_ = 0;
  std::optional<ScriptError> wrong;
  std::string line;
  while (!wrong && !quit_asked() && !session_.stop_requested() && std::getline(in, line)) {
    ++number;
    if (Error error = execute_line(line)) wrong = ScriptError{number, *error};
  }
  echoing_ = false;
  if (wrong || quit_asked() || !session_.stop_requested()) return wrong;
  while (is_whole && std::getline(in, line)) undone_ += commands_in(line).size();
  report_undone();
  return {};
}

// --- while a command goes on ---

void Prompt::tell(std::string_view lines) {
  hide_progress();
  out_ << lines;
}

std::string Prompt::emphasized(std::string text, Emphasis how) const {
  if (text.empty() || !settings_.colour) return text;
  return fmt::format("{}{}{}", escape_of(how), text, kPlain);
}

void Prompt::run_begins(bool of_all) {
  view_.run_ended();
  if (shows_memory()) view_.run_begins(session_);
  is_typed_to_ = of_all && settings_.pause && layout_.typed && settings_.history.drive;
}

void Prompt::run_ended() {
  is_typed_to_ = false;
  view_.run_ended();
}

/// What was typed. The run does not go on after a command that has moved it.
std::optional<bool> Prompt::carry_out_asked() {
  if (!typed_) return {};
  const std::string line = std::exchange(typed_, {}).value();
  *settings_.pause = false;
  tell(session_.take_said());
  const History::Place place = history_.here();
  const std::string command = session_.command, repeatable = repeatable_;
  if (const Error error = execute_line(line)) out_ << red(stl::printable(*error)) << '\n';
  out_.flush();
  session_.command = command;
  repeatable_ = repeatable;
  const History::Place here = history_.here();
  return !quit_asked() && here.branch == place.branch && here.moment.instructions == place.moment.instructions &&
         here.moment.time == place.moment.time;
}

/// Once a second; the view, which shows it too, while a run goes on.
void Prompt::show_progress() {
  if (is_typed_to_ && !typed_ && (typed_ = layout_.typed())) *settings_.pause = true;
  if (view_.is_live() && layout_.refresh) layout_.refresh();
  if (host_time() < progress_at_ || shows_memory()) return;
  progress_at_ = host_time() + std::min(settings_.patience, kSecond);
  progress_shown_ = true;
  out_.flush();
  settings_.progress(fmt::format("at {}; Ctrl-C ends it", moment_text(session_.simulation().time())));
}

/// Something else is to be printed.
void Prompt::hide_progress() {
  if (std::exchange(progress_shown_, false)) settings_.progress("");
}

}  // namespace s7200::tools
