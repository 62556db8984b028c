// The notations in which tools write characters, one in a cell.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/result.hpp"

namespace s7200::tools {

/// A way to write the characters of a column: `0x12`, `18`, `'18' (0x12)`. The same cell may be a character in one and a
/// number in another, so that the whole column has to say which it is.
struct Notation {
  std::string_view name;  ///< `decimal`
  std::optional<Bytes> (*read)(std::string_view cell);
};

/// A cell without what a logic analyser adds to a character that was damaged: `0x01 (framing error)`.
struct WrittenCharacter {
  std::string_view cell;
  bool damaged = false;
};
WrittenCharacter without_error(std::string_view cell);

/// The bytes of an escaped text, which stands between quotation marks: `\1\3`, `\x01\r`, `abc\"`. Nothing if an escape in it
/// is unknown.
std::optional<Bytes> bytes_of_literal(std::string_view text);

/// The characters of a text as bytes, if none is beyond U+00FF; nothing otherwise.
std::optional<Bytes> in_latin_1(std::string_view text);

/// Base64 with the signs of either alphabet of RFC 4648; the signs that fill its end may be missing. Nothing if it is none,
/// or has no bytes.
std::optional<Bytes> bytes_of_base64(std::string text);

/// Finds the notation of a column: the first that reads all of its cells.
class NotationFinder {
 public:
  NotationFinder();

  /// A cell that is not empty. `line`: its number, for the message.
  void take(std::string_view cell, std::size_t line);

  /// The notation found. Trouble, `line 3: '256' is not bytes in decimal`, if no notation reads all
  /// cells, or several do.
  Result<const Notation&> found() const;

  /// The notation that reads all cells as well as decimal numbers do; null if there is none.
  const Notation* other(const Notation& found) const;

  /// Whether each cell is one character, in that notation.
  bool are_characters(const Notation& notation) const;

 private:
  struct Candidate {
    const Notation* notation;
    std::size_t read = 0;    ///< cells before the first that it does not read
    bool characters = true;  ///< each of them is one
    std::string wrong{};     ///< text of that cell
    std::size_t line = 0;
  };

  std::vector<Candidate> candidates_;
  std::size_t cells_ = 0;
  std::string first_{};
  std::size_t first_line_ = 0;
  bool only_digits_ = true;  ///< each cell so far is a single digit
};

}  // namespace s7200::tools
