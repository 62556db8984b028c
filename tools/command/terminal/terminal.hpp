// What goes to the person: messages on stderr, colour only where it is wanted.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace s7200::tools {

/// Colour on a terminal that knows control sequences, unless NO_COLOR is set to anything but nothing.
bool colour_wanted(std::FILE* stream);

/// Whether what is on the screen can be written over: a terminal that knows control sequences.
bool can_redraw(std::FILE* stream);

/// How many characters a line on stdout has room for: as many as its terminal, or stl::kUsualWidth where there is none.
std::size_t output_width();

/// A report on stdout, in lines that keep to output_width().
void print_report(std::string_view text);

/// What could be a file, on stdout: as it is, but printable on a terminal.
void print_file(std::string_view text);

/// `s7200: error: …` and `s7200: note: …` on stderr, in one line; what a message quotes is shown printable.
void print_error(std::string_view message);
void print_note(std::string_view message);

/// None for an empty text.
void print_note_if_any(std::string_view message);
void print_notes(const std::vector<std::string>& messages);

/// Lines on stderr that are messages as they are, such as diagnostics.
void print_message_lines(std::string_view lines);

/// As long as it lives, messages are kept in it instead of being printed: someone else is to be told.
class KeptMessages {
 public:
  KeptMessages();
  ~KeptMessages();
  KeptMessages(const KeptMessages&) = delete;
  KeptMessages& operator=(const KeptMessages&) = delete;

  /// A line each, without `s7200: error:`.
  std::string text;
};

/// `s7200: note: interrupted`, if a signal ended what was going on.
void print_interruption();

}  // namespace s7200::tools
