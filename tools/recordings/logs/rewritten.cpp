#include "tools/recordings/logs/rewritten.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/notation.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

std::string in_hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format(" {:02X}", byte);
  return text;
}

bool any_line(std::string_view text, bool (*fits)(std::string_view line)) {
  return std::ranges::any_of(Lines(beginning_of(text)), fits);
}

// --- Netty ---

/// `|00000010| 01 03 00 00 00 02 c4 0b                         |........        |`
bool is_row_of_netty(std::string_view line) {
  constexpr std::size_t kOffset = 8;
  Scan scan(line);
  return scan.take("|") != '\0' && scan.take_hex(kOffset).size() == kOffset && scan.take_word("| ") &&
         scan.take_hex(2).size() == 2;
}

/// The lines without the frame around the bytes: a head, `… WRITE: 8B`, and the rows of a dump below it.
std::string without_frames_of_netty(std::string_view text) {
  std::string plain;
  for (const std::string_view line : Lines(text)) {
    if (is_row_of_netty(line)) {
      const std::string_view row = line.substr(1);
      const std::size_t bar = row.find('|');
      plain.append(row.substr(0, bar))
          .append(" ")
          .append(stl::trim_end(row.substr(bar + 1, row.find('|', bar + 1) - bar - 1)));
    } else if (const bool writes = line.find(" WRITE: ") != line.npos; writes || line.find(" READ: ") != line.npos) {
      const auto time = leading_time(line);
      plain.append(line.substr(0, time ? time->length : 0)).append(writes ? " TX" : " RX");
    } else if (!stl::trim(line).starts_with('+') && !stl::trim(line).starts_with('|')) {
      plain.append(line);
    }
    plain += '\n';
  }
  return plain;
}

// --- slsnif ---

struct RowOfSlsnif {
  bool from_host = false;
  std::string_view characters{};
};
std::optional<RowOfSlsnif> row_of_slsnif(std::string_view line) {
  const bool from_host = line.starts_with("Host ");
  if (!from_host && !line.starts_with("Device ")) return {};
  const std::size_t arrow = line.find("-->");
  if (arrow == line.npos || line.substr(0, arrow).find_first_of("([") != line.npos) return {};
  return RowOfSlsnif{from_host, line.substr(arrow + 3)};
}

/// The byte in `(065)` or `(0x41)` at the beginning of a text, and the length of that.
struct NumberInBrackets {
  std::uint8_t byte = 0;
  std::size_t length = 0;  ///< 0: there is none
};
NumberInBrackets number_in_brackets(std::string_view text) {
  Scan scan(text);
  if (scan.take("(") == '\0') return {};
  const bool hex = scan.take_word("0x");
  const std::string_view digits = hex ? scan.take_hex(3) : scan.take_digits(4);
  if (scan.take(")") == '\0' || digits.size() != (hex ? 2U : 3U)) return {};
  const std::size_t value = hex ? hex_number(digits) : static_cast<std::size_t>(decimal_number(digits));
  return value > 0xFF ? NumberInBrackets{} : NumberInBrackets{static_cast<std::uint8_t>(value), scan.at()};
}

/// The bytes of `[SOH](001) A (065)`: each has its character or name before its number. Nothing for anything else.
std::optional<Bytes> bytes_of_slsnif(std::string_view text) {
  Bytes bytes;
  const auto skip_blanks = [&] { text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size())); };
  for (skip_blanks(); !text.empty(); skip_blanks()) {
    NumberInBrackets number = number_in_brackets(text);
    if (number.length == 0) {
      const std::size_t end = text.front() == '[' ? text.find(']') : std::string_view::npos;
      text.remove_prefix(end == text.npos ? 1 : end + 1);
      skip_blanks();
      number = number_in_brackets(text);
      if (number.length == 0) return {};
    }
    bytes.push_back(number.byte);
    text.remove_prefix(number.length);
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

bool is_of_slsnif(std::string_view line) {
  const auto row = row_of_slsnif(line);
  return row && bytes_of_slsnif(row->characters);
}

/// Rows of one direction are one frame where each has a single character.
std::string rows_of_slsnif(std::string_view text) {
  struct Read {
    char direction = '\0';
    std::optional<Bytes> bytes{};
    std::string_view line{};
  };
  std::vector<Read> rows;
  bool single = true;
  for (const std::string_view line : Lines(text)) {
    Read& read = rows.emplace_back();
    read.line = line;
    const auto row = row_of_slsnif(line);
    if (!row) continue;
    read.direction = row->from_host ? 'T' : 'R';
    read.bytes = bytes_of_slsnif(row->characters);
    single = single && read.bytes && read.bytes->size() == 1;
  }
  std::string plain;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool goes_on = single && i > 0 && rows[i].bytes && rows[i].direction == rows[i - 1].direction;
    Bytes bytes = rows[i].bytes && !goes_on ? *rows[i].bytes : Bytes();
    for (std::size_t k = i + 1; single && !bytes.empty() && k < rows.size() && rows[k].direction == rows[i].direction; ++k)
      bytes.push_back(rows[k].bytes->front());
    if (!bytes.empty())
      plain += fmt::format("{}X{}", rows[i].direction, in_hex(bytes));
    else if (!goes_on)
      plain += rows[i].line;
    plain += '\n';
  }
  return plain;
}

