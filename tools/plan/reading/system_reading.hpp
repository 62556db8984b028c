// The common state of the readers of a system file's parts: its plan so far, its names, and its complaints.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/plan/reading/system_reader.hpp"
#include "tools/plan/system_keys.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

/// A key of a map, and its value.
struct Named {
  const YamlNode& key;
  const YamlNode& item;
};

/// The names and files that are taken, and by what.
class SystemNames {
 public:
  struct Other {
    const YamlNode* key;
    StationPlan plan;
  };

  std::map<std::string, std::vector<std::size_t>> groups{};    ///< PLCs by the name in the file
  std::vector<const YamlNode*> plc_keys{};                     ///< by number
  std::vector<std::optional<std::uint8_t>> modbus_stations{};  ///< the same; of programs that are told their station
  std::map<std::string, Other> others{};                       ///< peers and bridges
  std::map<std::string, std::uint32_t> served{};               ///< where bridges are, and the line that says so

  /// A station's name is its own. False after a complaint.
  bool take_name(const YamlNode& key, const std::string& name, YamlValues& values);

  /// Takes a station with a name of its own. Returns false after a complaint.
  bool take_station(const YamlNode& key, const std::string& name, YamlValues& values);

  /// A file that is written has one writer.
  void take_file(const YamlNode& node, const std::string& path, YamlValues& values);

 private:
  std::map<std::string, std::uint32_t> names_{}, written_{};  // and the line where they stand
  std::size_t stations_ = 0;
};

/// A file as far as it is read.
struct SystemReading {
  SystemFile& file;
  const std::string& path;
  const FileSource& files;
  YamlValues& values;
  SystemNames names{};
  stl::Diagnostics notes{};  ///< on how programs were read; they are added after the complaints, any of which ends the
                             ///< checks
};

/// Complains about each key of `map` that has no row with one of these places.
void check_keys(const YamlNode& map, std::initializer_list<SystemKey::Where> places, YamlValues& values);

/// Reads a list of names with a map for each.
std::vector<Named> entries(const YamlNode& root, std::string_view list, YamlValues& values);

/// Reads the items of the list at `key`; none if it is not there, or after a complaint.
std::vector<const YamlNode*> items_of(const YamlNode& map, std::string_view key, std::string_view example,
                                      YamlValues& values);

/// Reads assignments: `{VW20: 5, I0.3: 1}`
std::vector<Assignment> read_assignments(const YamlNode& set, const Program& program, YamlValues& values);

/// Reads a fault. `station` is the node beside it that names its station, or null. Nothing after a complaint.
std::optional<FaultPlan> read_fault(const YamlNode& what, const YamlNode* station, const LinePlan& line,
                                    const SystemPlan& plan, YamlValues& values);

/// The number of a station among those of its line, `slave2` or `gateway.1`. Nothing after a complaint.
std::optional<std::size_t> station_on(const LinePlan& line, const YamlNode& node, const SystemPlan& plan,
                                      YamlValues& values);

bool on_a_line(const StationPlan& station, const SystemPlan& plan);

}  // namespace s7200::tools
