#include "tools/rig/system_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "interpreter/program/load.hpp"
#include "tools/rig/event_reader.hpp"
#include "tools/rig/line_reader.hpp"
#include "tools/rig/peer_reader.hpp"
#include "tools/rig/plc_reader.hpp"
#include "tools/rig/system_reading.hpp"

namespace s7200::tools {
namespace {

/// Of a PLC one port is enough.
void check_all_are_on_lines(SystemReading& reading) {
  const SystemPlan& plan = reading.file.plan;
  const SystemNames& names = reading.names;
  const auto check = [&](const YamlNode& key, const std::string& name, bool on_a_line) {
    if (!on_a_line) reading.values.wrong(key, fmt::format("'{}' is on no line", name), "name it in the 'stations' of one");
  };
  for (std::size_t plc = 0; plc < plan.plcs.size(); ++plc)
    check(*names.plc_keys[plc], plan.plcs[plc].name,
          on_a_line({StationPlan::Kind::Plc, plc, 0}, plan) || on_a_line({StationPlan::Kind::Plc, plc, 1}, plan));
  for (const auto& [name, station] : names.others) check(*station.key, name, on_a_line(station.plan, plan));
}

void read_file(const YamlNode& root, SystemReading& reading) {
  YamlValues& values = reading.values;
  SystemPlan& plan = reading.file.plan;
  if (!root.is_map())
    return values.wrong(root, "a system file is a map, not " + to_text(root), "begin with 'plcs:' and 'lines:'");
  check_keys(root, {SystemKey::Where::File}, values);
  read_plcs(root, reading);
  read_peers(root, reading);
  read_bridges(root, reading);
  read_lines(root, reading);
  if (plan.lines.empty() && values.complaints.count() == 0)
    values.wrong(root, "no line: no one would hear another", "write for example lines: {bus: {stations: [master, slave]}}");
  if (values.complaints.count() == 0)
    for (const YamlNode* node : items_of(root, "events", "{at: 1s, power_off: slave}", values))
      if (auto event = read_timed_event(*node, plan, values)) plan.events.push_back(std::move(*event));
  std::ranges::stable_sort(plan.events, {}, &EventPlan::at);
  if (values.complaints.count() == 0) check_all_are_on_lines(reading);
}

}  // namespace

bool is_system_file(std::string_view path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

SystemFile read_system(const std::string& text, const std::string& path) {
  SystemFile file;
  file.file.source = source_of(text, path);
  stl::Diagnostics& diagnostics = file.file.diagnostics;
  const auto root = read_yaml(text, *file.file.source, diagnostics, {"a system file", "'plcs:' and 'lines:'"});
  YamlValues values(diagnostics);
  SystemReading reading{file, path, values};
  if (root) read_file(*root, reading);
  stl::sort(diagnostics);
  return file;
}

}  // namespace s7200::tools
