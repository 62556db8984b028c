#include "tools/scenario/text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "tools/views/register_text.hpp"

namespace s7200::tools {
namespace {

constexpr double kMostCharacters = 1e6;

bool take(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// `3.5 characters`, `1 character`
std::optional<std::int64_t> parse_characters(std::string_view text) {
  for (const std::string_view unit : {"characters", "character"})
    if (text.ends_with(unit)) {
      const std::string_view figure = stl::trim(text.substr(0, text.size() - unit.size()));
      const auto value = parse_decimal<double>(figure);
      if (!value || !Between<double>{0, kMostCharacters}.has(*value) || figure.find_first_of("eE") != figure.npos) return {};
      return std::llround(*value * 1000);
    }
  return {};
}

/// A value in a calculation: a whole number, or text, of which nothing can be calculated.
struct Value {
  std::int64_t number = 0;
  std::optional<std::string> text{};
};

struct Wrong {
  std::string why;
};
struct NoValue : Wrong {};

/// Recursive descent: comparison, sum, product, sign, primary.
class Calculation {
 public:
  Calculation(std::string_view text, const Parameters& parameters) : rest_(text), parameters_(parameters) {}

  std::string result() {
    const Value value = comparison();
    skip_blanks();
    if (!rest_.empty()) throw Wrong{fmt::format("'{}' is not understood", stl::shortened(rest_))};
    return value.text ? *value.text : std::to_string(value.number);
  }

 private:
  static constexpr int kDeepest = 20;
  static constexpr std::int64_t kLargest = 1'000'000'000'000;

  void skip_blanks() { rest_ = rest_.substr(std::min(rest_.size(), rest_.find_first_not_of(" \t"))); }
  bool sign(std::string_view which) {
    skip_blanks();
    return take(rest_, which);
  }

  static std::int64_t number(const Value& value) {
    if (!value.text) return value.number;
    const auto parsed = parse_number(*value.text);
    if (!parsed) throw Wrong{fmt::format("'{}' is no number", stl::shortened(*value.text))};
    return *parsed;
  }
  static Value checked(std::int64_t result) {
    if (result > kLargest || result < -kLargest) throw Wrong{"the result is too large"};
    return {result, {}};
  }

  Value comparison() {
    Value left = sum();
    for (const std::string_view which : {"<=", ">=", "!=", "<", ">", "="})
      if (sign(which)) {
        const std::int64_t a = number(left), b = number(sum());
        const bool holds = which == "<="   ? a <= b
                           : which == ">=" ? a >= b
                           : which == "!=" ? a != b
                           : which == "<"  ? a < b
                           : which == ">"  ? a > b
                                           : a == b;
        return {holds ? 1 : 0, {}};
      }
    return left;
  }
  Value sum() {
    Value left = product();
    for (;;) {
      if (sign("+")) {
        left = checked(number(left) + number(product()));
      } else if (sign("-")) {
        left = checked(number(left) - number(product()));
      } else {
        return left;
      }
    }
  }
  Value product() {
    Value left = primary();
    for (;;) {
      const bool times = sign("*"), over = !times && sign("/"), rest = !times && !over && sign("%");
      if (!times && !over && !rest) return left;
      const std::int64_t a = number(left), b = number(primary());
      if (!times && b == 0) throw Wrong{"a division by 0"};
      if (times && a != 0 && std::abs(b) > kLargest / std::abs(a)) throw Wrong{"the result is too large"};
      left = checked(times ? a * b : over ? a / b : a % b);
    }
  }

  Value primary() {
    if (++depth_ > kDeepest) throw Wrong{"too many parentheses inside each other"};
    const Value value = primary_inside();
    --depth_;
    return value;
  }
  Value primary_inside() {
    if (sign("-")) return checked(-number(primary()));
    if (sign("(")) {
      const Value inside = comparison();
      if (!sign(")")) throw Wrong{"a ) is missing"};
      return inside;
    }
    const std::size_t end =
        std::min(rest_.size(), rest_.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                                       "0123456789_.#"));
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    if (word.empty())
      throw Wrong{rest_.empty() ? "something is missing at its end"
                                : fmt::format("'{}' is not understood", stl::shortened(rest_))};
    if (stl::is_digit(word.front())) {
      const auto parsed = parse_number(word);
      if (!parsed) throw Wrong{fmt::format("'{}' is no number", stl::shortened(word))};
      return checked(*parsed);
    }
    return sign("(") ? function(word) : parameter(word);
  }

  Value parameter(std::string_view name) const {
    const auto found = parameters_.values.find(name);
    if (found == parameters_.values.end()) throw NoValue{{fmt::format("there is no parameter '{}'", stl::shortened(name))}};
    return {0, found->second};
  }

  /// has(NAME): whether there is such a parameter with a value.
  Value has_parameter() {
    skip_blanks();
    const std::string_view name = rest_.substr(0, std::min(rest_.size(), rest_.find_first_of(" \t)")));
    rest_.remove_prefix(name.size());
    if (!sign(")")) throw Wrong{"a ) is missing"};
    return {parameters_.values.contains(name) ? 1 : 0, {}};
  }

  Value function(std::string_view name) {
    if (name == "has") return has_parameter();
    std::vector<std::int64_t> arguments;
    do arguments.push_back(number(comparison()));
    while (sign(","));
    if (!sign(")")) throw Wrong{"a ) is missing"};
    const auto wants = [&](std::size_t count) {
      if (arguments.size() != count) throw Wrong{fmt::format("{}() takes {} of {}", name, count, arguments.size())};
    };
    const auto limited = [](std::int64_t value, std::int64_t to) {
      if (value < 0 || value > to) throw Wrong{fmt::format("{} is not from 0 to {}", value, to)};
      return static_cast<unsigned>(value);
    };
    if (name == "byte") {
      wants(1);
      return {0, fmt::format("{:02x}", limited(arguments[0], 0xFF))};
    }
    if (name == "word") {
      wants(1);
      const unsigned word = limited(arguments[0], 0xFFFF);
      return {0, fmt::format("{:02x} {:02x}", word >> 8, word & 0xFF)};
    }
    if (name == "bytes") {
      wants(2);
      std::string text;
      const std::string one = fmt::format("{:02x} ", limited(arguments[1], 0xFF));
      for (unsigned i = limited(arguments[0], 1024); i > 0; --i) text += one;
      return {0, text};
    }
    throw Wrong{fmt::format("there is no function '{}'; there are byte, word, bytes and has", stl::shortened(name))};
  }

  std::string_view rest_;
  const Parameters& parameters_;
  int depth_ = 0;
};

}  // namespace

std::optional<std::int64_t> parse_number(std::string_view text) {
  constexpr std::int64_t kLargest = 0xFFFF'FFFF;
  try {
    return parse_number(stl::trim(text), -kLargest, kLargest, "number");
  } catch (const std::invalid_argument&) {
    return {};
  }
}

Sides sides(std::string_view text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string_view::npos) return {stl::trim(text), {}, false};
  return {stl::trim(text.substr(0, dots)), stl::trim(text.substr(dots + 2)), true};
}

