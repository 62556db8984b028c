// `s7200 dap --listen`: editors on a TCP port, by the rules of tools/host/net/server_rules.hpp.
#pragma once

#include <atomic>
#include <string>

#include "tools/faces/dap/session.hpp"

namespace s7200::tools {

struct DapServer {
  std::string listen;        ///< as --listen has it
  std::string token_file{};  ///< its first line is the token; empty: a new one, which is printed
};

/// One client after the other, until an interruption. Returns how the command ends.
int serve_clients(const DapServer& server, const dap::SessionSettings& settings, std::atomic<bool>& stop_request);

}  // namespace s7200::tools
