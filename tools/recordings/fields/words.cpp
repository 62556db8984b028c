#include "tools/recordings/fields/words.hpp"

#include <array>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// Whether a word begins with a date: `2026-11-22`
bool has_date(std::string_view word) {
  constexpr std::string_view kForm = "dddd-dd-dd";
  const auto is_date = [&](std::string_view text) {
    const auto fits = [](char c, char form) { return form == 'd' ? stl::is_digit(c) : c == form; };
    return std::ranges::equal(text, kForm, fits) && (text.starts_with("19") || text.starts_with("20")) && text[5] <= '1' &&
           text[8] <= '3';
  };
  for (std::size_t dash = word.find('-'); dash != std::string_view::npos; dash = word.find('-', dash + 1))
    if (dash >= 4 && is_date(word.substr(dash - 4, kForm.size()))) return true;
  return false;
}

/// Whether a word is the identifier of something: `123e4567-e89b-12d3-a456-426614174000`
bool is_uuid(std::string_view word) {
  constexpr std::string_view kForm = "xxxxxxxx-xxxx-xxxx-xxxx-xxxxxxxxxxxx";
  const std::size_t begin = word.find_first_not_of("{(\"");
  if (begin == std::string_view::npos) return false;
  const auto fits = [](char c, char form) { return form == '-' ? c == form : is_hex_digit(c); };
  return std::ranges::equal(word.substr(begin, kForm.size()), kForm, fits);
}

/// Appends pairs of digits with one sign between them: `01:03:00:0A:00`, `01_03_00_0A_00`. Fewer may be a time, a date or
/// the address of a host, and six with colons that of a network card.
bool append_pairs_with_sign(Bytes& bytes, std::string_view word) {
  constexpr std::size_t kPlace = 3, kFewest = 5, kOfNetworkCard = 6;  // two digits and a sign
  const std::size_t pairs = (word.size() + 1) / kPlace;
  if (pairs < kFewest || word.size() % kPlace != kPlace - 1 || !is_any_of(word[2], ":._|/")) return false;
  if (word[2] == ':' && pairs == kOfNetworkCard) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (i % kPlace == kPlace - 1 ? word[i] != word[2] : !is_hex_digit(word[i])) return false;
  for (std::size_t i = 0; i < word.size(); i += kPlace)
    bytes.push_back(static_cast<std::uint8_t>(hex_number(word.substr(i, 2))));
  return true;
}

/// The end of the bytes before a comment: at a `;` after at least two bytes, `01 0x03;`, otherwise at the end of the line.
std::size_t end_of_bytes_before_comment(std::string_view line) {
  for (std::size_t at = line.find(';'); at != std::string_view::npos; at = line.find(';', at + 1)) {
    const bool closes = at + 1 == line.size() || kAllBlanks.find(line[at + 1]) != std::string_view::npos;
    const std::size_t blank = closes ? line.find_last_of(kAllBlanks, at) : std::string_view::npos;
    if (blank == std::string_view::npos || blank == 0 || !is_hex_digit(line[blank - 1])) continue;
    Scan word(line.substr(blank + 1));
    word.take_word("0x");
    const std::size_t digits = word.take_hex(4).size();
    if (digits > 0 && blank + 1 + word.at() == at) return at;
  }
  return line.size();
}

/// Whether the number is a TCP port: `plc:5020`, `plc.local:502`. It has no 0 in front, and a name with a dot is that of a
/// host.
bool is_port_of_host(std::string_view name, std::string_view number) {
  if (name.back() != ':' || !is_decimal(number) || direction_of(name) != Direction::Unknown) return false;
  const bool four_digits = number.size() == 4 && number.front() != '0';
  return four_digits || (number.size() <= 5 && name.find('.') != std::string_view::npos);
}

/// Whether a name may end there: `Tx:`, and after a sign that takes three bytes in UTF-8, an arrow or one of Chinese.
/// Letters that take two may go on as `de` does.
bool ends_name(std::string_view word, std::size_t end) {
  constexpr unsigned char kThreeBytes = 0xE0, kFourBytes = 0xF0;
  const auto lead = static_cast<unsigned char>(end >= 3 ? word[end - 3] : 0);
  return is_any_of(word[end - 1], ":;>,])-|{=") || (lead >= kThreeBytes && lead < kFourBytes);
}

/// Whether a name and numbers are a sentence with commas, not bytes after a name: `$GPGGA,12,34`, `T;21;35`.
bool is_sentence_with_commas(std::string_view name, std::string_view numbers) {
  constexpr std::size_t kFourPairs = 11;
  if (!is_any_of(name.back(), ",;") || direction_of(name) != Direction::Unknown) return false;
  return is_any_of(name.front(), "$!+@") || numbers.size() < kFourPairs;
}