std::optional<Span> parse_span(std::string_view text) {
  Span span;
  for (;;) {
    const std::size_t plus = text.find('+');
    const std::string_view part = stl::trim(text.substr(0, plus));
    if (const auto characters = parse_characters(part)) {
      span.millicharacters += *characters;
    } else if (const auto time = part == "0" ? Time{0} : parse_duration(part)) {
      if (*time > kLongestSpan) return {};
      span.fixed += *time;
    } else {
      return {};
    }
    if (span.fixed > kLongestSpan || span.millicharacters > 1000 * static_cast<std::int64_t>(kMostCharacters)) return {};
    if (plus == std::string_view::npos) return span;
    text.remove_prefix(plus + 1);
  }
}

std::optional<Window> parse_window(std::string_view text, Time tolerance) {
  const Sides side = sides(text);
  Window window;
  if (side.range && side.from.empty() && side.to.empty()) return {};
  if (!side.from.empty() || !side.range) {
    const auto from = parse_span(side.from);
    if (!from) return {};
    window.from = *from;
  }
  if (!side.range) {
    window.to = window.from;
    window.from.fixed -= tolerance;
    window.to.fixed += tolerance;
  } else if (!side.to.empty()) {
    const auto to = parse_span(side.to);
    if (!to) return {};
    window.to = *to;
    const bool later = window.from.fixed > to->fixed || window.from.millicharacters > to->millicharacters;
    if (later && window.from.fixed >= to->fixed && window.from.millicharacters >= to->millicharacters) return {};
  }
  return window;
}

