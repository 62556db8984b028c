#include "tools/command/terminal/terminal.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "tools/host/console.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

Standard standard(std::FILE* stream) { return stream == stderr ? Standard::Error : Standard::Output; }

KeptMessages* kept = nullptr;

void print_message(std::string_view kind, std::string_view message) {
  if (kept) {
    kept->text += fmt::format("{}\n", stl::printable(message));
    return;
  }
  std::fflush(stdout);
  fmt::print(stderr, "s7200: {}: {}\n", kind, stl::printable(message));
}

}  // namespace

bool colour_wanted(std::FILE* stream) {
  if (kept && stream == stderr) return false;
  const char* no_color = std::getenv("NO_COLOR");
  return can_redraw(stream) && !(no_color && *no_color);
}

bool can_redraw(std::FILE* stream) { return knows_control_sequences(standard(stream)); }

std::size_t output_width() {
  const std::size_t columns = terminal_size().columns;
  return columns > 0 ? columns : stl::kUsualWidth;
}

void print_report(std::string_view text) { fmt::print("{}", stl::wrapped(text, output_width())); }

void print_file(std::string_view text) {
  fmt::print("{}", is_terminal(Standard::Output) ? stl::printable_lines(text) : std::string(text));
}

void print_error(std::string_view message) { print_message("error", message); }

void print_note(std::string_view message) { print_message("note", message); }

void print_message_lines(std::string_view lines) {
  if (kept)
    kept->text += lines;
  else
    fmt::print(stderr, "{}", lines);
}

KeptMessages::KeptMessages() { kept = this; }

KeptMessages::~KeptMessages() { kept = nullptr; }

void print_note_if_any(std::string_view message) {
  if (!message.empty()) print_note(message);
}

void print_notes(const std::vector<std::string>& messages) {
  for (const std::string& message : messages) print_note(message);
}

void print_interruption() {
  if (interrupted_by_signal()) print_note("interrupted");
}

}  // namespace s7200::tools
