// The bytes of lines: the run of words that has them.
#include <algorithm>
#include <array>
#include <cctype>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/words.hpp"
#include "tools/recordings/rows/number_list.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {

/// A frame of Modbus ASCII as its characters, `:0B03006300028D`, with the CR LF that logs leave out (Modbus over Serial Line
/// V1.02, 2.5.2). Nothing if there is none, or it stands among other words and has a wrong LRC.
std::optional<BytesInLine> modbus_ascii_in(std::string_view line) {
  constexpr std::size_t kFewestDigits = 6;  // station, function, LRC
  constexpr std::string_view kBlanksAndMarks = " \t\"'";
  for (std::size_t colon = line.find(':'); colon != std::string_view::npos; colon = line.find(':', colon + 1)) {
    if (colon > 0 && !is_any_of(line[colon - 1], kBlanksAndMarks)) continue;
    std::size_t end = colon + 1;
    while (end < line.size() && is_hex_digit(line[end])) ++end;
    const std::string_view digits = line.substr(colon + 1, end - colon - 1);
    const std::string_view after = line.substr(end);
    const bool ends = after.find_first_not_of(" \t\r\"'") == std::string_view::npos || after.starts_with("\\r") ||
                      after.starts_with("<CR>");
    if (digits.size() < kFewestDigits || digits.size() % 2 != 0 || !ends) continue;
    std::uint8_t sum = 0;
    for (std::size_t i = 0; i < digits.size(); i += 2)
      sum = static_cast<std::uint8_t>(sum + hex_number(digits.substr(i, 2)));
    const std::string_view before = stl::trim(line.substr(0, colon));
    if (sum != 0 && !before.empty() && direction_of(before) == Direction::Unknown) continue;
    BytesInLine found{.begin = colon};
    for (const std::string_view part : {line.substr(colon, end - colon), std::string_view("\r\n")})
      found.bytes.insert(found.bytes.end(), part.begin(), part.end());
    return found;
  }
  return {};
}

/// Numbers that are no pairs of digits may be bytes as well, if they are a right frame.
std::optional<BytesInLine> BytesOfLines::in(std::string_view line) {
  if (auto ascii = modbus_ascii_in(line)) return ascii;
  auto found = among_words(line);
  if (found && found->not_understood.empty() && found->bytes.size() > 1) return found;
  auto list = number_list_at_end(without_comment(line));
  if (!list) return found;
  if (!found || found->not_understood.empty())
    return BytesInLine{.begin = list->begin, .not_understood = list->odd, .readings = std::move(list->readings)};
  std::ranges::move(list->readings, std::back_inserter(found->readings));
  found->begin = std::min(found->begin, list->begin);
  return found;
}

/// Whether bytes stand once more in brackets behind themselves: `01 03 00 (01 03 00)`.
bool stands_twice(Words run, const Bytes& bytes) {
  const std::size_t half = bytes.size() / 2;
  const auto second = std::ranges::find_if(
      run, [&](const Word& word) { return word.first_byte == run.front().first_byte + half && word.text.front() == '('; });
  return half > 1 && bytes.size() % 2 == 0 && second != run.end() && run.back().text.back() == ')' &&
         std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(half),
                    bytes.begin() + static_cast<std::ptrdiff_t>(half));
}

std::optional<BytesInLine> BytesOfLines::among_words(std::string_view line) {
  take_apart(without_comment(line));
  if (auto labelled = bytes_with_name_of_crc()) return labelled;
  const std::size_t end_of_row = end_of_hex(line);
  if (end_of_row < line.size()) take_apart(without_comment(line.substr(0, end_of_row)));
  const auto run = last_run(words_);
  if (!run) return bytes_in_comment(line);
  const Words after = Words(words_).subspan(run->before.size() + run->words.size());
  const bool is_sentence = is_of_a_sentence(run->before, run->words, after) || is_value(run->before, run->words) ||
                           are_values(run->before, run->words);
  if (is_sentence && !has_pairs(run->before)) return {};
  BytesInLine found{.begin = run->words.front().begin, .has_characters = end_of_row < line.size()};
  const Word* const doubtful = is_sentence ? &run->before.back() : what_is_doubtful(run->before, run->words, after);
  if (doubtful != nullptr) {
    found.not_understood = doubtful->text;
    return take_readings(found), found;
  }
  if (!after.empty() && after.front().text == "|") found.next_cell = after.front().begin + 1;
  found.bytes = bytes_of(run->words);
  if (stands_twice(run->words, found.bytes)) found.bytes.resize(found.bytes.size() / 2);
  if (const auto other = other_run(run->words, after)) {
    found.not_understood = other->without;
    found.readings = {{found.bytes, false}, {bytes_of(other->words), true}};
  }
  return found;
}

