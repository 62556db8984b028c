#include "tools/plan/reading/system_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "interpreter/base/diagnostic.hpp"
#include "tools/plan/reading/event_reader.hpp"
#include "tools/plan/reading/line_reader.hpp"
#include "tools/plan/reading/peer_reader.hpp"
#include "tools/plan/reading/plc_reader.hpp"
#include "tools/plan/reading/system_reading.hpp"
#include "tools/plan/system_check.hpp"

namespace s7200::tools {
namespace {

void read_file(const YamlNode& root, SystemReading& reading) {
  YamlValues& values = reading.values;
  SystemPlan& plan = reading.file.plan;
  if (!root.is_map())
    return values.wrong(root, "a system file is a map, not " + to_text(root), "begin with 'plcs:' and 'lines:'");
  for (const char* const key : {"scenarios", "steps"})
    if (const YamlNode* const of_scenario = root.find(key); of_scenario && !root.find("lines"))
      return values.wrong(*of_scenario, fmt::format("'{}' is of a scenario, and this is to be a system file", key),
                          "'s7200 test' runs it; a scenario names its system with 'system:'");
  check_keys(root, {SystemKey::Where::File}, values);
  read_plcs(root, reading);
  read_peers(root, reading);
  read_bridges(root, reading);
  read_lines(root, reading);
  if (plan.lines.empty() && values.complaints.count() == 0)
    values.wrong(root, "the system has no line", "write for example lines: {bus: {stations: [master, slave]}}");
  std::vector<TimedEvent> events;
  if (values.complaints.count() == reading.file.programs.size())  // all else than programs is right
    for (const YamlNode* node : items_of(root, "events", "{at: 1s, power_off: slave}", values))
      if (auto event = read_timed_event(*node, plan, values)) events.push_back({std::move(*event), node});
  for (std::size_t plc = 0; plc < plan.plcs.size(); ++plc)
    if (const Time starts = plan.plcs[plc].settings.starts; starts > 0)
      events.push_back({{.what = EventPlan::What::PowerOn, .at = starts, .station = {StationPlan::Kind::Plc, plc}},
                        reading.names.plc_keys[plc]});
  std::ranges::stable_sort(events, {}, [](const TimedEvent& each) { return each.plan.at; });
  for (const TimedEvent& each : events) plan.events.push_back(each.plan);
  if (values.complaints.count() == 0) check_system(reading);
  if (values.complaints.count() == 0) warn_of_system(reading, events);
}

/// Null: it could not be read as YAML.
void read_tree(const YamlNode* root, SystemFile& file, const std::string& path, const FileSource& files) {
  stl::Diagnostics& diagnostics = file.file.diagnostics;
  YamlValues values(diagnostics);
  SystemReading reading{file, path, files, values};
  if (root) read_file(*root, reading);
  std::ranges::move(reading.notes, std::back_inserter(diagnostics));
  stl::sort(diagnostics);
}

}  // namespace

bool is_system_file(std::string_view path) { return is_yaml_file(path); }

SystemFile read_system(const std::string& text, const std::string& path, const FileSource& files) {
  SystemFile file;
  file.file.source = source_of(text, path);
  const auto root = read_yaml(text, *file.file.source, file.file.diagnostics, kSystemDocument);
  read_tree(root ? &*root : nullptr, file, path, files);
  return file;
}

SystemFile read_system(const YamlNode& root, const std::string& path, const FileSource& files) {
  SystemFile file;
  file.file.source = source_of("", path);
  read_tree(&root, file, path, files);
  return file;
}

}  // namespace s7200::tools
