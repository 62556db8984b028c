// References to memory and to instructions, as messages carry them. Memory is referred to by an area or an address as in
// STL, `V`, `VB100`, or by a number: where it is among all areas. What an open routine has of its own is above them: its
// logic stack, `stack` and `stack:1` by the routine's number from the innermost, and the accumulators that an interrupted
// one will find again, `AC:1`. Instructions have numbers above those.
//
// Of a system, references to the first station are the same; those to another one have its number: `VB100@2` is of the third
// one, and numbers of it are higher by two times kOfAStation.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/cpu/state.hpp"
#include "interpreter/program/program.hpp"

namespace s7200::tools::dap {

inline constexpr std::uint32_t kMostOpen = 32;  ///< routines; the CPU has fewer

/// Whose memory it is: everyone's, or an open routine's.
enum class Owner : std::uint8_t { All, LogicStack, SavedAccumulators };

/// A place in an area that this CPU has, or in what an open routine has. An offset may lead out of it.
struct MemoryPlace {
  std::uint32_t at = 0;              ///< in the image, or above it
  std::uint32_t begin = 0, end = 0;  ///< of its area
  Owner owner = Owner::All;
  std::uint32_t open = 0;  ///< number of the routine from the innermost
};

/// Nothing for what this CPU has not.
std::optional<MemoryPlace> find_memory(std::string_view reference, const Program& program);

/// From its begin to its end; a byte for each level of a logic stack, S0 first. Nothing of a routine that is not open.
std::vector<std::uint8_t> bytes_of(const MemoryPlace& place, const State& state);

/// `stack`, `stack:1`
std::string stack_reference(std::uint32_t open);
/// `AC`, or `AC:1` of a routine that is interrupted.
std::string accumulators_reference(std::uint32_t open, bool interrupted);
/// A level of the logic stack, by its number.
std::string level_reference(std::uint32_t open, std::uint32_t level);

/// From the numbers of one station to those of the next.
inline constexpr std::int64_t kOfAStation = std::int64_t{1} << 32;

/// `VB100@2`, or a number.
std::string at_station(const std::string& reference, std::size_t station);

struct StationReference {
  std::size_t station = 0;
  std::string reference{};  ///< without the station
};
/// Nothing if there is no such station among so many.
std::optional<StationReference> find_station(std::string_view reference, std::size_t stations);

std::string instruction_reference(std::int64_t op);
std::optional<std::int64_t> find_instruction_number(std::string_view reference);

/// `0x00000ABC`
std::string address_text(std::int64_t address);

}  // namespace s7200::tools::dap