// --- caret notation ---

/// A character as cat -v writes it: `^A`, `M-D`, `M-^K`, `A`; or the escape `\xC4`.
struct CaretCharacter {
  std::uint8_t byte = 0;
  std::size_t length = 0;
  bool is_written = false;  ///< it has a caret, `M-` or a backslash
};
CaretCharacter caret_character(std::string_view text) {
  constexpr std::uint8_t kControl = 0x40, kMeta = 0x80;
  if (text.size() > 3 && text.starts_with("\\x") && is_hex_digit(text[2]) && is_hex_digit(text[3]))
    return {static_cast<std::uint8_t>(hex_number(text.substr(2, 2))), 4, true};
  const bool meta = text.size() > 2 && text.starts_with("M-");
  const std::string_view rest = text.substr(meta ? 2 : 0);
  const bool control = rest.size() > 1 && rest.front() == '^' && rest[1] >= '?' && rest[1] <= '_';
  const auto character = static_cast<std::uint8_t>(control ? rest[1] ^ kControl : rest.front());
  return {static_cast<std::uint8_t>(character | (meta ? kMeta : 0)), (meta ? 2U : 0U) + (control ? 2U : 1U),
          meta || control};
}

/// The bytes of a text in caret notation, in which at least two characters need it. Nothing for any other text.
std::optional<Bytes> bytes_of_carets(std::string_view text) {
  constexpr std::size_t kFewest = 2;
  Bytes bytes;
  std::size_t carets = 0;
  while (!text.empty()) {
    const CaretCharacter character = caret_character(text);
    if (static_cast<unsigned char>(text.front()) >= 0x80) return {};
    carets += character.is_written && text.front() != '\\' ? 1U : 0U;
    bytes.push_back(character.byte);
    text.remove_prefix(character.length);
  }
  return carets < kFewest ? std::nullopt : std::optional(std::move(bytes));
}

/// Where the characters of a row begin: after its time and its direction.
std::size_t begin_of_characters(std::string_view line) {
  constexpr std::size_t kMostWords = 4;
  const auto time = leading_time(line);
  Scan scan(line.substr(time ? time->length : 0));
  const std::size_t begin = time ? time->length : 0;
  for (std::size_t words = 0; words < kMostWords && !scan.at_end(); ++words) {
    scan.skip(kAllBlanks);
    const std::string_view word = scan.take_while([](char c) { return !is_any_of(c, kAllBlanks); });
    if (word.find('^') != word.npos || word.find("M-") != word.npos) break;
    if (direction_of(word) == Direction::Unknown) continue;
    scan.skip(kAllBlanks, 1);
    return begin + scan.at();
  }
  return begin + std::min(line.substr(begin).find_first_not_of(kAllBlanks), line.size() - begin);
}

bool is_row_of_carets(std::string_view line) {
  return line.find('^') != line.npos && bytes_of_carets(line.substr(begin_of_characters(line))).has_value();
}

std::string without_carets(std::string_view text) {
  std::string plain;
  for (const std::string_view line : Lines(text)) {
    const std::size_t begin = line.find_first_of("^M") == line.npos ? line.size() : begin_of_characters(line);
    const auto bytes = begin < line.size() ? bytes_of_carets(line.substr(begin)) : std::nullopt;
    plain.append(bytes ? line.substr(0, begin) : line);
    if (bytes) plain.append(in_hex(*bytes));
    plain += '\n';
  }
  return plain;
}

// --- SQL ---

