// The words of a line, of which some are bytes.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"

namespace s7200::tools {

using Words = std::span<const Word>;

inline bool is_letter(char c) { return stl::is_letter(c); }

inline bool is_decimal(std::string_view text) { return !text.empty() && std::ranges::all_of(text, stl::is_digit); }

inline bool is_marked(std::string_view text) { return text.starts_with("0x") || text.starts_with("0X"); }

inline bool is_word_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The place of the first blank, or of the first other sign, from `at` on; the length of the line if there is none.
inline std::size_t end_of_word(std::string_view line, std::size_t at) {
  while (at < line.size() && !is_word_blank(line[at])) ++at;
  return at;
}

inline std::size_t begin_of_word(std::string_view line, std::size_t at) {
  while (at < line.size() && is_word_blank(line[at])) ++at;
  return at;
}

/// Whether `c` is a letter, or part of a letter that is not ASCII.
inline bool is_letter_of_any_language(char c) { return is_letter(c) || (c & 0x80) != 0; }

/// Appends the bytes of `01`, `0103`, `0x1`, `01-03`, `[01][03]`, `0x01,`. Returns false and appends nothing for anything
/// else; a date is not a byte, nor is an identifier.
bool append_bytes(Bytes& bytes, std::string_view word);

/// A comment stands after `;`, `//` or `#` after a blank, or after a `;` that closes the bytes. Where `;` divides the
/// bytes, there is one after the first.
std::string_view without_comment(std::string_view line);

/// Whether a word is of a language, not hex: `feed` and `added` after pairs of digits.
bool is_of_a_language(std::string_view word);

/// The length of a name before bytes: `Tx:01` is `01` after its name; `data=01` has one, `len=09` and `plc:5020` have none.
std::size_t length_of_name(std::string_view word);

/// Marks numbers that are not bytes, by the words beside them: `length 12`, `12 bytes`, `18 (0X12)`. A number with bytes
/// after it may be the first of them.
void take_numbers_out(std::vector<Word>& words);

/// The last run of bytes among words.
struct RunOfBytes {
  Words before, words;
};

/// Another reading of the bytes if all of them are not a right frame: without the number that counts them, `8 01 03 …`, or
/// without the word that begins the comment, `… be careful`.
struct OtherRun {
  Words words{};
  std::string_view without{};
};

bool names_a_direction(const Word& word);

/// Whether a word is `tx`, `rx_data`, `COM3:`; a name with a number at its end is that of a line.
bool names_bytes(const Word& word);

/// Whether numbers after a name of values, or of a modem's answer, `+CSQ: 18,99`, are fewer than a frame has.
bool are_values(Words before, Words run);

/// A word before or after the bytes that makes them doubtful; null if there is none. Bytes before them may be a number or a
/// date in front of the direction.
const Word* what_is_doubtful(Words before, Words run, Words after);

/// The runs of words that may be all the bytes of a doubtful line, the likelier first. There are none if a byte may be
/// damaged, or if the line has several runs of bytes.
std::vector<Words> possible_runs(Words words);

std::optional<OtherRun> other_run(Words run, Words after);

/// The text between the bars of hexdump -C, `|....4...|`, and the signs of od, `>....4...<`.
std::string_view without_bars(std::string_view text);

/// The text with one sign for each character that is not ASCII, whatever its length in UTF-8.
std::string in_single_bytes(std::string_view text);

/// Whether bytes are the value of something in a log of other things: `counter = 12345678`, `temp: 21`, `error code 0x86`,
/// `sensor.temp 2024-01-01T10:00:00 21`
bool is_value(Words before, Words run);

/// Whether the bytes are a number at the end of words, or one of the words: `slave 10`, `waiting for 50`, `warte ab`, `de
/// facto`, or blocks among words: `CALL FB 10, DB 11`
bool is_of_a_sentence(Words before, Words run, Words after);

/// Whether there are at least two pairs of digits: `01 03 …`
bool has_pairs(Words words);

/// Digits at the end of a line that are not pairs: `RX 0103041234567`, `RX 001 003`
std::optional<BytesInLine> cut_off_bytes(Words words);

std::optional<RunOfBytes> last_run(Words words);

}  // namespace s7200::tools