/// Words beside a number that say what the number is.
struct NumberName {
  std::string_view word;
  bool with_colon;  ///< `length: 12` is a length; `line: 12` is what was on a line
};
constexpr std::array kBeforeNumbers{NumberName{"LENGTH", true}, NumberName{"LEN", true},      NumberName{"SIZE", true},
                                    NumberName{"COUNT", true},  NumberName{"PORT", true},     NumberName{"BAUD", true},
                                    NumberName{"RATE", true},   NumberName{"BAUDRATE", true}, NumberName{"TIMEOUT", true},
                                    NumberName{"NUMBER", true}, NumberName{"NO", false},      NumberName{"NR", false},
                                    NumberName{"LINE", false},  NumberName{"PACKET", false},  NumberName{"SEQ", false},
                                    NumberName{"ID", false},    NumberName{"NETWORK", true}};
constexpr std::array<std::string_view, 11> kAfterNumbers{"BYTE", "BYTES", "CHARS",   "CHARACTERS", "OCTETS", "SECONDS",
                                                         "BAUD", "BAUDS", "RETRIES", "REGISTERS",  "COILS"};

/// Words before a number that is not a byte: `slave 1 01 03`
constexpr std::array<std::string_view, 8> kStations{"SLAVE", "MASTER", "STATION", "UNIT",
                                                    "NODE",  "DEVICE", "ADDRESS", "ADDR"};

bool is_name_of_station(std::string_view word) {
  return std::ranges::find(kStations, stl::upper_case(word.substr(0, word.find_last_not_of(":=#") + 1))) != kStations.end();
}

bool is_name_of_number(std::string_view word) {
  if (!is_letter(word.front())) return false;
  const bool colon = word.ends_with(':');
  const std::string name = stl::upper_case(word.substr(0, word.size() - (colon ? 1 : 0)));
  const auto row = std::ranges::find(kBeforeNumbers, name, &NumberName::word);
  return row != kBeforeNumbers.end() && (row->with_colon || !colon);
}

bool is_counted(std::string_view word) {
  const std::size_t end = word.find_last_not_of(":)],;");
  return end != std::string_view::npos && is_letter(word.front()) &&
         std::ranges::find(kAfterNumbers, stl::upper_case(word.substr(0, end + 1))) != kAfterNumbers.end();
}

/// The text in brackets: `(0X12)`. Empty: it has none.
std::string_view in_brackets(std::string_view word) {
  const bool bracketed =
      word.size() > 2 && ((word.front() == '(' && word.back() == ')') || (word.front() == '[' && word.back() == ']'));
  return bracketed ? word.substr(1, word.size() - 2) : "";
}

/// Whether two words are a byte in decimal and in hex: `18 (0X12)`, `0x12 (18)`.
bool say_the_same(std::string_view decimal, std::string_view hex) {
  const auto byte = parse_decimal<std::uint8_t>(decimal);
  const auto value = is_marked(hex) && hex.size() <= 4 ? parse_integer("16#" + std::string(hex.substr(2))) : std::nullopt;
  return byte && value && *value == *byte;
}

/// Whether a number names how many bytes follow it, in decimal or in hex.
bool counts_bytes_after(Words words, std::string_view digits) {
  std::size_t bytes = 0;
  for (const Word& word : words) {
    if (word.bytes == 0) break;
    bytes += word.bytes;
  }
  const auto decimal = parse_decimal<std::size_t>(digits);
  const auto hex = parse_integer("16#" + std::string(digits.substr(is_marked(digits) ? 2 : 0)));
  return decimal == bytes || (hex && *hex == static_cast<std::int64_t>(bytes));
}

/// Whether the number in brackets after bytes is how many they are: `01 03 … (8)`
bool counts_bytes_before(Words words, std::string_view inner) {
  std::size_t bytes = 0;
  for (auto word = words.rbegin(); word != words.rend() && word->bytes > 0; ++word) {
    if (!in_brackets(word->text).empty()) return false;
    bytes += word->bytes;
  }
  return bytes > 1 && parse_decimal<std::size_t>(inner) == bytes;
}

/// Whether the first word is where a dump of memory begins: `0x3ffb1234   01 03 …`, as ESP-IDF logs it
bool is_address_before_bytes(Words words) {
  constexpr std::size_t kAddress = 10;
  if (words.size() < 3 || words[0].text.size() != kAddress || !is_marked(words[0].text)) return false;
  const std::size_t gap = words[1].begin - (words[0].begin + kAddress);
  return words[0].bytes > 0 && gap > 1 && words[1].bytes == 1 && !is_marked(words[1].text);
}

}  // namespace

bool append_bytes(Bytes& bytes, std::string_view word) {
  constexpr std::string_view kOpening = "[<({\"", kBetween = ",;-[]<>(){}\"";
  if (word.size() == 2 && is_hex_digit(word[0]) && is_hex_digit(word[1])) {
    bytes.push_back(static_cast<std::uint8_t>(value_of_digit(word[0]) << 4 | value_of_digit(word[1])));
    return true;
  }
  if (append_pairs_with_sign(bytes, word)) return true;
  const std::size_t before = bytes.size();
  std::size_t at = std::min(word.find_first_not_of(kOpening), word.size());
  while (at < word.size()) {
    const bool marked = is_marked(word.substr(at));
    const std::size_t begin = at + (marked ? 2 : 0);
    for (at = begin; at < word.size() && is_hex_digit(word[at]);) ++at;
    const std::size_t digits = at - begin;
    const std::size_t next = std::min(word.find_first_not_of(kBetween, at), word.size());
    if (digits == 0 || (digits % 2 != 0 && !(marked && digits == 1)) || (next == at && at < word.size())) {
      bytes.resize(before);
      return false;
    }
    if (digits == 1) bytes.push_back(value_of_digit(word[begin]));
    for (std::size_t i = begin; i + 1 < at; i += 2)
      bytes.push_back(static_cast<std::uint8_t>(value_of_digit(word[i]) << 4 | value_of_digit(word[i + 1])));
    at = next;
  }
  if (has_date(word) || is_uuid(word)) bytes.resize(before);
  return bytes.size() > before;
}

