// A recording as JSON of little size: what a report carries. It knows no files and throws nothing.
//
// `actions` has each different action once; `done` has a column for each part of what was done when: the number of the
// action among them, the host port, the nanoseconds and the instructions since what was done before. A column that is left
// out is 0 throughout.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// The CPUs of what was recorded, by station.
using Models = std::span<const CpuModel* const>;

/// The recording is complete.
nlohmann::ordered_json json_of(const Recording& recording, Models models);

/// Its part `checkpoints`: in hex, which zlib packs better than base64, because the same bytes have the same characters in
/// all of them.
nlohmann::ordered_json checkpoints_json(const std::vector<std::string>& checkpoints);

/// Trouble if the JSON is not a recording of those CPUs.
Result<Recording> recording_from(const nlohmann::ordered_json& json, Models models);

}  // namespace s7200::tools