/// The place of the first digit of `X'0103'`, and how many there are; 0: there is none.
struct HexOfSql {
  std::size_t begin = 0, digits = 0, end = 0;
};
HexOfSql hex_of_sql(std::string_view text, std::size_t from) {
  for (const std::string_view open : {"X'", "x'", "'\\x", "0x"})
    for (std::size_t at = text.find(open, from); at != text.npos; at = text.find(open, at + 1)) {
      const std::size_t begin = at + open.size(),
                        end = std::min(text.find_first_not_of("0123456789ABCDEFabcdef", begin), text.size());
      const bool closed = open == "0x" || text.substr(end).starts_with('\'');
      if (closed && end > begin && (end - begin) % 2 == 0 && (at == 0 || !is_word_sign(text[at - 1]) || text[at - 1] == 'E'))
        return {begin, end - begin, open == "0x" ? end : end + 1};
    }
  return {};
}

bool begins_insert(std::string_view line) { return stl::upper_case(stl::trim(line).substr(0, 11)) == "INSERT INTO"; }

/// Whether a line is a row of values with bytes, alone or after INSERT INTO.
bool has_row_of_sql(std::string_view line) {
  const std::string_view code = stl::trim(line);
  const bool is_row = code.starts_with('(') && (code.ends_with(',') || code.ends_with(';')) && code.find('\'') != code.npos;
  return (is_row || begins_insert(code)) && hex_of_sql(code, 0).digits != 0;
}

/// `2024-01-01 10:00:00.050 RX 01 03` for `(2,'2024-01-01 10:00:00.050','RX',X'0103')`: the text in quotes, then the bytes.
std::string row_of_sql(std::string_view values) {
  const HexOfSql hex = hex_of_sql(values, 0);
  std::string time, words;
  const std::string_view others = values.substr(0, std::min(hex.begin, values.size()));
  for (const std::string_view part : {others, values.substr(std::min(hex.end, values.size()))})
    for (std::size_t at = part.find('\''); at != part.npos;) {
      const std::size_t end = part.find('\'', at + 1);
      if (end == part.npos) break;
      const std::string_view text = part.substr(at + 1, end - at - 1);
      const auto read = leading_time(text);
      if (read && read->length == text.size())
        time = text;
      else if (!text.empty() && direction_of(text) != Direction::Unknown)
        words.append(" ").append(text);
      at = part.find('\'', end + 1);
    }
  return time + words + ' ' + std::string(values.substr(hex.begin, hex.digits));
}

std::string rows_of_sql(std::string_view text) {
  std::string plain;
  bool inside = false;
  for (const std::string_view line : Lines(text)) {
    inside = inside || begins_insert(line);
    std::string rows;
    for (std::string_view rest = inside ? line : std::string_view(); hex_of_sql(rest, 0).digits != 0;) {
      const HexOfSql hex = hex_of_sql(rest, 0);
      const std::size_t open = rest.rfind('(', hex.begin);
      const std::size_t end = std::min(rest.find("),", hex.end), rest.size());
      if (!rows.empty()) rows += '\n';
      rows += row_of_sql(rest.substr(open == rest.npos ? 0 : open, end - (open == rest.npos ? 0 : open)));
      rest.remove_prefix(end);
    }
    if (inside && stl::trim(line).ends_with(';')) inside = false;
    plain.append(rows) += '\n';
  }
  return plain;
}

// --- MinimalModbus ---

/// `… Writing to instrument: '\x01\x03…'`, as versions for Python 2 print it.
constexpr std::string_view kInstrument = "instrument: '";

bool is_row_of_minimalmodbus(std::string_view line) {
  const std::size_t at = line.find(kInstrument);
  return at != line.npos && stl::trim_end(line).ends_with('\'') && line.find("\\x", at) != line.npos;
}

std::string rows_of_minimalmodbus(std::string_view text) {
  std::string plain;
  for (const std::string_view line : Lines(text)) {
    const std::size_t begin = line.find(kInstrument) + kInstrument.size();
    const std::string_view whole = stl::trim_end(line);
    const auto bytes = is_row_of_minimalmodbus(line) && whole.size() > begin
                           ? bytes_of_literal(whole.substr(begin, whole.size() - 1 - begin))
                           : std::nullopt;
    const auto time = leading_time(line);
    if (bytes)
      plain.append(line.substr(0, time ? time->length : 0))
          .append(line.find("riting") != line.npos ? " TX" : " RX")
          .append(in_hex(*bytes));
    else
      plain.append(line);
    plain += '\n';
  }
  return plain;
}

// --- AT commands of radio and network modules ---

