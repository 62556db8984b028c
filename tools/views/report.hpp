// How a run ended, in words and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "serial_sim/system/simulation.hpp"

namespace s7200::tools {

/// Run-time and fatal errors, one line each with place and meaning; empty when there were none.
std::string errors_text(const Cpu& cpu);
nlohmann::ordered_json errors_json(const Cpu& cpu);

/// Why the CPU is in STOP: `CPU in STOP, scan watchdog (fatal error 0003)`; empty in RUN.
std::string stop_text(const Cpu& cpu);

/// The number of run-time errors at other places than those listed: State keeps the first sixteen.
std::uint64_t errors_not_listed(const Cpu& cpu);

/// A note for arguments that are probably one frame whose blanks have torn it apart: several, a single byte among them.
/// Empty if they are not.
std::string torn_frame_note(const std::vector<std::string>& frames);

/// A note for frames without an answer that would be Modbus requests if they had their CRC. Empty if none is such a frame.
std::string missing_crc_note(const std::vector<serial::Frame>& frames);

/// A note for frames without an answer that are requests of Modbus TCP: the frame to send instead. Empty if none is one.
std::string modbus_tcp_note(const std::vector<serial::Frame>& frames);

/// Request, answer with its latency, and what the answer says.
std::string exchange_text(const serial::Exchange& exchange, Time timeout);

/// Marks an answer that is a Modbus request: a program that is a master itself has sent it.
void mark_request_of_another(serial::Exchange& exchange);

/// Whether an answer cannot be relied on: characters of it were damaged, it was cut off, or its CRC is wrong although that
/// of the request was right. A program that knows no CRC is not expected to send one.
bool is_damaged(const serial::Exchange& exchange);

/// An exchange as JSON; `unasked` are the bytes that came before it.
nlohmann::ordered_json exchange_json(const serial::Exchange& exchange, const Bytes& unasked);

/// Bytes that came before a request and were not asked for; empty if there were none.
std::string unasked_text(const Bytes& bytes);

/// Bytes in `lower-case hex without blanks`.
std::string plain_hex(std::span<const std::uint8_t> bytes);

}  // namespace s7200::tools
