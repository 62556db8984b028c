#include "serial_sim/westinghouse/plcs.hpp"

#include <algorithm>
#include <array>

#include "serial_sim/westinghouse/hppc_plc.hpp"
#include "serial_sim/westinghouse/lan_plc.hpp"
#include "serial_sim/westinghouse/loader_plc.hpp"
#include "serial_sim/westinghouse/modbus_plc.hpp"
#include "serial_sim/westinghouse/westnet_plc.hpp"

namespace s7200::westinghouse {
namespace {

constexpr std::string_view kModelSetting = "plc";

template <class Kind>
std::vector<std::string> settings_of() {
  const Kind bench;
  std::vector<std::string> lines;
  for (const Setting<Kind>& row : Kind::settings()) {
    const SettingForm& form = row.form;
    std::string values = value_text(form, row.get(bench));
    for (std::size_t i = 0; i < form.words.size(); ++i)
      if (i != row.get(bench)) values.append("|").append(form.words[i]);
    lines.push_back(fmt::format("  {:<37} {}{}\n", fmt::format("{}={}", form.name, values), form.meaning,
                                form.choice.empty() ? "" : fmt::format(" [{}]", form.choice)));
  }
  for (const Cells<Kind>& row : Kind::cells())
    lines.push_back(fmt::format("  {:<37} {}, in hex\n",
                                fmt::format("{}{}=VALUE,…", row.name, row.by_address ? "[ADDRESS]" : "NUMBER"),
                                row.meaning));
  return lines;
}

template <class Kind>
std::unique_ptr<Plc> make() {
  return std::make_unique<Kind>();
}

/// The words of its setting `plc`; without one it is the only model.
template <class Kind>
PlcRow row(std::string_view name, std::string_view only_model = "") {
  std::vector<std::string_view> models{only_model};
  for (const Setting<Kind>& row : Kind::settings())
    if (row.form.name == kModelSetting) models = row.form.words;
  return {name, std::move(models), make<Kind>, settings_of<Kind>};
}

const std::vector<PlcRow>& rows() {
  static const std::vector<PlcRow> kRows{
      row<ModbusPlc>("modbus"),     row<LanPlc>("pc1000-lan"),
      row<WestnetPlc>("westnet"),   row<LoaderPlc>("pc500-loader", "pc503"),
      row<HppcPlc>("hppc", "hppc"),
  };
  return kRows;
}

}  // namespace

std::span<const PlcRow> plcs() { return rows(); }

const PlcRow* find_plc(std::string_view protocol) {
  const auto found = std::ranges::find(rows(), protocol, &PlcRow::name);
  return found == rows().end() ? nullptr : &*found;
}

Result<std::unique_ptr<Plc>> make_plc(const PlcRow& row, std::string_view model) {
  if (std::ranges::find(row.models, model) == row.models.end())
    return trouble("'{}' is not a PLC that speaks {} here; there {} {}", stl::shortened(model), row.name,
                   row.models.size() == 1 ? "is" : "are", fmt::join(row.models, ", "));
  std::unique_ptr<Plc> plc = row.make();
  if (row.models.size() == 1) return plc;
  if (const auto done = plc->set(fmt::format("{}={}", kModelSetting, model)); !done) return done.trouble();
  return plc;
}

std::string settings_help(const PlcRow& row) {
  std::string text;
  for (const std::string& line : row.settings()) text += line;
  return text;
}

}  // namespace s7200::westinghouse
