// `s7200 view`: a session on a local web page, for all windows that show it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tools/faces/page/conversation.hpp"
#include "tools/host/net/tcp_listener.hpp"

namespace s7200::tools::page {

struct PageServer {
  std::unique_ptr<TcpListener> listener{};
  std::string token{};
  std::function<void(const std::string& address)> ready{};  ///< is told where the page is, when it is there
  /// Is told what there is to say of clients; called from a thread of the server's own.
  std::function<void(const std::string& note)> note{};
};

/// Flags that the session's runs look at; they live as long as it does.
struct PageFlags {
  std::atomic<bool> stop = false;   ///< ends what goes on
  std::atomic<bool> pause = false;  ///< ends a run that follows the clock
};

/// Serves until an interruption, or until a client has said `quit`. `when_saying` is given who takes notes of bridges and
/// masters. `settings` come without what the server itself adds: flags, clock and who carries out.
void serve(PageServer server, History& history, PageSettings settings, PageFlags& flags,
           const std::function<void(std::function<void(const std::string&)> say)>& when_saying);

}  // namespace s7200::tools::page
