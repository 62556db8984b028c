// The words of a system file: what may be written where, and what it means. Its description is made of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace s7200::tools {

struct SystemKey {
  enum class Where : std::uint8_t { File, Plc, Line, Fault, Master, Poll, OtherPlc, Bridge, Event };
  Where where{};
  std::string_view key, form, meaning;
};
std::span<const SystemKey> system_keys();

/// The table as Markdown, for the description of the format.
std::string system_keys_markdown();

}  // namespace s7200::tools
