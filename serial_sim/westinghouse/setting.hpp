// Settings of a simulated PLC, as texts: `key=modify`, `slave=01`, `HR1=1234,0001`, `W[4000]=0BB8`.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/serial_format.hpp"

namespace s7200::westinghouse {

inline constexpr std::uint32_t kNowhere = UINT32_MAX;  ///< a drop that is not given

/// A setting's values as texts.
struct SettingForm {
  enum class Notation : std::uint8_t {
    Word,  ///< one of `words`
    Decimal,
    Hex,
    Drop,        ///< highway, drop and subdrop, in hex: `00.11.00`
    DropOrNone,  ///< a drop; empty for none
  };

  std::string_view name;
  std::string_view choice;   ///< `L7` in the reference; empty where the document leaves no choice
  std::string_view meaning;  ///< for the help
  Notation notation = Notation::Hex;
  std::vector<std::string_view> words{};
  std::uint32_t least = 0, most = UINT8_MAX;
};

/// Trouble for what is not a value of the setting.
Result<std::uint32_t> parse_value(const SettingForm& form, std::string_view text);

std::string value_text(const SettingForm& form, std::uint32_t value);

/// A setting of a PLC, or a part of its state that can be set.
template <class Plc>
struct Setting {
  SettingForm form;
  std::function<std::uint32_t(const Plc&)> get;
  std::function<void(Plc&, std::uint32_t)> set;
};

/// A setting `part(plc).*member`: a number, or an enumeration in the order of the words.
template <class Plc, class Part, class Member>
Setting<Plc> setting_of(SettingForm form, Part part, Member member) {
  using Value = std::remove_cvref_t<decltype(part(std::declval<Plc&>()).*member)>;
  return {std::move(form), [=](const Plc& plc) { return static_cast<std::uint32_t>(part(plc).*member); },
          [=](Plc& plc, std::uint32_t value) { part(plc).*member = static_cast<Value>(value); }};
}

/// A kind of cells in a PLC's memory, which texts name.
template <class Plc>
struct Cells {
  std::string_view name;      ///< `HR`, `W`
  bool by_address;            ///< `W[4000]`, in hex; else by number in decimal: `HR1`
  std::uint32_t least, most;  ///< addresses or numbers
  std::uint32_t largest;      ///< value
  std::string_view meaning;
  std::function<std::uint32_t(const Plc&, std::uint32_t)> read;
  std::function<void(Plc&, std::uint32_t, std::uint32_t)> write;
  /// The last number that can be set, as the PLC is set by then, and the setting that says so. Left out: `most`.
  std::function<std::uint32_t(const Plc&)> last{};
  std::string_view last_from{};
};

/// A text such as `W[4000]=0BB8,00FF`, taken apart.
struct CellsText {
  std::string name;
  bool by_address = false;
  std::uint32_t first = 0;
  std::vector<std::uint32_t> values{};  ///< in hex
};

/// Returns nothing if the text does not name a cell.
std::optional<CellsText> parse_cells(std::string_view text);

}  // namespace s7200::westinghouse
