// What differs between two programs as they are written.
//
// What the CPU gets are instructions, the data block, the settings. Symbols, titles and comments are only for people: a
// renamed symbol changes no instruction, and an instruction with the same symbols that touches another address is changed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/compare/matching.hpp"
#include "tools/compare/networks.hpp"

namespace s7200::tools {

/// A row of a changed network: an instruction of the old program, of the new one, or both.
struct InstructionRow {
  std::optional<std::uint32_t> older, newer;
  bool same = false;          ///< for the CPU
  bool same_symbols = false;  ///< of two that differ: they look the same in symbols
};

struct NetworkChange {
  NetworkMatch match;
  bool comments_differ = false;
  std::vector<InstructionRow> rows{};  ///< of one that has changed
};

struct SymbolChange {
  enum class What : std::uint8_t { Renamed, Moved, Added, Removed, Comment };
  What what{};
  const stl::Symbol* older = nullptr;  ///< null: there is none
  const stl::Symbol* newer = nullptr;
};

/// Bytes of V memory that the two data blocks set differently.
struct DataChange {
  std::uint32_t offset = 0;
  std::vector<std::optional<std::uint8_t>> older, newer;  ///< of the same length; nothing: a data block does not set it
};

/// An interrupt event whose routines are others.
struct EventChange {
  std::uint8_t event = 0;
  std::vector<std::string> older, newer;  ///< routines that are attached somewhere: `INT_0`
};

struct SettingChange {
  std::string setting, older, newer;
};

struct StructureDifference {
  std::vector<ComparedNetwork> older, newer;
  std::vector<NetworkChange> networks;  ///< all of them
  std::vector<SymbolChange> symbols;
  std::vector<DataChange> data;
  std::vector<EventChange> events;
  std::vector<SettingChange> settings;

  /// Whether the CPU gets the same.
  bool same_for_the_cpu() const;
  /// Whether people read the same as well.
  bool same_for_people() const;
  /// The number of networks that `is` holds for.
  template <class Is>
  std::size_t count(Is is) const {
    return static_cast<std::size_t>(std::count_if(networks.begin(), networks.end(), is));
  }
};

/// Programs with errors are compared as far as they are known. Both must live as long as what is returned.
StructureDifference structure_difference(const Inspection& older, const Inspection& newer);

/// The lines of a report, and the same for machines: `networks`, `symbols`, `data`, `interrupts`, `settings`.
std::string structure_text(const Inspection& older, const Inspection& newer, const StructureDifference& difference);
nlohmann::ordered_json structure_json(const Inspection& older, const Inspection& newer,
                                      const StructureDifference& difference);

}  // namespace s7200::tools
