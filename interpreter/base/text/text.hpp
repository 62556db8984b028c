// Lines and characters of a UTF-8 text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace s7200::stl {

/// Replaces what could not be read in a text.
inline constexpr char32_t kReplacement = 0xFFFD;

struct Character {
  char32_t code = 0;
  std::size_t bytes = 0;
};

/// The first character of a text that is not empty. A byte that is not UTF-8 is a character of its own, kReplacement.
Character first_character(std::string_view text);

/// A character as UTF-8.
std::string to_utf8(char32_t code);

/// A view of the characters of a text: `for (const Character c : characters(text))`.
class CharacterIterator {
 public:
  explicit CharacterIterator(std::string_view rest) : rest_(rest) { read(); }
  Character operator*() const { return current_; }
  CharacterIterator& operator++() {
    rest_.remove_prefix(current_.bytes);
    read();
    return *this;
  }
  bool operator!=(const CharacterIterator& other) const { return rest_.size() != other.rest_.size(); }

 private:
  void read() {
    if (!rest_.empty()) current_ = first_character(rest_);
  }
  std::string_view rest_;
  Character current_;
};

struct Characters {
  std::string_view text;
  CharacterIterator begin() const { return CharacterIterator(text); }
  CharacterIterator end() const { return CharacterIterator(std::string_view{}); }
};

inline Characters characters(std::string_view text) { return {text}; }

bool is_ascii(std::string_view text);

std::size_t count_characters(std::string_view text);

/// `count` characters of a text from the character number `first` on, which counts from 1.
std::string characters_at(std::string_view text, std::size_t first, std::size_t count);

bool is_valid_utf8(std::string_view text);

/// Takes the first line off a text, and returns it without its end: CR LF, LF or CR.
std::string_view take_line(std::string_view& text);

/// All lines of a text, without their ends.
std::vector<std::string> split_lines(std::string_view text);

/// The text without the mark by which some editors say that it is UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

/// The text without blanks and tabs at its end.
std::string_view trim_end(std::string_view text);

/// The text without blanks, tabs and carriage returns at both ends.
std::string_view trim(std::string_view text);

/// At most 40 characters of a text, for a message; a text that is cut ends with `...`.
std::string shortened(std::string_view text);

/// A text from a file, or a file name, made safe for a terminal. Characters that a terminal would take for a command
/// (control characters except the tab), characters that change the direction of the text, line ends, and bytes that are not
/// UTF-8 become U+FFFD, each one column wide. All such text is printed through this function.
std::string printable(std::string_view text);

/// A text of several lines, made printable: keeps LF and CR LF.
std::string printable_lines(std::string_view text);

/// A set of bytes that texts are searched for: std::string_view::find_first_of() calls memchr() for each byte of the text.
class ByteSet {
 public:
  constexpr ByteSet() = default;
  constexpr explicit ByteSet(std::string_view bytes) { add(bytes); }

  constexpr void add(std::string_view bytes) {
    for (const char c : bytes) has_[static_cast<unsigned char>(c)] = true;
  }

  constexpr bool has(char c) const { return has_[static_cast<unsigned char>(c)]; }
  /// The place of the first of them in a text; npos if there is none.
  constexpr std::size_t first_in(std::string_view text, std::size_t from = 0) const {
    while (from < text.size() && !has(text[from])) ++from;
    return from < text.size() ? from : text.npos;
  }
  constexpr bool any_in(std::string_view text) const { return first_in(text) != text.npos; }

 private:
  bool has_[256]{};
};

inline constexpr ByteSet kBetweenWords{" \t"}, kBetweenOperands{" \t,"};

/// Takes the first word off a text. Empty: there is none.
std::string_view take_word(std::string_view& text, const ByteSet& between = kBetweenWords);

/// The words between blanks and tabs.
std::vector<std::string> split_words(std::string_view text);

/// ASCII letters in upper or lower case, everything else as it is.
std::string upper_case(std::string_view text);
std::string lower_case(std::string_view text);

/// Whether a text is upper_case() of another: `same_in_capitals(word, "NETWORK")`.
bool same_in_capitals(std::string_view text, std::string_view capitals);

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
inline bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
inline bool is_letter(char c) { return is_upper(c) || is_lower(c); }
inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\f'; }
inline char capital(char c) { return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c; }

}  // namespace s7200::stl
