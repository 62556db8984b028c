// Tables of execution times as text: what is read, what is refused, and which lines of several tables are in use.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/model/times/times.hpp"

namespace s7200 {

/// The longest figure: the watchdog ends a scan after 300 ms. The time of an instruction with all that its operands add, and
/// that of a chain of contacts, then fit into the 32 bits that an Op has for them.
inline constexpr Time kLongestFigure = 100 * kMillisecond;

/// The contents of a text, each line of the table with its number in the text.
struct TimesFile {
  struct Line {
    std::size_t number = 0;
    TimeRow row{};
  };
  std::vector<Line> lines{};
  std::string cpu{};         ///< whose times they are, `224`; empty if the text does not say
  std::size_t cpu_line = 0;  ///< where it says so
};

/// Adds to `errors` what is wrong, each `name:line: what`.
TimesFile read_times(std::string_view csv, const std::string& name, std::vector<std::string>& errors);

/// The lines that give no time because earlier ones do, each as `name:line: what`.
std::vector<std::string> hidden_lines(const TimesFile& file, const std::string& name);

/// The line that names the CPU of the times after it.
std::string cpu_line(std::string_view cpu);

/// A line of a table that is for people; empty for an empty text.
std::string comment_line(std::string_view text);

/// The table without the lines, and the mnemonics of lines, that never give a time because earlier lines do.
TimeTable in_use(const TimeTable& times);

/// The names of areas: `I Q M`
std::string names_of(Areas areas);

}  // namespace s7200
