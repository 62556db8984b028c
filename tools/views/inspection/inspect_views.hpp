// The views of `s7200 inspect`: a row each.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

struct InspectView {
  std::string_view name;     ///< as it is asked for; the key of its JSON
  std::string_view meaning;  ///< one line
  bool of_memory;            ///< it can keep to addresses; to routines and networks each can
  std::string (*text)(const Inspection& inspection);
  nlohmann::ordered_json (*json)(const Inspection& inspection);
  std::string (*svg)(const Inspection& inspection) = nullptr;  ///< the same as a picture; null where there is none
  /// What it did not look at and why, its key `not_followed`; null where it looks at all.
  nlohmann::ordered_json (*not_followed_json)(const Inspection& inspection) = nullptr;
};

/// In the order of the help.
std::span<const InspectView> inspect_views();

/// Returns null if there is no view of that name.
const InspectView* find_inspect_view(std::string_view name);

}  // namespace s7200::tools