std::string_view without_comment(std::string_view line) {
  constexpr std::string_view kMarks = ";/#";
  if (std::ranges::none_of(line, [](char c) { return c == ';' || c == '/' || c == '#'; })) return line;
  const auto is_blank = [&](std::size_t at) {
    return at < line.size() && kAllBlanks.find(line[at]) != std::string_view::npos;
  };
  for (std::size_t at = line.find_first_of(kMarks); at != std::string_view::npos; at = line.find_first_of(kMarks, at + 1))
    if (at > 0 && is_blank(at - 1) && (line[at] != '/' || line.substr(at).starts_with("//"))) line = line.substr(0, at - 1);
  return line.substr(0, end_of_bytes_before_comment(line));
}

bool is_name_of_check_sum(std::string_view word) {
  static constexpr std::array<std::string_view, 5> kNames{"CRC", "CRC16", "LRC", "CHECKSUM", "CHK"};
  return std::ranges::find(kNames, stl::upper_case(word)) != kNames.end();
}

bool is_of_a_language(std::string_view word) { return word.size() > 2 && std::ranges::all_of(word, is_letter); }

std::size_t length_of_name(std::string_view word) {
  const auto is_of_name = [&](std::size_t at) {
    const bool is_mark = at > 0 && word[at - 1] == '0' && (word[at] | 0x20) == 'x';
    return !is_hex_digit(word[at]) && is_letter_of_any_language(word[at]) && !is_mark;
  };
  std::size_t end = word.size();
  while (end > 0 && !is_of_name(end - 1)) --end;
  while (end > 0 && end < word.size() && !ends_name(word, end)) ++end;
  while (end > 0 && end < word.size() && is_any_of(word[end], ",;:|")) ++end;
  if (end == 0 || end >= word.size()) return 0;
  const std::string_view name = word.substr(0, end);
  const std::string_view after = word.substr(end);
  const bool of_a_value = name.find_first_of("=\"") != std::string_view::npos;  // `data=01`, `{"address":17`
  const bool names_it =
      (!of_a_value || names_bytes({.text = name})) && !is_port_of_host(name, after) && !is_sentence_with_commas(name, after);
  return names_it ? name.size() : 0;
}

void take_numbers_out(std::vector<Word>& words) {
  constexpr std::string_view kAround = "()[],;:";
  const auto is_number = [](Word& word) {
    word.bytes = 0;
    word.number = Word::Number::Yes;
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view text = words[i].text, inner = in_brackets(text);
    if (!inner.empty() && counts_bytes_before(Words(words).first(i), inner)) {
      is_number(words[i]);
      continue;
    }
    if (text.size() == 2 && i > 0 && words[i - 1].bytes > 0) continue;  // a pair of digits after bytes is one
    if (is_address_before_bytes(Words(words).subspan(i))) {
      is_number(words[i]);
      continue;
    }
    if (i > 0 && is_decimal(inner) && say_the_same(inner, words[i - 1].text)) is_number(words[i]);
    if (i > 0 && is_marked(inner) && say_the_same(words[i - 1].text, inner)) is_number(words[i - 1]);
    const std::size_t begin = std::min(text.find_first_not_of(kAround), text.size());
    const std::string_view digits = text.substr(begin, text.find_last_not_of(kAround) + 1 - begin);
    if (i > 0 && words[i].bytes == 0 && is_decimal(digits) && is_name_of_station(words[i - 1].text)) is_number(words[i]);
    if (words[i].bytes == 0 || !(is_decimal(digits) || is_marked(digits))) continue;
    const bool named = i > 0 && is_name_of_number(words[i - 1].text);
    const bool after_bytes = i > 0 && words[i - 1].bytes > 0 && begin == 0;
    const bool counted = !after_bytes && i + 1 < words.size() && is_counted(words[i + 1].text);
    const bool before_bytes = i + 1 < words.size() && words[i + 1].bytes > 0;
    if (named && before_bytes && !counts_bytes_after(Words(words).subspan(i + 1), digits))
      words[i].number = Word::Number::Perhaps;
    else if (named || counted)
      is_number(words[i]);
  }
}

std::optional<Bytes> bytes_of_text(std::string_view text) {
  Bytes bytes;
  for (std::size_t begin = begin_of_word(text, 0); begin < text.size();) {
    const std::size_t end = end_of_word(text, begin);
    if (!append_bytes(bytes, text.substr(begin, end - begin))) return {};
    begin = begin_of_word(text, end);
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

}  // namespace s7200::tools
