// Facts 10.7: strings, and numbers as text.
#include "tests/reference_model/strings.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

constexpr std::size_t kLongest = 254;

void store_characters(const Place& first, const std::string& characters) {
  for (std::size_t i = 0; i < characters.size(); ++i)
    write(Place{first.bytes, first.at + i}, 1, static_cast<unsigned char>(characters[i]));
}

void store_string(Machine& m, std::size_t operand, const std::string& text) {
  const Place out = m.place(operand, 1);
  if (text.size() > kLongest || !holds(out, 1 + text.size())) throw RunTimeError{0x91};
  write(out, 1, static_cast<std::uint32_t>(text.size()));
  store_characters({out.bytes, out.at + 1}, text);
}

void length(Machine& m) {
  follow_pointers(m, {1, 1});
  const std::string text = string_in(m, 0);
  write(m.place(1, 1), 1, static_cast<std::uint32_t>(text.size()));
}

void copy(Machine& m) {
  follow_pointers(m, {1, 1});
  const std::string text = string_in(m, 0);
  store_string(m, 1, text);
  m.spend_units(static_cast<std::uint32_t>(text.size()));
}

void append(Machine& m) {
  follow_pointers(m, {1, 1});
  const std::string tail = string_in(m, 0), head = string_in(m, 1);
  store_string(m, 1, head + tail);
  m.spend_units(static_cast<std::uint32_t>(tail.size()));
}

bool starts_at(const std::string& text, std::size_t at, const std::string& wanted) {
  return at + wanted.size() <= text.size() && text.compare(at, wanted.size(), wanted) == 0;
}

/// `whole`: all of the second string; otherwise any character of it.
void find(Machine& m, bool whole) {
  follow_pointers(m, {1, 1, 1});
  const std::string text = string_in(m, 0), wanted = string_in(m, 1);
  const Place index = m.place(2, 1);
  const std::size_t from = read(index, 1);
  if (from == 0) throw RunTimeError{0x9B};
  std::uint32_t found = 0, looked_at = 0;
  for (std::size_t at = from; at <= text.size() && found == 0; ++at) {
    ++looked_at;
    const bool here =
        whole ? !wanted.empty() && starts_at(text, at - 1, wanted) : wanted.find(text[at - 1]) != std::string::npos;
    if (here) found = static_cast<std::uint32_t>(at);
  }
  write(index, 1, found);
  m.spend_units(looked_at);
}

// --- numbers ---

/// Blanks, sign, digits with a point before the last `decimals`; empty if that is more than `size`.
std::string number(std::uint64_t units, bool negative, std::uint32_t decimals, bool comma, std::size_t size) {
  std::string reversed;
  for (std::uint32_t i = 0; units > 0 || i <= decimals; ++i, units /= 10) {
    if (i == decimals && decimals > 0) reversed += comma ? ',' : '.';
    reversed += static_cast<char>('0' + units % 10);
  }
  if (negative && reversed.find_first_not_of("0.,") != std::string::npos) reversed += '-';
  if (reversed.size() > size) return "";
  reversed.resize(size, ' ');
  return {reversed.rbegin(), reversed.rend()};
}

void integer_to_text(Machine& m, std::size_t width, std::size_t size, bool with_length) {
  follow_pointers(m, {width, 1, 1});
  const std::uint32_t bits = m.in(0, width);
  const std::int64_t value = width == 2 ? signed16(bits) : signed32(bits);
  const Place out = m.place(1, 1);
  const std::uint32_t format = m.in(2, 1);
  if (!holds(out, size + (with_length ? 1 : 0))) throw RunTimeError{0x91};
  const bool legal = format < 16 && format % 8 <= 5;
  if (with_length) write(out, 1, static_cast<std::uint32_t>(size));
  std::string text;
  if (legal) text = number(static_cast<std::uint64_t>(std::llabs(value)), value < 0, format % 8, format >= 8, size);
  if (text.empty()) m.eno = false;
  store_characters({out.bytes, out.at + (with_length ? 1 : 0)}, text.empty() ? std::string(size, ' ') : text);
}

