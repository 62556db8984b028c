// Reads the keys of a PLC out of YAML: of a system file, or of the head of a scenario.
#pragma once

#include <functional>
#include <string>

#include "tools/plan/plc_keys.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

class PlcKeyReader {
 public:
  /// Resolves a path as it is written: from the folder of the file that is read.
  using Path = std::function<std::string(const YamlNode& map, std::string_view key)>;
  /// Takes the name of a file that is to be written. Returns false after a complaint.
  using MayWrite = std::function<bool(const YamlNode& node, const std::string& path)>;

  /// `in_system`: the keys of a system file, otherwise those of a scenario. Nothing given is owned.
  PlcKeyReader(YamlValues& values, bool in_system, Path path, MayWrite may_write = {})
      : values_(values), in_system_(in_system), path_(std::move(path)), may_write_(std::move(may_write)) {}

  /// Reads the keys that `map` has of this stage into the settings; complains about values at their places.
  void read(const YamlNode& map, PlcKey::Stage stage, const AddressSpace& space, PlcSettings& settings);

 private:
  void read_key(const YamlNode& map, const PlcKey& key, const AddressSpace& space, PlcSettings& settings);
  void take(const YamlNode& place, const PlcKey& key, const std::string& text, const AddressSpace& space,
            PlcSettings& settings);

  YamlValues& values_;
  bool in_system_;
  Path path_;
  MayWrite may_write_;
};

}  // namespace s7200::tools
