#include "tools/recordings/stated.hpp"

#include <algorithm>
#include <array>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

using serial::LineSettings;

/// The rates that a number before `8N1` is one of; beside a word for it, any is.
constexpr std::array<std::uint32_t, 18> kUsualRates{300,    600,     1'200,   2'400,   4'800,   9'600,
                                                    14'400, 19'200,  28'800,  38'400,  56'000,  57'600,
                                                    76'800, 115'200, 128'000, 187'500, 230'400, 460'800};

constexpr std::string_view kBesideNumber = " =:'\"";

std::optional<std::uint32_t> rate_from(std::string_view digits) {
  const auto rate = parse_decimal<std::uint32_t>(digits);
  return rate && *rate >= serial::kSlowestBaud && *rate <= serial::kFastestBaud ? rate : std::nullopt;
}

/// The digits before a place and the blanks in front of it.
std::string_view digits_before(std::string_view text, std::size_t end) {
  while (end > 0 && text[end - 1] == ' ') --end;
  std::size_t begin = end;
  while (begin > 0 && stl::is_digit(text[begin - 1])) --begin;
  return text.substr(begin, end - begin);
}

/// What is written after the name of a setting: `PARITY=N`, `"STOPBITS": 1`. Empty: nothing is.
std::string_view value_after(std::string_view line, std::string_view name) {
  const std::size_t at = line.find(name);
  if (at == std::string_view::npos) return {};
  Scan scan(line.substr(at + name.size()));
  return scan.skip(kBesideNumber) == 0 ? "" : scan.take_while([](char c) { return stl::is_digit(c) || stl::is_letter(c); });
}

std::optional<Parity> parity_of(std::string_view word) {
  if (word == "N" || word == "NONE" || word == "NO") return Parity::None;
  if (word == "E" || word == "EVEN") return Parity::Even;
  if (word == "O" || word == "ODD") return Parity::Odd;
  return {};
}

/// The number beside a word for a rate: `19200 BAUD`, `BAUD RATE: 19200`, `BAUDRATE":19200`
std::optional<std::uint32_t> rate_beside_word(std::string_view line) {
  constexpr std::string_view kBaud = "BAUD";
  const std::size_t at = line.find(kBaud);
  if (at == std::string_view::npos) return {};
  if (const auto rate = rate_from(digits_before(line, at))) return rate;
  Scan scan(line.substr(at + kBaud.size()));
  scan.take_word("S");
  scan.skip(" _");
  scan.take_word("RATE");
  return scan.skip(kBesideNumber) == 0 ? std::nullopt : rate_from(scan.take_digits(8));
}

/// Takes the format of a character, `8N1`, `8,N,1`, and of libmodbus `E, 8, 1`; nothing if there is another text.
std::optional<LineSettings> take_format(Scan& scan) {
  constexpr std::string_view kBetween = " ,-/(";
  const auto parity_here = [&] { return parity_of(scan.take_while(stl::is_letter, 4)); };
  scan.skip(kBetween);
  auto parity = stl::is_letter(scan.next()) ? parity_here() : std::nullopt;
  scan.skip(kBetween);
  const char bits = scan.take("78");
  scan.skip(kBetween);
  if (!parity) parity = parity_here();
  scan.skip(kBetween);
  const char stop = scan.take("12");
  if (!parity || bits == '\0' || stop == '\0' || is_word_sign(scan.next())) return {};
  return LineSettings{.parity = parity, .data_bits = value_of_digit(bits), .stop_bits = value_of_digit(stop)};
}

/// A usual rate with a format after it: `19200 8N1`, `19200,8,E,1`, `9600-8E1`, `19200 BAUDS (E, 8, 1)`
LineSettings rate_with_format(std::string_view line) {
  for (std::size_t at = line.find_first_of("0123456789"); at != std::string_view::npos;
       at = line.find_first_of("0123456789", at)) {
    const std::size_t end = std::min(line.find_first_not_of("0123456789", at), line.size());
    const auto rate = rate_from(line.substr(at, end - at));
    at = end;
    if (!rate || std::ranges::find(kUsualRates, *rate) == kUsualRates.end() || end == line.size()) continue;
    if (!is_any_of(line[end], " ,-/")) continue;
    Scan scan(line.substr(end));
    scan.skip(" ,");
    const std::size_t before = scan.at();
    for (const std::string_view word : {"BAUDS", "BAUD", "BPS", "BD"})
      if (scan.at() == before && scan.take_word(word)) break;
    if (auto format = take_format(scan)) return format->baud = rate, *format;
  }
  return {};
}

