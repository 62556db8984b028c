#include "interpreter/base/listen_address.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200 {
namespace {

/// The number of groups of 16 bits that a row of them has, with `:` between them; an IPv4 address at its end is two. Nothing
/// if it is no such row.
std::optional<std::size_t> groups_in(std::string_view row) {
  std::size_t groups = 0;
  while (!row.empty()) {
    const std::size_t colon = row.find(':');
    const std::string_view group = row.substr(0, colon);
    if (colon == std::string_view::npos && is_ipv4_address(group)) return groups + 2;
    const bool hex = std::ranges::all_of(group, [](char c) { return hex_digit(c).has_value(); });
    if (group.empty() || group.size() > 4 || !hex) return {};
    ++groups;
    if (colon == std::string_view::npos) return groups;
    row.remove_prefix(colon + 1);
    if (row.empty()) return {};
  }
  return groups;
}

}  // namespace

bool is_ipv4_address(std::string_view text) {
  for (int number = 0; number < 4; ++number) {
    const std::size_t end = std::min(text.find('.'), text.size());
    const std::string_view digits = text.substr(0, end);
    if (!parse_decimal<std::uint8_t>(digits) || (digits.size() > 1 && digits.front() == '0')) return false;
    if (number == 3) return end == text.size();
    if (end == text.size()) return false;
    text.remove_prefix(end + 1);
  }
  return false;
}

bool is_ipv6_address(std::string_view text) {
  const std::size_t left_out = text.find("::");
  if (left_out == std::string_view::npos) return groups_in(text) == 8;
  const std::string_view front = text.substr(0, left_out);
  const auto before = groups_in(front), after = groups_in(text.substr(left_out + 2));
  return before && after && *before + *after < 8 && front.find('.') == std::string_view::npos;
}

Result<ListenAddress> parse_listen_address(const std::string& text) {
  ListenAddress address;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  std::string host = colon == std::string::npos ? "" : text.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
    if (!is_ipv6_address(host)) return trouble("'{}' is not an IPv6 address", stl::shortened(host));
  } else if (host.find(':') != std::string::npos) {
    return trouble("write an IPv6 address in brackets, as [{}]:{}", host, port);
  } else if (stl::lower_case(host) == "localhost") {
    host.clear();
  } else if (!host.empty() && !is_ipv4_address(host)) {
    return trouble("'{}' is not an IP address", stl::shortened(host));
  }
  const auto number = parse_decimal<std::uint16_t>(port);
  if (!number) return trouble("'{}' is not a port from 0 to 65535", stl::shortened(port));
  address.port = *number;
  if (!host.empty()) address.host = host;
  return address;
}

std::string to_text(const ListenAddress& address) {
  return address.host.find(':') == std::string::npos ? fmt::format("{}:{}", address.host, address.port)
                                                     : fmt::format("[{}]:{}", address.host, address.port);
}

}  // namespace s7200
