// A system as a report carries it: the tree of its file, which needs no parser then, and the files that this names.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/file_source.hpp"
#include "interpreter/base/result.hpp"
#include "tools/json/json_taker.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/session/commands/reply.hpp"
#include "tools/yaml/yaml.hpp"

namespace s7200::tools::page {

struct CarriedSystem {
  std::string path{};                                  ///< of its file, with / between folders
  YamlNode root{};                                     ///< what stands in it
  std::map<std::string, std::string> files{};          ///< the bytes of those that it names, by name
  std::vector<const CpuModel*> models{};               ///< by PLC
  std::vector<std::optional<RetentiveMemory>> kept{};  ///< by PLC; empty: none has kept anything
  std::vector<Spot> spots{};                           ///< where masters have joined lines
};

Json system_json(const CarriedSystem& system);

/// Its plan, with what the PLCs have kept, and where masters join. Trouble if the JSON is no such system.
struct OpenedSystem {
  SystemPlan plan{};
  std::vector<Spot> spots{};
};
Result<OpenedSystem> system_from(const Json& json);

}  // namespace s7200::tools::page
