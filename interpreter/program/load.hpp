// From a file to a checked program: whatever the file is, an STL file or a published document.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/program/checker.hpp"

namespace s7200 {

/// The bytes of a file, or of a pipe up to its end; nothing, and `why`, when it cannot be read, has more than 64 MB or is a
/// device: a serial port named where a program is wanted is an error at once.
std::optional<std::string> read_file(const std::string& path, std::string& why);

/// Whether a path stands for standard input: "-", and the names that Linux has for it. What comes through a pipe can be read
/// once only.
bool is_standard_input(std::string_view path);

/// The bytes of standard input, up to its end and with the same limit.
std::optional<std::string> read_standard_input(std::string& why);

/// STL source of a text in any of the encodings of stl/encoding.hpp; `as_document`: whether it was read as one.
/// Nothing, and `why`, when the bytes are no text at all.
struct SourceText {
  stl::ParseResult parsed;
  std::string encoding;
  bool as_document = false;
};
std::optional<SourceText> read_source(std::string_view bytes, const std::string& name, std::string& why,
                                      bool force_document = false);

/// Reads and checks a program text that is at hand.
CheckResult check_text(std::string_view utf8, const std::string& name, const CpuModel& model, const TimeTable& times);

}  // namespace s7200
