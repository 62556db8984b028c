// The words of a system file: what may be written where, and what it means. Its description is made of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "tools/yaml/yaml.hpp"

namespace s7200::tools {

/// The most stations of a whole system. A PLC with two ports and a sync signal takes three numbers of a rank, a master two;
/// a master that joins a line takes two more.
inline constexpr std::size_t kMostStations = kMostYamlKeys;

/// The range of a line's baud rate.
inline constexpr std::int64_t kLeastBaud = 50, kMostBaud = 1'000'000;

struct SystemKey {
  enum class Where : std::uint8_t { File, Plc, Line, Fault, Master, Poll, OtherPlc, Bridge, Event };
  Where where{};
  std::string_view key, form, meaning;
};
std::span<const SystemKey> system_keys();

/// The table as Markdown, for the description of the format.
std::string system_keys_markdown();

}  // namespace s7200::tools
