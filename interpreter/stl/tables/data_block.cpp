#include "interpreter/stl/tables/data_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::stl {

namespace {

constexpr std::string_view kSeparators = " \t\f,;";

/// The words of a line: separated by blanks and commas, but not inside quotes.
class Words {
 public:
  explicit Words(std::string_view line) : line_(line), rest_(line) {}

  /// The next word; empty at the end of the line or at its comment.
  std::string_view next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kSeparators), rest_.size()));
    if (rest_.starts_with("//")) comment_ = std::exchange(rest_, {}).substr(2);
    std::size_t end = 0;
    while (end < rest_.size() && kSeparators.find(rest_[end]) == std::string_view::npos &&
           !rest_.substr(end).starts_with("//"))
      end += rest_[end] == '\'' || rest_[end] == '"' ? quoted(rest_.substr(end)) : 1U;
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  /// The text after `//`, once there are no more words.
  std::string_view comment() const { return trim_end(comment_); }

  /// The position of a word. Words are asked for in order, so the line is counted only once.
  Position position(std::string_view word, std::uint32_t line) {
    const auto at = static_cast<std::size_t>(word.data() - line_.data());
    column_ += count_characters(line_.substr(counted_, at - counted_));
    counted_ = at;
    return {line, static_cast<std::uint32_t>(column_), static_cast<std::uint32_t>(count_characters(word))};
  }

 private:
  /// The length of the quoted part at the beginning of a text; the rest of the line if it is not closed.
  static std::size_t quoted(std::string_view text) {
    std::size_t end = 1;
    while (end < text.size() && text[end] != text[0]) end += text[end] == '$' ? 2U : 1U;
    return std::min(end + 1, text.size());
  }

  std::string_view line_, rest_, comment_{};
  std::size_t counted_ = 0, column_ = 1;
};

bool is_quoted(std::string_view word) { return word.front() == '\'' || word.front() == '"'; }

/// Whether a word begins an address of a data block: `VB0`, `V0`, `DBW2`
bool begins_with_v_address(std::string_view word) {
  std::size_t letters = 0;
  while (letters < word.size() && is_letter(word[letters])) ++letters;
  if (letters == 0 || letters > 3 || letters == word.size() || !is_digit(word[letters])) return false;
  const std::string area = upper_case(word.substr(0, letters));
  return area == "V" || area == "VB" || area == "VW" || area == "VD" || area == "DBB" || area == "DBW" || area == "DBD";
}

bool begins_with_value(std::string_view word) {
  const char first = word.front();
  return is_digit(first) || first == '\'' || ((first == '-' || first == '+') && word.size() > 1 && is_digit(word[1]));
}

Result<DataLine::Value> value_of(std::string_view word, const Position& at) {
  if (is_quoted(word)) {
    if (word.size() < 2 || word.back() != word.front()) return Trouble{"this text has no closing quote"};
    auto bytes = parse_characters(word.substr(1, word.size() - 2));
    if (!bytes) return bytes.trouble();
    const bool with_length = word.front() == '"';
    if (with_length && bytes->size() > 254)
      return trouble("a string has at most 254 characters, this one has {}", bytes->size());
    if (with_length) bytes->insert(bytes->begin(), static_cast<char>(bytes->size()));
    return DataLine::Value{Text{std::move(*bytes)}, at};
  }
  const auto operand = parse_operand(word);
  if (!operand) return operand.trouble();
  if (const auto* integer = std::get_if<Integer>(&operand->value)) return DataLine::Value{*integer, at};
  if (const auto* real = std::get_if<Real>(&operand->value)) return DataLine::Value{*real, at};
  return trouble("{} is not a value", shortened(word));
}

/// `Address  Value`: headings of a table of values.
bool is_heading(std::string_view line) {
  constexpr std::string_view kAddress[] = {"ADDRESS", "ADRESSE", "DIRECCION", "INDIRIZZO", "地址"};
  constexpr std::string_view kValue[] = {"VALUE", "VALUES", "WERT", "VALEUR", "VALOR", "VALORE", "DATA", "值"};
  const std::vector<std::string> words = split_words(upper_case(line.substr(0, line.find("//"))));
  return words.size() >= 2 && std::ranges::find(kAddress, words[0]) != std::end(kAddress) &&
         std::ranges::find(kValue, words[1]) != std::end(kValue);
}

}  // namespace

bool is_data_block(std::string_view text, const std::function<bool(std::string_view word)>& is_mnemonic) {
  std::size_t addresses = 0, values = 0, other = 0;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (addresses + values + other == 0 && is_heading(line)) continue;
    Words words(line);
    const std::string_view word = words.next(), next = words.next();
    if (word.empty()) continue;
    const bool address = begins_with_v_address(word);
    const bool symbol = !address && !next.empty() && begins_with_value(next) && !is_mnemonic(upper_case(word));
    if (addresses + values + other == 0 && !address && !symbol) return false;
    if (address)
      ++addresses;
    else
      ++(symbol || begins_with_value(word) ? values : other);
  }
  return addresses > 0 && addresses + values >= other;
}

void read_data_line(std::string_view line, std::uint32_t number, ParseResult& result) {
  constexpr std::size_t kMostErrorsOfALine = 10;
  std::size_t errors = 0;
  const auto error = [&](const Position& at, std::string message, std::string hint) {
    if (++errors <= kMostErrorsOfALine)
      result.diagnostics.push_back({Severity::Error, at, std::move(message), std::move(hint)});
  };
  constexpr const char* kValues = "values are 65, -5, 16#FF, 2#1010, 3.14, 'text' and \"string\"";
  Words words(line);
  std::string_view word = words.next();
  DataLine data;
  if (word.empty()) {
    data.comment = words.comment();
    if (!data.comment.empty()) result.source.data.push_back(std::move(data));
    return;
  }
  data.position = words.position(word, number);
  const bool named = is_quoted(word) && word.find("\":") != std::string_view::npos;
  if (named || !(begins_with_value(word) || is_quoted(word))) {
    auto address = parse_operand(word);
    if (!address)
      return error(data.position, address.why(), "a line begins with an address of V memory, VB0, or with a value");
    data.address = *std::move(address);
    data.address->position = data.position;
    word = words.next();
    if (word.empty())
      return error(data.position, fmt::format("{} has no value", shortened(trim(line.substr(0, line.find("//"))))), kValues);
  }
  for (; !word.empty(); word = words.next()) {
    const Position at = words.position(word, number);
    if (auto value = value_of(word, at))
      data.values.push_back(std::move(*value));
    else
      error(at, value.why(), kValues);
  }
  data.comment = words.comment();
  result.source.data.push_back(std::move(data));
}

ParseResult read_data_block(std::string_view text, std::string name) {
  ParseResult result;
  result.source.name = std::move(name);
  result.source.text = split_lines(text);
  std::uint32_t number = 0;
  for (const std::string& line : result.source.text) {
    ++number;
    if (!result.source.data.empty() || !is_heading(line)) read_data_line(line, number, result);
  }
  return result;
}

}  // namespace s7200::stl
