// `${…}`: parameters, and calculations with them.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"

namespace s7200::tools {

/// Named values. A list L of a, b has its elements in `lists`, and 1 as L.a and L.b.
struct Parameters {
  std::map<std::string, std::string, std::less<>> values{};
  std::map<std::string, std::vector<std::string>, std::less<>> lists{};
  std::set<std::string, std::less<>> empty{};  ///< have no value
};

/// Puts values in the place of each `${…}`. Inside stands the name of a parameter, or a calculation with whole numbers:
/// + - * / % < <= > >= = != and parentheses, the functions byte(x), word(x) and bytes(n, x), which give hex: `0a`, `00 0a`,
/// and n bytes x, and has(NAME): 1 for a parameter with a value. Trouble if it cannot be done. A
/// text that is `${NAME}` of a parameter without a value becomes empty.
Result<std::string> substitute(std::string_view text, const Parameters& parameters);

/// What stands inside `${…}`.
Result<std::string> evaluate(std::string_view expression, const Parameters& parameters);

/// Whether a calculation comes to anything but 0. A parameter without a value makes it false.
Result<bool> holds(std::string_view expression, const Parameters& parameters);

inline constexpr std::size_t kLongestSubstitution = 16 * 1024;  ///< characters of one text

}  // namespace s7200::tools
