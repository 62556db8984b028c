// The common part of the simulated PLCs of this family: texts set and check them.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/peers/automaton.hpp"
#include "serial_sim/westinghouse/setting.hpp"

namespace s7200::westinghouse {

class Plc : public serial::Automaton {
 public:
  /// A setting, or cells of memory: `key=modify`, `HR1=1234,0001`. Trouble for anything else.
  virtual Result<> set(std::string_view text) = 0;

  /// Whether such a text is about cells. Cells are to be set last: the place of some depends on settings.
  virtual bool names_cells(std::string_view text) const = 0;

  /// Whether a master reaches the cells that such a text sets, with the PLC's present settings. Trouble if it does not. A
  /// setting has no cells.
  virtual Result<> still_reaches(std::string_view text) const = 0;

  /// Whether the PLC has the values of such a text. Trouble if it does not.
  virtual Result<> holds(std::string_view text) const = 0;

  /// Whether the PLC hears only with a sync signal beside the data.
  virtual bool needs_sync() const { return false; }

  bool operator==(const Plc&) const = default;

 protected:
  Plc() = default;
  Plc(const Plc&) = default;
  Plc& operator=(const Plc&) = default;

  /// Sends `reply`, or nothing if it is empty.
  void answer_or_be_silent(Bytes reply, Time at) {
    if (!reply.empty()) answer(std::move(reply), at);
  }
};

/// The line as settings: `baud`, `parity`, `data_bits`, `stop_bits`. `line` is a member of the PLC.
template <class Self, class Line>
void add_line_settings(std::vector<Setting<Self>>& rows, std::string_view choice, Line line) {
  using enum SettingForm::Notation;
  const auto add = [&](SettingForm form, auto member) { rows.push_back(setting_of<Self>(std::move(form), line, member)); };
  add({"baud", choice, "rate of its port", Decimal, {}, 50, 1'000'000}, &SerialFormat::baud);
  add({"parity", choice, "parity of its characters", Word, {kParityWords.begin(), kParityWords.end()}},
      &SerialFormat::parity);
  add({"data_bits", choice, "data bits of a character", Decimal, {}, 7, 8}, &SerialFormat::data_bits);
  add({"stop_bits", choice, "stop bits of a character", Decimal, {}, 1, 2}, &SerialFormat::stop_bits);
}

/// The texts of a PLC `Self`, which has `static const std::vector<Setting<Self>>& settings()`, `static const
/// std::vector<Cells<Self>>& cells()`, and ==.
template <class Self>
class PlcOf : public Plc {
 public:
  std::unique_ptr<serial::Automaton> clone() const final { return std::make_unique<Self>(self()); }
  bool equals(const serial::Automaton& other) const final {
    const auto* const same_kind = dynamic_cast<const Self*>(&other);
    return same_kind != nullptr && *same_kind == self();
  }

  Result<> set(std::string_view text) final {
    if (const auto cells = parse_cells(text)) {
      const auto [row, fault] = find(*cells);
      if (!fault.empty()) return Trouble{fault};
      if (row != nullptr) {
        if (const auto done = are_there(*row, *cells); !done) return done.trouble();
        std::uint32_t place = cells->first;
        for (const std::uint32_t value : cells->values) row->write(self(), place++, value);
        return {};
      }
    }
    const Setting<Self>* setting = nullptr;
    const auto value = parse(text, setting);
    if (!value) return value.trouble();
    setting->set(self(), *value);
    return {};
  }

  bool names_cells(std::string_view text) const final {
    const auto cells = parse_cells(text);
    return cells && find(*cells).row != nullptr;
  }

  Result<> still_reaches(std::string_view text) const final {
    const auto cells = parse_cells(text);
    const Found found = cells ? find(*cells) : Found{};
    return found.row == nullptr ? Result<>() : are_there(*found.row, *cells);
  }

  Result<> holds(std::string_view text) const final {
    if (const auto cells = parse_cells(text)) {
      const auto [row, fault] = find(*cells);
      if (!fault.empty()) return Trouble{fault};
      if (row != nullptr) {
        std::string other;
        std::uint32_t place = cells->first;
        for (const std::uint32_t value : cells->values) {
          const std::uint32_t found = row->read(self(), place);
          if (found != value) other += fmt::format("{} {:X} holds {:X}, not {:X}; ", row->name, place, found, value);
          ++place;
        }
        if (!other.empty()) return Trouble{other};
        return {};
      }
    }
    const Setting<Self>* setting = nullptr;
    const auto value = parse(text, setting);
    if (!value) return value.trouble();
    const std::uint32_t found = setting->get(self());
    if (found != *value) return trouble("{} is {}", setting->form.name, value_text(setting->form, found));
    return {};
  }

  bool operator==(const PlcOf&) const = default;

 private:
  Self& self() { return static_cast<Self&>(*this); }
  const Self& self() const { return static_cast<const Self&>(*this); }

  struct Found {
    const Cells<Self>* row = nullptr;  ///< null if there are none of this name
    std::string fault{};               ///< why they do not take the values
  };
  static Found find(const CellsText& text) {
    for (const Cells<Self>& row : Self::cells()) {
      if (row.name != text.name || row.by_address != text.by_address) continue;
      const bool inside =
          text.first >= row.least && text.first <= row.most && text.values.size() <= row.most - text.first + 1;
      if (!inside)
        return {&row, row.by_address ? fmt::format("{}: addresses are from {:X} to {:X}", row.name, row.least, row.most)
                                     : fmt::format("{}: numbers are from {} to {}", row.name, row.least, row.most)};
      for (const std::uint32_t value : text.values)
        if (value > row.largest) return {&row, fmt::format("{}: {:X} is more than {:X}", row.name, value, row.largest)};
      return {&row};
    }
    return {};
  }

  /// Whether a master reaches these cells.
  Result<> are_there(const Cells<Self>& row, const CellsText& text) const {
    if (!row.last) return {};
    const std::uint32_t last = row.last(self());
    const std::size_t end = text.first - 1 + text.values.size();
    if (end <= last) return {};
    return trouble("{0}{1} is not there: {2}={3}; set {2}={1} or more before it", row.name, end, row.last_from, last);
  }

  static Result<std::uint32_t> parse(std::string_view text, const Setting<Self>*& setting) {
    const std::size_t equals = text.find('=');
    const std::string_view name = text.substr(0, equals);
    for (const Setting<Self>& row : Self::settings())
      if (equals != std::string_view::npos && row.form.name == name) {
        setting = &row;
        return parse_value(row.form, text.substr(equals + 1));
      }
    const auto name_of = [](const Setting<Self>& row) { return row.form.name; };
    const auto cell_of = [](const Cells<Self>& row) {
      return fmt::format("{}{}", row.name, row.by_address ? "[ADDRESS]" : "NUMBER");
    };
    const auto cells = parse_cells(fmt::format("{}=0", name));
    if (cells && find(*cells).row != nullptr)
      return trouble("'{0}': cells take hexadecimal values with commas between; write for example {1}=12 or {1}=12,34",
                     stl::shortened(text), name);
    return trouble("'{}' is not a setting of this PLC; there are {}, {}", stl::shortened(text),
                   stl::joined(Self::settings(), name_of), stl::joined(Self::cells(), cell_of));
  }
};

}  // namespace s7200::westinghouse
