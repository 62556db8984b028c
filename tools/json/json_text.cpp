#include "tools/json/json_text.hpp"

#include <fmt/format.h>

#include <vector>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;

/// What has too much of something, or empty. Of a text that is JSON it counts right, and of no other does that matter.
std::string why_too_much(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.bytes) return fmt::format("longer than {} bytes", limits.bytes);
  std::vector<std::size_t> members;  // of each map or list that is open
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (quoted)
      continue;
    else if (c == '{' || c == '[')
      members.push_back(0);
    else if ((c == '}' || c == ']') && !members.empty())
      members.pop_back();
    else if (c == ':' && !members.empty())
      ++members.back();
    if (members.size() > limits.depth)
      return fmt::format("JSON of more than {} maps and lists inside each other", limits.depth);
    if (!members.empty() && members.back() > limits.members)
      return fmt::format("JSON with more than {} members in one map", limits.members);
  }
  return {};
}

}  // namespace

Result<Json> parse_json(std::string_view text, const JsonLimits& limits) {
  if (std::string why = why_too_much(text, limits); !why.empty()) return Trouble{std::move(why)};
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_discarded()) return json;
  return Trouble{"not JSON"};
}

std::string in_one_line(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string shown(const Json& value) { return stl::shortened(in_one_line(value)); }

}  // namespace s7200::tools
