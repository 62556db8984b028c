#include "tools/host/listen_address.hpp"

#include <fmt/format.h>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "tools/host/sockets.hpp"

namespace s7200::tools {

std::optional<ListenAddress> parse_listen_address(const std::string& text, std::string& why) {
  ListenAddress address;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  std::string host = colon == std::string::npos ? "" : text.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
    if (!is_ip_address(host, IpVersion::Six)) why = fmt::format("'{}' is not an IPv6 address", stl::shortened(host));
  } else if (host.find(':') != std::string::npos) {
    why = fmt::format("write an IPv6 address in brackets, as [{}]:{}", host, port);
  } else if (!host.empty() && !is_ip_address(host, IpVersion::Four)) {
    why = fmt::format("'{}' is not an IP address", stl::shortened(host));
  }
  const auto number = parse_decimal<std::uint16_t>(port);
  if (why.empty() && !number) why = fmt::format("'{}' is not a port from 0 to 65535", stl::shortened(port));
  if (!why.empty()) return {};
  address.port = *number;
  if (!host.empty()) address.host = host;
  return address;
}

std::string to_text(const ListenAddress& address) {
  return address.host.find(':') == std::string::npos ? fmt::format("{}:{}", address.host, address.port)
                                                     : fmt::format("[{}]:{}", address.host, address.port);
}

}  // namespace s7200::tools
