// From the bytes of a file to the source in it, whether they are an STL file or a published document.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/program/checking/checker.hpp"

namespace s7200 {

/// A source is one of these kinds of file.
enum class SourceKind : std::uint8_t { Listing, Document, Blocks, SymbolTable, DataBlock, StatusChart };

/// The source in a text in any of the encodings of stl/text/encoding.hpp.
struct SourceText {
  stl::ParseResult parsed;
  std::string encoding;
  SourceKind kind = SourceKind::Listing;

  bool as_document() const { return kind == SourceKind::Document; }
  /// Whether it is a program, or the beginning of one: a symbol table, a data block and an export without main program
  /// belong to one.
  bool is_program() const;
};

/// Trouble if the bytes are not text, or are some other text.
Result<SourceText> read_source(std::string_view bytes, const std::string& name, bool force_document = false);

/// The files of a project as one source, named after the first of them that is a program. There is at least one.
SourceText join_files(std::vector<SourceText> files);

/// The source in a program text in memory: a listing or a block export.
stl::ParseResult read_text(std::string_view utf8, const std::string& name);

}  // namespace s7200