void real_to_text(Machine& m, bool with_length) {
  follow_pointers(m, {4, 1, 1});
  const long double value = real(m.in(0, 4));
  const Place out = m.place(1, 1);
  const std::uint32_t format = m.in(2, 1), size = format / 16, decimals = format % 8;
  if (!holds(out, size + (with_length ? 1 : 0))) throw RunTimeError{0x91};
  long double units = std::fabs(value);
  for (std::uint32_t i = 0; i < decimals; ++i) units *= 10;
  units = std::floor(units + 0.5L);
  std::string text;
  if (decimals <= 5 && size >= 3 && size >= decimals + 3 && units < 1e15L)
    text = number(static_cast<std::uint64_t>(units), value < 0, decimals, format % 16 >= 8, size);
  std::uint32_t digits = 0;
  for (const char c : text) digits += c >= '0' && c <= '9';
  if (with_length) write(out, 1, size);
  if (text.empty()) m.eno = false;
  store_characters({out.bytes, out.at + (with_length ? 1 : 0)}, text.empty() ? std::string(size, ' ') : text);
  if (digits > 1) m.spend_units(digits - 1);
}

/// The number in a string from character INDX on, as C writes it; without one, an empty text.
std::string number_in(Machine& m, bool with_point, std::size_t width) {
  follow_pointers(m, {1, 1, width});
  const std::string text = string_in(m, 0);
  const std::size_t index = m.in(1, 1);
  if (index == 0) throw RunTimeError{0x9B};
  std::size_t at = index - 1;
  while (at < text.size() && text[at] == ' ') ++at;
  std::string result;
  std::uint32_t characters = 0;
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) {
    characters += text[at] == '-';
    result += text[at++];
  }
  bool digits = false, point = false;
  for (; at < text.size(); ++at) {
    const bool digit = text[at] >= '0' && text[at] <= '9', mark = text[at] == '.' || text[at] == ',';
    if (!digit && !(mark && with_point && !point)) break;
    point = point || mark;
    digits = digits || digit;
    result += mark ? '.' : text[at];
    ++characters;
  }
  m.spend_units(characters);
  return digits ? result : "";
}

void string_to_integer(Machine& m, std::size_t width) {
  const std::string text = number_in(m, false, width);
  const long double value = text.empty() ? 0 : std::strtold(text.c_str(), nullptr),
                    limit = width == 2 ? 32768 : 2147483648.0L;
  const bool legal = !text.empty() && value >= -limit && value < limit;
  if (legal) write(m.place(2, width), width, static_cast<std::uint32_t>(static_cast<std::int64_t>(value)));
  set_flag(m, kOverflow, !legal);
}

void string_to_real(Machine& m) {
  const std::string text = number_in(m, true, 4);
  const float value = text.empty() ? 0 : std::strtof(text.c_str(), nullptr);
  const bool legal = !text.empty() && std::isfinite(value);
  if (legal) write(m.place(2, 4), 4, std::bit_cast<std::uint32_t>(value));
  set_flag(m, kOverflow, !legal);
}

}  // namespace

std::string string_in(Machine& m, std::size_t i) {
  if (const auto* constant = std::get_if<stl::Name>(&m.statement().operands[i].value))
    return constant->text.substr(1, constant->text.size() - 2);
  const Place first = m.place(i, 1);
  const std::size_t length = read(first, 1);
  if (length > kLongest || !holds(first, 1 + length)) throw RunTimeError{0x91};
  std::string text;
  for (std::size_t k = 1; k <= length; ++k) text += static_cast<char>(read(Place{first.bytes, first.at + k}, 1));
  return text;
}

void follow_pointers(Machine& m, std::initializer_list<std::size_t> widths) {
  std::size_t i = 0;
  for (const std::size_t width : widths) {
    if (std::holds_alternative<stl::Indirect>(m.statement().operands[i].value)) m.place(i, width);
    ++i;
  }
}

void add_strings(Instructions& all) {
  all["SLEN"] = {true, length};
  all["SCPY"] = {true, copy};
  all["SCAT"] = {true, append};
  all["SFND"] = {true, [](Machine& m) { find(m, true); }};
  all["CFND"] = {true, [](Machine& m) { find(m, false); }};
  all["ITA"] = {true, [](Machine& m) { integer_to_text(m, 2, 8, false); }};
  all["DTA"] = {true, [](Machine& m) { integer_to_text(m, 4, 12, false); }};
  all["RTA"] = {true, [](Machine& m) { real_to_text(m, false); }};
  all["ITS"] = {true, [](Machine& m) { integer_to_text(m, 2, 8, true); }};
  all["DTS"] = {true, [](Machine& m) { integer_to_text(m, 4, 12, true); }};
  all["RTS"] = {true, [](Machine& m) { real_to_text(m, true); }};
  all["STI"] = {true, [](Machine& m) { string_to_integer(m, 2); }};
  all["STD"] = {true, [](Machine& m) { string_to_integer(m, 4); }};
  all["STR"] = {true, string_to_real};
}

}  // namespace s7200::reference
