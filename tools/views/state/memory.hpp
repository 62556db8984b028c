// Memory on the command line: setting it before a run, showing it afterwards.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/program/operands/address.hpp"
#include "serial_sim/system/simulation.hpp"

namespace s7200::tools {

/// I addresses set the input points, everything else is written as a programming device would.
void assign(Cpu& cpu, const Assignment& assignment);

/// The assignments that give the inputs of `cpu` the levels that they had in `before`, since the field still drives them so.
std::vector<Assignment> inputs_as_before(const Cpu& cpu, const State& before);

/// An assigned value in hex, with the digits of its width: `16#0005`.
std::string hex_text(const Assignment& assignment);

/// Lines `VW100  16#0005      5`: hex and decimal for each object, bytes sixteen a line with their characters. A double word
/// that the program uses as a real is shown as one too.
std::string dump_text(const Cpu& cpu, const MemoryRange& range);

/// `bit`, `byte`, `word`, `dword` or `real`
std::string_view type_of(const MemoryRange& range);

/// Object `i` of a range: its bits, right-aligned.
std::uint32_t bits_at(const State& state, const MemoryRange& range, std::uint32_t i);

/// Object `i` of a range as instructions of its width take it: bytes without a sign, words and double words with one.
double number_at(const State& state, const MemoryRange& range, std::uint32_t i);
nlohmann::ordered_json value_json(const State& state, const MemoryRange& range, std::uint32_t i);

/// A memory range as JSON: {"type": "word", "hex": "0005", "values": [5]}
nlohmann::ordered_json dump_json(const Cpu& cpu, const MemoryRange& range);

}  // namespace s7200::tools
