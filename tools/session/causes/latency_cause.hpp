// What an answer waited for between the end of its request and its first start bit.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "serial_sim/peers/requester.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// Of an exchange on the line of a station, played from the request on; the history stands where it stood. A line for each
/// wait in its order: the interrupt queue, what the routine or the scan did until XMT, a timed interrupt, the delay of XMT.
/// No lines: none of the PLCs on the line has sent the answer. Nothing after a stop request.
std::optional<std::vector<std::string>> latency_cause(History& history, std::size_t station,
                                                      const serial::Exchange& exchange, StopToken stop_request);

}  // namespace s7200::tools
