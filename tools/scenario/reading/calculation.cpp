#include "tools/scenario/reading/calculation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "interpreter/base/text/text.hpp"
#include "tools/scenario/reading/text.hpp"

namespace s7200::tools {
namespace {

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
    if (!rest_.starts_with(which)) return false;
    rest_.remove_prefix(which.size());
    return true;
  }

  static std::int64_t number(const Value& value) {
    if (!value.text) return value.number;
    const auto parsed = parse_number(*value.text);
    if (!parsed) throw Wrong{fmt::format("'{}' is not a number", stl::shortened(*value.text))};
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
      if (!parsed) throw Wrong{fmt::format("'{}' is not a number", stl::shortened(word))};
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

Result<std::string> evaluate(std::string_view expression, const Parameters& parameters) {
  try {
    return Calculation(expression, parameters).result();
  } catch (const Wrong& wrong) {
    return Trouble{wrong.why};
  }
}

Result<bool> holds(std::string_view expression, const Parameters& parameters) {
  try {
    const std::string result = Calculation(expression, parameters).result();
    return !result.empty() && result != "0" && result != "no" && result != "false";
  } catch (const NoValue&) {
    return false;
  } catch (const Wrong& wrong) {
    return Trouble{wrong.why};
  }
}

Result<std::string> substitute(std::string_view text, const Parameters& parameters) {
  if (text.size() > 3 && text.starts_with("${") && text.back() == '}' &&
      parameters.empty.contains(text.substr(2, text.size() - 3)))
    return std::string();
  std::string result;
  for (;;) {
    const std::size_t begin = text.find("${");
    result += text.substr(0, begin);
    if (result.size() > kLongestSubstitution)
      return trouble("what is put in is longer than {} characters", kLongestSubstitution);
    if (begin == std::string_view::npos) return result;
    const std::size_t end = text.find('}', begin);
    if (end == std::string_view::npos) return Trouble{"the } of ${ is missing"};
    const auto value = evaluate(text.substr(begin + 2, end - begin - 2), parameters);
    if (!value) return value.trouble();
    result += *value;
    text.remove_prefix(end + 1);
  }
}

}  // namespace s7200::tools
