#include "tools/faces/dap/wire/admission.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/host/net/server_rules.hpp"

namespace s7200::tools::dap {

std::string Admission::judge(const Json& message) {
  if (open_) return {};
  const std::string command = text_in(message, "type") == "request" ? text_in(message, "command") : "";
  if (!initialized_ && command != "initialize")
    return fmt::format("the first message is not the request initialize, but {}", shown(message));
  initialized_ = true;
  if (command != "launch" && command != "attach") return {};
  const Json arguments = object_in(message, "arguments");
  const std::string given = text_in(arguments, "token");
  if (given.empty())
    return fmt::format("{} has no token; the server prints it: write \"token\": \"…\" beside \"program\" or \"port\"",
                       command);
  if (!is_same_token(given, token_))
    return fmt::format("the token of {} is wrong; the server prints the right one", command);
  open_ = true;
  return {};
}

std::string why_not_our_protocol(std::string_view first_bytes) {
  constexpr std::string_view kBeginnings[] = {"CONTENT-LENGTH:", "CONTENT-TYPE:"};
  const bool can_become_one = std::ranges::any_of(kBeginnings, [&](std::string_view header) {
    const std::size_t count = std::min(header.size(), first_bytes.size());
    return stl::upper_case(first_bytes.substr(0, count)) == header.substr(0, count);
  });
  if (can_become_one) return {};
  if (is_web_request(first_bytes)) return std::string(kWebRequest);
  return fmt::format("it began with '{}', which is not the Debug Adapter Protocol",
                     stl::shortened(first_bytes.substr(0, first_bytes.find_first_of("\r\n"))));
}

}  // namespace s7200::tools::dap
