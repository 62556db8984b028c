// A source text and the places in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace s7200::stl {

/// A place in a source text. Lines and columns count from 1, columns in characters (not bytes); 0 means no place.
struct Position {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 1;  ///< characters to underline

  bool operator==(const Position&) const = default;
};

/// A file after the first of a source that was read from several: its lines follow those of the file before it.
struct FurtherFile {
  std::uint32_t first_line = 0;
  std::string name;
};

/// A part of the text that messages name, and the line where it begins: `MAIN, network 3`. An empty name ends the part
/// before it.
struct Section {
  std::uint32_t first_line = 0;
  std::string name;
};

/// A text as it was read, for messages and listings.
struct SourceLines {
  std::string name;               ///< for messages: the path, or a name in its place
  std::vector<std::string> text;  ///< UTF-8, without line ends; of all files, one after the other
  std::vector<FurtherFile> further_files{};
  std::vector<Section> sections{};  ///< by line; a listing without blocks has none
};

/// A line of a file, by its number there.
struct FileLine {
  const std::string& file;
  std::uint32_t line = 0;
};

FileLine in_file(const SourceLines& source, std::uint32_t line);

/// The name of a line: `line 7`, or `symbols.txt:7` if the line `from` is in another file.
std::string line_text(const SourceLines& source, std::uint32_t line, std::uint32_t from);

/// The section that a line is in; empty if it is in none.
std::string section_at(const SourceLines& source, std::uint32_t line);

}  // namespace s7200::stl
