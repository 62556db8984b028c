// The keys of a PLC: what can be said of one before it runs. A row makes a key of system files and scenarios, an option of
// the verbs that run a program, an attribute of a launch in an editor, and a line of transcripts, help and tables.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/program/operands/address.hpp"
#include "tools/plan/plc_settings.hpp"

namespace s7200::tools {

/// What is wrong with a value, and what to write instead. Without a message nothing is.
struct WrongValueOfKey {
  std::string message{}, hint{};
};

struct PlcKey {
  enum class Shape : std::uint8_t {
    Value,
    Flag,
    List,
    Map,      ///< of an option several values, KEY=VALUE each
    Read,     ///< a file that is read
    Written,  ///< a file that one PLC alone writes
  };
  /// What has to be known before the key can be read.
  enum class Stage : std::uint8_t {
    Source,   ///< nothing: it says what the program is. Its reader has a place of its own
    Cpu,      ///< the CPU: the key is of the system block
    Program,  ///< the program with its symbols
  };
  enum class Group : std::uint8_t { More, Memory, Results };

  /// The option of the key, with dashes where the key has `_`.
  struct Option {
    std::string_view type{};  ///< empty: there is no such option, or its verb adds it; of a Flag the text alone counts
    std::string text{};       ///< what the help says
    Group group = Group::More;
    std::string_view needs{}, excludes{};  ///< other keys
  };

  using Take = WrongValueOfKey (*)(PlcSettings& settings, std::string_view text, const AddressSpace* space);
  using Text = std::string (*)(const PlcSettings& settings);

  std::string_view name;
  Stage stage{};
  Shape shape{};
  bool of_system = false, of_scenario = false;  ///< where it may stand
  std::string form{}, meaning{};                ///< in the tables of files
  std::string_view example{};                   ///< of a List and a Map
  Option option{};
  /// Fills in what one value says. `space` is null where the CPU and its program are not known yet: the value is checked
  /// then as far as it can be. A row without it is read elsewhere.
  Take take = nullptr;
  /// What the settings say, as a file has it; of files their paths. Empty: nothing, or what holds without the key.
  Text text = nullptr;

  bool is_option() const { return !option.text.empty(); }
};

/// The option of a key: `--clock-error` for `clock_error`.
std::string option_of(std::string_view key);

/// The rows in the order of the tables.
std::span<const PlcKey> plc_keys();

/// Whether what is said of a stage is anything else than what holds without any key.
bool says_anything(const PlcSettings& settings, PlcKey::Stage stage);

}  // namespace s7200::tools