/// `AT+SEND=1,8,010300000002C40B`, `+RCV=1,9,010304000A0014DA3E,-40,9`: what stands after the name of the command.
struct AtCommand {
  std::string_view name{}, parameters{};
  bool is_command = false;  ///< what the program has told the module
};
std::optional<AtCommand> at_command_in(std::string_view line) {
  for (std::size_t plus = line.find('+'); plus != line.npos; plus = line.find('+', plus + 1)) {
    const bool command = plus >= 2 && stl::upper_case(line.substr(plus - 2, 2)) == "AT";
    const std::size_t begin = command ? plus - 2 : plus;
    if (begin > 0 && (is_word_sign(line[begin - 1]) || is_any_of(line[begin - 1], ".,"))) continue;
    const auto end = static_cast<std::size_t>(
        std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(plus) + 1, line.end(), is_word_sign) - line.begin());
    if (end == plus + 1 || end >= line.size() || !is_any_of(line[end], "=:,") || !stl::is_letter(line[plus + 1])) continue;
    return AtCommand{line.substr(plus + 1, end - plus - 1), stl::trim(line.substr(end + 1)), command};
  }
  return {};
}

/// The bytes among the parameters: all of them, those after their number, or the only long parameter.
std::optional<Bytes> bytes_of_parameters(std::string_view parameters) {
  constexpr std::size_t kFewest = 4;
  std::string text(parameters);
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == ':' || c == '"'; }, ' ');
  const std::vector<std::string> words = stl::split_words(text);
  const auto bytes_from = [&](std::size_t first, std::size_t last) {
    std::string run;
    for (std::size_t i = first; i < last; ++i) run.append(words[i]) += ' ';
    return bytes_of_text(run).value_or(Bytes());
  };
  const auto is_pair = [](const std::string& word) { return word.size() == 2 && bytes_of_text(word).has_value(); };
  if (words.size() >= kFewest && std::ranges::all_of(words, is_pair)) return bytes_from(0, words.size());
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const auto count = parse_decimal<std::size_t>(words[i]);
    if (!count || *count < kFewest) continue;
    for (std::size_t last = i + 2; last <= words.size(); ++last)
      if (Bytes bytes = bytes_from(i + 1, last); bytes.size() == *count) return bytes;
  }
  if (Bytes all = bytes_from(0, words.size()); all.size() >= kFewest && parameters.find(',') == parameters.npos) return all;
  std::optional<Bytes> found;
  for (std::size_t i = 0; i < words.size(); ++i)
    if (Bytes bytes = bytes_from(i, i + 1); bytes.size() >= kFewest && std::exchange(found, std::move(bytes))) return {};
  return found;
}

bool is_row_of_at_commands(std::string_view line) {
  const auto command = at_command_in(line);
  return command && command->is_command;
}

std::string rows_of_at_commands(std::string_view text) {
  std::string plain;
  for (const std::string_view line : Lines(text)) {
    const auto command = at_command_in(line);
    const auto bytes = command ? bytes_of_parameters(command->parameters) : std::nullopt;
    if (bytes) {
      const auto time = leading_time(line);
      const Direction named = direction_of(command->name);
      const bool sent = named == Direction::Unknown ? command->is_command : named == Direction::Request;
      plain.append(line.substr(0, time ? time->length : 0)).append(sent ? " TX" : " RX").append(in_hex(*bytes));
    } else {  // it is not known which of its parameters are bytes
      plain.append(command ? "AT command" : line);
    }
    plain += '\n';
  }
  return plain;
}

/// A kind of log, recognised by one of its lines.
struct KindOfLog {
  bool (*has)(std::string_view line);
  std::string (*in_plain)(std::string_view text);
};
constexpr std::array kKindsOfLogs{KindOfLog{is_row_of_netty, without_frames_of_netty},
                                  KindOfLog{is_of_slsnif, rows_of_slsnif},
                                  KindOfLog{is_row_of_carets, without_carets},
                                  KindOfLog{has_row_of_sql, rows_of_sql},
                                  KindOfLog{is_row_of_minimalmodbus, rows_of_minimalmodbus},
                                  KindOfLog{is_row_of_at_commands, rows_of_at_commands}};

}  // namespace

std::optional<std::string> in_plain_rows(std::string_view text) {
  if (!is_text(beginning_of(text))) return {};
  for (const KindOfLog& kind : kKindsOfLogs)
    if (any_line(text, kind.has)) return kind.in_plain(text);
  return {};
}

}  // namespace s7200::tools
