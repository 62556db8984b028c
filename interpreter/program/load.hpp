// From a file to a checked program, whether the file is an STL file or a published document.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/program/checker.hpp"

namespace s7200 {

/// The bytes of a file, or of a pipe up to its end. Returns nothing and sets `why` if it cannot be read, is larger than 64
/// MB or is a device: naming a serial port instead of a program is an immediate error.
std::optional<std::string> read_file(const std::string& path, std::string& why);

/// The same of a text in UTF-8, without the byte order mark that some editors put before it.
std::optional<std::string> read_text(const std::string& path, std::string& why);

/// Whether a path means standard input: "-" and its names in Linux. What comes through a pipe can be read only once.
bool is_standard_input(std::string_view path);

/// The bytes of standard input up to its end, with the same limit.
std::optional<std::string> read_standard_input(std::string& why);

/// What is in a file.
enum class SourceKind : std::uint8_t { Listing, Document, Blocks, SymbolTable, DataBlock, StatusChart };

/// The source in a text in any of the encodings of stl/encoding.hpp.
struct SourceText {
  stl::ParseResult parsed;
  std::string encoding;
  SourceKind kind = SourceKind::Listing;

  bool as_document() const { return kind == SourceKind::Document; }
  /// Whether it is a program, or the beginning of one: a symbol table, a data block and an export without main program
  /// belong to one.
  bool is_program() const;
};

/// Returns nothing and sets `why` if the bytes are not text, or are some other text.
std::optional<SourceText> read_source(std::string_view bytes, const std::string& name, std::string& why,
                                      bool force_document = false);

/// The files of a project as one source, named after the first of them that is a program. There is at least one.
SourceText join_files(std::vector<SourceText> files);

/// Reads and checks a program text in memory: a listing or a block export.
CheckResult check_text(std::string_view utf8, const std::string& name, const CpuModel& model, const TimeTable& times);

}  // namespace s7200
