#include "tools/command/debugging/dap_server.hpp"

#include <fmt/format.h>

#include "tools/command/debugging/server_token.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/faces/dap/wire/serve.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/net/tcp_listener.hpp"

namespace s7200::tools {
int serve_clients(const DapServer& server, const dap::SessionSettings& settings, std::atomic<bool>& stop_request) {
  const std::string token = server_token(server.token_file);
  if (token.empty()) return kUnusable;
  const auto opened = parse_listen_address(server.listen).and_then(TcpListener::open);
  if (!opened) return print_error(fmt::format("--listen {}: {}", server.listen, opened.why())), kUnusable;
  TcpListener& listener = **opened;
  catch_interruption();
  fmt::print(stderr, "listening on {}, for clients with {}\n", to_text(listener.address()),
             server.token_file.empty() ? fmt::format("\"token\": \"{}\"", token) : "the token of --token-file");
  while (!interrupted()) {
    const auto client = listener.accept();
    if (!client && !interrupted())
      return print_error(fmt::format("--listen {}: {}", server.listen, client.why())), kUnusable;
    if (!client) break;
    const auto write = [&client](std::string_view bytes) { return (*client)->send(bytes); };
    const std::string wrong = dap::serve(**client, write, settings, stop_request, interruption(), token);
    if (!wrong.empty()) print_note(fmt::format("a client {}", wrong));
  }
  return kFine;
}

}  // namespace s7200::tools
