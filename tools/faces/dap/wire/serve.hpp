// A client on a stream, from its first message to its last.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

#include "tools/faces/dap/session.hpp"
#include "tools/host/files/input_stream.hpp"

namespace s7200::tools::dap {

/// False if nothing more can be written.
using Write = std::function<bool(std::string_view bytes)>;

/// Until the client disconnects, its stream ends, or `end` asks for it. `stop_request` is that of the settings. `token`:
/// what lets it in, as tools/host/net/server_rules.hpp says; empty for an editor that has started the server itself. Returns
/// what was wrong with the stream, after the words "the client" or "standard input"; empty if nothing was.
std::string serve(InputStream& in, const Write& write, const SessionSettings& settings, std::atomic<bool>& stop_request,
                  StopToken end, const std::string& token = {});

}  // namespace s7200::tools::dap
