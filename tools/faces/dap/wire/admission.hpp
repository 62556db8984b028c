// Who is let in where anyone of this computer can connect: tools/host/net/server_rules.hpp has the rules.
#pragma once

#include <atomic>
#include <string>
#include <string_view>

#include "tools/faces/dap/wire/messages.hpp"

namespace s7200::tools::dap {

/// Of one connection: the first request is `initialize`, and the launch or attach after it has the token.
class Admission {
 public:
  /// An empty token lets everyone in: an editor that has started the server itself.
  explicit Admission(std::string token) : token_(std::move(token)), open_(token_.empty()) {}

  /// Why the connection ends with this message; empty if the session may handle it.
  std::string judge(const Json& message);

  /// Whether the client has been let in, from any thread.
  bool is_open() const { return open_; }

 private:
  std::string token_;
  bool initialized_ = false;
  std::atomic<bool> open_;
};

/// Why a connection cannot become one of this protocol that begins with these bytes; empty as long as it can. A header
/// begins with `Content-Length:` or `Content-Type:`.
std::string why_not_our_protocol(std::string_view first_bytes);

}  // namespace s7200::tools::dap
