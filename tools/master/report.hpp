// The results of the actions of `s7200 master`, as text, as a live table, and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "serial_sim/peers/requester.hpp"
#include "tools/master/protocol.hpp"

namespace s7200::tools {

/// The result of an action that sends something.
struct MasterResult {
  const MasterAction* action = nullptr;
  serial::Exchange exchange{};
  serial::Answer answer{};
  std::string remark{};  ///< Slave::remark
  int attempts = 1;
};

/// Checks an answer with all that is known of how it came: errors in its characters, and answers to broadcasts, which only
/// count as wrong where `broadcasts_are_silent`.
serial::Answer assess(const MasterAction& action, const serial::Exchange& exchange, bool broadcasts_are_silent);

/// The result in one line: `16#04D2 16#FFFB`, `exception 2: illegal data address`, `error 16#12: no session`, `no answer`.
std::string short_text(const MasterResult& result);

/// What was asked, and how long after the request the last answer began: `read 40011:2   station 1, function 3, holding
/// registers 10…11   12.3 ms`.
std::string heading(const MasterResult& result);

/// The result: a line for each value, with its address; or what is wrong.
std::vector<std::string> lines(const MasterResult& result);

/// Request and answer in hex.
std::string frames_text(const MasterResult& result);

nlohmann::ordered_json to_json(const MasterResult& result);

}  // namespace s7200::tools
