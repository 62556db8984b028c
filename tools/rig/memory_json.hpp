// Retentive memory as JSON: in the files of `--memory`, in saved sessions and in reports. It knows no files.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"
#include "interpreter/cpu/state.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "tools/json/json_taker.hpp"

namespace s7200::tools {

/// The beginning of a text that memory_to_json() writes.
std::string memory_beginning();

/// JSON: `"ram"` and `"eeprom"` have the bytes that are not 0, in hex, by the address of the first.
std::string memory_to_json(const RetentiveMemory& memory, const CpuModel& model);

/// Trouble if the text is not such a memory, or that of another CPU.
Result<RetentiveMemory> memory_from_json(std::string_view json, const CpuModel& model);

/// The same within other JSON, with how power came back: `memory`, `memory_lost` and `power_off`.
void add_kept_memory(nlohmann::ordered_json& json, const RetentiveMemory& memory, const CpuModel& model);

/// Nothing if there is none in it, or a wrong one, which `taker` says.
std::optional<RetentiveMemory> take_kept_memory(JsonTaker& taker, const nlohmann::ordered_json& json, const CpuModel& model);

}  // namespace s7200::tools
