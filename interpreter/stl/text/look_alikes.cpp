#include "interpreter/stl/text/look_alikes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200::stl {
namespace {

constexpr std::size_t kLongestWord = 40;

struct Letter {
  char32_t code;
  char latin;
  std::string_view alphabet;
};

constexpr std::string_view kCyrillic = "Cyrillic", kGreek = "Greek";

// Capitals and small letters that are printed as the Latin letter is.
constexpr std::array kLetters{
    Letter{U'А', 'A', kCyrillic}, Letter{U'В', 'B', kCyrillic}, Letter{U'С', 'C', kCyrillic}, Letter{U'Е', 'E', kCyrillic},
    Letter{U'Н', 'H', kCyrillic}, Letter{U'І', 'I', kCyrillic}, Letter{U'К', 'K', kCyrillic}, Letter{U'М', 'M', kCyrillic},
    Letter{U'О', 'O', kCyrillic}, Letter{U'Р', 'P', kCyrillic}, Letter{U'Ѕ', 'S', kCyrillic}, Letter{U'Т', 'T', kCyrillic},
    Letter{U'Х', 'X', kCyrillic}, Letter{U'а', 'a', kCyrillic}, Letter{U'с', 'c', kCyrillic}, Letter{U'е', 'e', kCyrillic},
    Letter{U'і', 'i', kCyrillic}, Letter{U'о', 'o', kCyrillic}, Letter{U'р', 'p', kCyrillic}, Letter{U'х', 'x', kCyrillic},
    Letter{U'Α', 'A', kGreek},    Letter{U'Β', 'B', kGreek},    Letter{U'Ε', 'E', kGreek},    Letter{U'Η', 'H', kGreek},
    Letter{U'Ι', 'I', kGreek},    Letter{U'Κ', 'K', kGreek},    Letter{U'Μ', 'M', kGreek},    Letter{U'Ν', 'N', kGreek},
    Letter{U'Ο', 'O', kGreek},    Letter{U'Ρ', 'P', kGreek},    Letter{U'Τ', 'T', kGreek},    Letter{U'Χ', 'X', kGreek},
};

/// A word in Latin letters; nothing if some of its characters look like none.
std::optional<LookAlike> in_latin(std::string_view word) {
  LookAlike result;
  for (const Character c : characters(word)) {
    const std::string_view written = word.substr(0, c.bytes);
    word.remove_prefix(c.bytes);
    if (c.code < 0x80) {
      result.meant += written;
      continue;
    }
    const auto row = std::ranges::find(kLetters, c.code, &Letter::code);
    if (row == kLetters.end()) return std::nullopt;
    if (result.wrong.empty())
      result.wrong = fmt::format("the {} letter {} (U+{:04X})", row->alphabet, written, static_cast<std::uint32_t>(c.code));
    result.meant += row->latin;
  }
  return result;
}

/// Whether a word is an address or a constant. `all_letters`: it had no digit before, so that a short one may be a name.
bool is_operand(const std::string& word, bool all_letters) {
  const auto operand = parse_operand(word);
  if (!operand || std::holds_alternative<Name>(operand->value)) return false;
  const auto* address = std::get_if<Address>(&operand->value);
  return !all_letters || (address && address->size != Size::None);
}

/// `I0.9`: the first letter is that of inputs, not a 1.
bool begins_as_input(std::string_view word) {
  const std::size_t number = word.find_first_not_of("0123456789", 1);
  return (word.starts_with('I') || word.starts_with('i')) && number > 1 && (number == word.npos || word[number] == '.');
}

/// The digit that a letter was probably meant for; 0 for other letters.
char digit_for(char letter) {
  if (letter == 'O' || letter == 'o') return '0';
  return letter == 'l' || letter == 'I' ? '1' : 0;
}

/// The word with digits in place of letters from `from` on; nothing if there are no such letters.
std::optional<LookAlike> with_digits(std::string_view word, std::size_t from) {
  LookAlike result{{}, std::string(word)};
  for (std::size_t i = from; i < word.size(); ++i) {
    const char digit = digit_for(word[i]);
    if (digit == 0) continue;
    if (result.wrong.empty()) result.wrong = fmt::format("the letter {} in place of the digit {}", word[i], digit);
    result.meant[i] = digit;
  }
  return result.wrong.empty() ? std::nullopt : std::optional(result);
}

}  // namespace

std::optional<LookAlike> look_alike_operand(std::string_view word) {
  if (word.size() > kLongestWord) return std::nullopt;
  const auto latin = in_latin(word);
  if (!latin) return std::nullopt;
  const bool all_letters = std::ranges::none_of(word, is_digit);
  if (!latin->wrong.empty() && is_operand(latin->meant, all_letters)) return latin;
  // The longest area is tried first: VB1O is VB10.
  for (std::size_t letters = std::min<std::size_t>(5, latin->meant.size()); letters-- > 0;) {
    if (letters == 0 && begins_as_input(latin->meant)) break;
    auto meant = with_digits(latin->meant, letters);
    if (meant && is_operand(meant->meant, all_letters)) return meant;
  }
  return std::nullopt;
}

std::optional<LookAlike> look_alike_number(std::string_view word) {
  auto meant = word.size() > kLongestWord ? std::nullopt : with_digits(word, 0);
  return meant && std::ranges::all_of(meant->meant, is_digit) ? meant : std::nullopt;
}

std::optional<LookAlike> look_alike_mnemonic(std::string_view word) {
  auto latin = word.size() > kLongestWord ? std::nullopt : in_latin(word);
  return latin && !latin->wrong.empty() ? latin : std::nullopt;
}

std::string constant_here(std::string_view word) {
  const std::string upper = upper_case(word);
  const auto digits_after = [&](std::string_view mark, std::string_view digits) -> std::string {
    if (!upper.starts_with(mark) || upper.size() == mark.size()) return {};
    const std::string rest = upper.substr(mark.size());
    return rest.find_first_not_of(digits) == rest.npos ? rest : std::string();
  };
  constexpr std::string_view kHex = "0123456789ABCDEF", kDecimal = "0123456789";
  for (const std::string_view mark : {"0X", "&H", "$", "H'", "#16#"})
    if (const std::string digits = digits_after(mark, kHex); !digits.empty()) return "16#" + digits;
  if (const std::string digits = digits_after("0B", "01"); !digits.empty()) return "2#" + digits;
  if (const std::string digits = digits_after("#", kDecimal); !digits.empty()) return digits;
  const bool ends_with_h = upper.size() > 1 && upper.back() == 'H' && is_digit(upper.front()) &&
                           upper.find_first_not_of(kHex) == upper.size() - 1;
  return ends_with_h ? "16#" + upper.substr(0, upper.size() - 1) : std::string();
}

}  // namespace s7200::stl
