// An address to listen at: `502`, `:502`, `0.0.0.0:502`, `[::1]:502`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"

namespace s7200 {

struct ListenAddress {
  std::string host = "127.0.0.1";  ///< an IP address; this computer alone, if none is written
  std::uint16_t port = 0;          ///< 0: a free one
};

/// Whether a text is four numbers below 256 with dots between them, or an IPv6 address, without brackets (RFC 4291, 2.2).
bool is_ipv4_address(std::string_view text);
bool is_ipv6_address(std::string_view text);

/// Trouble for anything else.
Result<ListenAddress> parse_listen_address(const std::string& text);

/// An address as text: `127.0.0.1:502`, `[::1]:502`
std::string to_text(const ListenAddress& address);

}  // namespace s7200