/// Bytes of which the last two have a name: `01 03 … CRC: E4 09`. They may be those of the frame once more.
std::optional<BytesInLine> BytesOfLines::bytes_with_name_of_crc() const {
  const auto is_name = [&](const Word& word) {
    const std::string_view name = word.text.substr(0, word.text.find_last_not_of(":=([") + 1);
    return word.bytes == 0 && is_any_of(word.text.front(), "CcLl") && is_name_of_check_sum(name);
  };
  const auto name = std::ranges::find_if(words_, is_name);
  if (name == words_.end() || name == words_.begin()) return {};
  const Words all(words_), before = all.first(static_cast<std::size_t>(name - words_.begin()));
  const Words sum = all.subspan(before.size() + 1);
  const auto run = last_run(before);
  const std::size_t bytes = sum.empty() ? 0 : sum.back().first_byte + sum.back().bytes - sum.front().first_byte;
  if (!run || run->before.size() + run->words.size() != before.size() || (bytes != 1 && bytes != 2)) return {};
  if (std::ranges::any_of(sum, [](const Word& word) { return word.bytes == 0; })) return {};
  Bytes whole = bytes_of(run->words), last = bytes_of(sum);
  BytesInLine found{.begin = run->words.front().begin, .not_understood = name->text};
  found.readings = {{whole, true}, {whole, true}};
  found.readings[0].bytes.insert(found.readings[0].bytes.end(), last.begin(), last.end());
  return found;
}

/// The bytes in a comment: a direction before the sign of a comment speaks for bytes after it, `RX #2 01 03`.
std::optional<BytesInLine> BytesOfLines::bytes_in_comment(std::string_view line) {
  const auto cut_off = cut_off_bytes(words_);
  const std::size_t comment = without_comment(line).size();
  if (cut_off || comment == line.size() || std::ranges::none_of(words_, names_a_direction)) return cut_off;
  take_apart(line.substr(comment));
  if (words_.empty() || !has_pairs(words_)) return {};
  return BytesInLine{.begin = comment, .not_understood = words_.front().text};
}

Bytes BytesOfLines::bytes_of(std::span<const Word> run) const {
  const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(run.front().first_byte);
  return {begin, bytes_.begin() + static_cast<std::ptrdiff_t>(run.back().first_byte + run.back().bytes)};
}

void BytesOfLines::take_readings(BytesInLine& found) const {
  const auto runs = possible_runs(words_);
  const auto has_word = [&](Words run) {
    return std::ranges::find(run, found.not_understood.data(), [](const Word& word) { return word.text.data(); }) !=
           run.end();
  };
  for (const Words run : runs) found.readings.push_back({bytes_of(run), !has_word(run)});
  if (!runs.empty()) found.begin = runs.front().front().begin;
}

void BytesOfLines::take_apart(std::string_view line) {
  words_.clear();
  bytes_.clear();
  bool in_pairs = false, has_others = false;
  for (std::size_t begin = begin_of_word(line, 0); begin < line.size();) {
    const std::size_t end = end_of_word(line, begin);
    Word word{.text = line.substr(begin, end - begin), .begin = begin, .first_byte = bytes_.size()};
    begin = begin_of_word(line, end);
    bool any = !(in_pairs && is_of_a_language(word.text)) && append_bytes(bytes_, word.text);
    std::size_t name = any ? 0 : length_of_name(word.text);
    if (name > 0 && word.text[name - 1] == '=' && !bytes_of_text(line.substr(begin, end_of_word(line, begin) - begin)))
      name = 0;  // `data=42` alone is a figure
    if (name > 0)
      if ((any = append_bytes(bytes_, word.text.substr(name)))) {
        words_.push_back({.text = word.text.substr(0, name), .begin = word.begin});
        word.text.remove_prefix(name);
        word.begin += name;
      }
    word.bytes = any ? bytes_.size() - word.first_byte : 0;
    in_pairs = word.bytes == 1;
    has_others = has_others || !any || is_any_of(word.text.front(), "([") || is_marked(word.text);
    words_.push_back(word);
  }
  if (has_others) take_numbers_out(words_);
}

/// The place of the characters that a tool puts beside the hex; the length of the line if there are none. The first of them
/// may be blanks.
std::size_t BytesOfLines::end_of_hex(std::string_view line) const {
  constexpr std::size_t kFullRow = 16, kShortestFullRow = 2 * kFullRow, kLongest = 1000, kBars = 2, kLongestSign = 4;
  if (line.size() > kLongest) return line.size();
  const bool ascii = stl::is_ascii(line);
  for (std::size_t count = 1; count <= words_.size(); ++count) {
    const Word& before = words_[count - 1];
    const std::size_t gap = before.begin + before.text.size();
    std::size_t last = gap;
    while (last < line.size() && line[last] == ' ') ++last;
    const std::size_t most = before.first_byte + before.bytes;  // characters: one for each byte at most
    const bool is_gap = last - gap > 1 || (last - gap == 1 && gap >= kShortestFullRow);
    if (!is_gap || last == line.size() || most == 0 || (last - gap == 1 && most < kFullRow)) continue;
    const std::size_t signs = line.size() - last;
    if (signs > most + kBars && (signs > kLongestSign * (most + kBars) || ascii || stl::is_ascii(line.substr(last))))
      continue;
    const auto run = last_run(Words(words_).first(count));
    if (!run || run->before.size() + run->words.size() != count) continue;
    const Word& first = run->words.front();
    const auto bytes = std::span(bytes_).subspan(first.first_byte, most - first.first_byte);
    for (std::size_t column = gap + (bytes.size() < kFullRow ? 2 : 1); column <= last; ++column)
      if (const std::string_view signs_at = without_bars(line.substr(column));
          ascii ? is_column_of_characters(signs_at, bytes) : is_column_of_characters(in_single_bytes(signs_at), bytes))
        return gap;
  }
  return line.size();
}

}  // namespace s7200::tools
