// A program as JSON: its outline, and the lines of its text with what stands in them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "tools/views/program/listing.hpp"

namespace s7200::tools {

/// Names, routines with their networks, and symbols: {"program": …, "routines": [{"name": "SBR 51", "networks": [{"number":
/// 6, "title": …, "first": 40, "end": 52}]}]}. A program without NETWORK lines has a network for each rung.
nlohmann::ordered_json outline_json(const Program& program, const Listing& listing);

/// The lines `from` to `to` of the text, counted from 1: [{"line": 12, "text": …, "op": 5, "mnemonic": "LD", "kind":
/// "contact", "operands": [{"text": "Start", "address": "I0.0", "symbol": "Start", "pointer": false}]}].
nlohmann::ordered_json lines_json(const Program& program, std::uint32_t from, std::uint32_t to);

}  // namespace s7200::tools
