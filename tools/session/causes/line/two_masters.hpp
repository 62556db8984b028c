// Masters that share a line: each takes for its answer whatever comes next.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// That there is one on the line of a PLC, when something is sent there; empty if there is none.
std::string other_master_text(const History& history, std::size_t station);

/// Whose request the master of `send` at a PLC has taken for its answer, or who has sent one into its answer; empty if
/// nobody has.
std::string not_an_answer_text(const History& history, std::size_t station, const serial::Exchange& exchange);

/// Whether it has taken the request of another master for its answer: no one has answered it.
bool took_a_request_for_its_answer(const History& history, std::size_t station, const serial::Exchange& exchange);

/// As not_an_answer_text() has it, of a wrong answer to a master that polls, in a line without its end.
std::string not_an_answer_text(const History& history, const Asker& asker, const std::vector<std::uint8_t>& answer);

}  // namespace s7200::tools
