#include "tools/views/results_json.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/views/escapes.hpp"

namespace s7200::tools {

using nlohmann::ordered_json;
constexpr auto kReplace = ordered_json::error_handler_t::replace;

std::string_view version() { return S7200_VERSION; }

ordered_json results_of(std::string_view verb) { return {{"s7200", {{"verb", verb}, {"version", version()}}}}; }

std::string lines_of(const ordered_json& results) { return with_escapes(results.dump(2, ' ', false, kReplace)) + "\n"; }

std::string line_of(const ordered_json& json) { return with_escapes(json.dump(-1, ' ', false, kReplace)); }

ordered_json real_json(float value) {
  const std::string shortest = fmt::format("{}", value);
  if (!std::isfinite(value)) return shortest;
  return std::stod(shortest);
}

}  // namespace s7200::tools
