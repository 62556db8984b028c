// Letters that look like other characters: O and l in place of the digits 0 and 1, Cyrillic and Greek letters in place of
// Latin ones.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace s7200::stl {

/// The cause of all diagnostics about such letters.
inline constexpr const char* kLookAlikes = "letters that look like others";

/// A word with a letter that looks like what was meant.
struct LookAlike {
  std::string wrong;  ///< what is in the word: "the letter O in place of the digit 0"
  std::string meant;  ///< the word without it
};

/// The address or constant that a mistaken word becomes: `VB1OO`, `IO.0`, `16#O9`, `VВ100` with a Cyrillic В. Nothing for
/// any other word, and for one that is right as it is.
std::optional<LookAlike> look_alike_operand(std::string_view word);

/// The number that a mistaken word becomes: `l`, `1O`.
std::optional<LookAlike> look_alike_number(std::string_view word);

/// The word of ASCII letters and digits that a mistaken mnemonic becomes: `АN` with a Cyrillic А.
std::optional<LookAlike> look_alike_mnemonic(std::string_view word);

/// The STL constant for `0x10`, `10h`, `&H10`, `$10`, `0b101` and `#5`; empty for anything else.
std::string constant_here(std::string_view word);

}  // namespace s7200::stl