std::optional<Count> parse_count(std::string_view text) {
  const Sides side = sides(text);
  const auto from = parse_number(side.from);
  if (!from || *from < 0) return {};
  Count count{static_cast<std::uint64_t>(*from), static_cast<std::uint64_t>(*from)};
  if (!side.range) return count;
  count.to = UINT64_MAX;
  if (side.to.empty()) return count;
  const auto to = parse_number(side.to);
  if (!to || *to < *from) return {};
  count.to = static_cast<std::uint64_t>(*to);
  return count;
}

std::optional<std::vector<BytePattern>> parse_pattern(std::string_view text, std::string& why) {
  std::vector<BytePattern> pattern;
  while (!(text = stl::trim(text)).empty()) {
    if (pattern.size() == serial::kLongestRawFrame) {
      why = fmt::format("a frame has {} bytes at most", serial::kLongestRawFrame);
      return {};
    }
    if (take(text, "..")) {
      pattern.push_back(std::nullopt);
      continue;
    }
    const auto byte = serial::parse_hex_frame(text.substr(0, 2));
    if (!byte.ok()) {
      why = byte.errors[0].message + "; .. stands for any byte";
      return {};
    }
    pattern.push_back(byte.frame[0].byte);
    text.remove_prefix(2);
  }
  if (!pattern.empty()) return pattern;
  why = "at least one byte is needed; 'silence' stands for none";
  return {};
}

std::optional<std::string> evaluate(std::string_view expression, const Parameters& parameters, std::string& why) {
  try {
    return Calculation(expression, parameters).result();
  } catch (const Wrong& wrong) {
    why = wrong.why;
    return {};
  }
}

std::optional<bool> holds(std::string_view expression, const Parameters& parameters, std::string& why) {
  try {
    const std::string result = Calculation(expression, parameters).result();
    return !result.empty() && result != "0" && result != "no" && result != "false";
  } catch (const NoValue&) {
    return false;
  } catch (const Wrong& wrong) {
    why = wrong.why;
    return {};
  }
}

std::optional<std::string> substitute(std::string_view text, const Parameters& parameters, std::string& why) {
  if (text.size() > 3 && text.starts_with("${") && text.back() == '}' &&
      parameters.empty.contains(text.substr(2, text.size() - 3)))
    return std::string();
  std::string result;
  for (;;) {
    const std::size_t begin = text.find("${");
    result += text.substr(0, begin);
    if (result.size() > kLongestSubstitution) {
      why = fmt::format("what is put in is longer than {} characters", kLongestSubstitution);
      return {};
    }
    if (begin == std::string_view::npos) return result;
    const std::size_t end = text.find('}', begin);
    if (end == std::string_view::npos) {
      why = "the } of ${ is missing";
      return {};
    }
    const auto value = evaluate(text.substr(begin + 2, end - begin - 2), parameters, why);
    if (!value) return {};
    result += *value;
    text.remove_prefix(end + 1);
  }
}

}  // namespace s7200::tools