/// What a program sets in a trace: `ioctl(3, TCSETS, {c_cflag=B19200|CS8|PARENB, …})`, and of older ones `{B19200 …}`.
LineSettings set_by_ioctl(std::string_view line) {
  LineSettings settings;
  const std::size_t call = line.find("TCSETS");
  const std::size_t rate = call == std::string_view::npos ? call : line.find_first_of('B', call);
  for (std::size_t at = rate; at != std::string_view::npos; at = line.find('B', at + 1)) {
    const bool begins = is_any_of(line[at - 1], "={|");
    const std::string_view digits = line.substr(at + 1, line.find_first_not_of("0123456789", at + 1) - at - 1);
    if (!begins || !(settings.baud = rate_from(digits))) continue;
    if (line.find("C_CFLAG=") == std::string_view::npos) return settings;
    const auto has = [&](std::string_view flag) { return line.find(flag, call) != std::string_view::npos; };
    settings.parity = has("PARODD") ? Parity::Odd : has("PARENB") ? Parity::Even : Parity::None;
    settings.stop_bits = has("CSTOPB") ? 2 : 1;
    settings.data_bits = has("CS7") ? 7 : 8;
    return settings;
  }
  return {};
}

/// What a line says, in capitals.
LineSettings settings_in(std::string_view line) {
  if (const LineSettings set = set_by_ioctl(line); set.baud) return set;
  if (const LineSettings whole = rate_with_format(line); whole.baud) return whole;
  LineSettings settings{.baud = rate_beside_word(line)};
  settings.parity = parity_of(value_after(line, "PARITY"));
  for (const std::string_view name : {"STOPBITS", "STOP BITS", "STOP_BITS"})
    if (const auto bits = parse_decimal<std::uint8_t>(value_after(line, name)); bits && (*bits == 1 || *bits == 2))
      settings.stop_bits = bits;
  for (const std::string_view name : {"BYTESIZE", "DATABITS", "DATA BITS", "DATA_BITS"})
    if (const auto bits = parse_decimal<std::uint8_t>(value_after(line, name)); bits && (*bits == 7 || *bits == 8))
      settings.data_bits = bits;
  return settings;
}

/// The time-out that a line states: `TIMEOUT 500 MS`, `TIMEOUT=1000MS`
std::optional<Time> timeout_in(std::string_view line) {
  constexpr std::array<std::string_view, 3> kNames{"TIMEOUT", "TIME-OUT", "TIME OUT"};
  constexpr Time kLongest = 60 * kSecond;
  for (const std::string_view name : kNames) {
    const std::size_t at = line.find(name);
    if (at == std::string_view::npos) continue;
    Scan scan(line.substr(at + name.size()));
    if (scan.skip(kBesideNumber) == 0 || !stl::is_digit(scan.next())) continue;
    const std::string_view figure = scan.take_while([](char c) { return stl::is_digit(c) || c == '.'; });
    scan.skip(" ");
    const auto number = parse_decimal<double>(figure);
    const auto unit = unit_of(scan.take_while(stl::is_letter));
    if (!number || !unit || *number <= 0 || *number * static_cast<double>(*unit) > static_cast<double>(kLongest)) continue;
    return static_cast<Time>(*number * static_cast<double>(*unit));
  }
  return {};
}

}  // namespace

StatedLine stated_line(std::string_view bytes) {
  constexpr std::size_t kLongest = 1000;
  StatedLine stated;
  std::size_t number = 0;
  for (const std::string_view line : Lines(beginning_of(bytes))) {
    ++number;
    if (line.size() > kLongest) continue;
    const std::string capitals = stl::upper_case(line);
    const LineSettings settings = settings_in(capitals);
    if (!stated.timeout) stated.timeout = timeout_in(capitals);
    if (settings == LineSettings{}) continue;
    if (stated.number == 0) stated.number = number;
    const bool differs = settings.baud && stated.line.baud && *settings.baud != *stated.line.baud;
    stated.is_contradictory |= differs && capitals.find("TCSETS") == std::string::npos;  // a program may set it again
    stated.line.override_with(settings);
  }
  if (stated.is_contradictory) stated.line = {};
  return stated;
}

}  // namespace s7200::tools
