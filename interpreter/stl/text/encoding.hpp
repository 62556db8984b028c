// Bytes to UTF-8. STL itself is ASCII; encodings matter for comments and for the drawings of documents.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/file_source.hpp"
#include "interpreter/base/result.hpp"

namespace s7200::stl {

struct DecodedText {
  std::string text;  ///< valid UTF-8, without a byte order mark
  std::string
      encoding;  ///< what it was taken for: "UTF-8", "UTF-16", "Windows-1250" to "-1254", "CP437", "GBK", "Shift-JIS"
};

/// Guesses the encoding of a source file and converts it. Trouble, with what it looks like, for a file that is not text
/// (NUL bytes, a picture, an archive).
Result<DecodedText> decode(std::string_view bytes);

/// The text of a file, decoded; spreadsheets write tables in the code page of their Windows. Nothing as decode() and read().
Result<std::string> read_decoded(const FileSource& files, const std::string& path);

/// The text in one of the encodings that decode() names. Trouble if the text has a character that the
/// encoding lacks, or if there is no such encoding.
Result<std::string> encode(std::string_view utf8, std::string_view encoding);

}  // namespace s7200::stl
