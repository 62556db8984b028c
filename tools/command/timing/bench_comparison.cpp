#include "tools/command/timing/bench_comparison.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/text.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/json/json.hpp"

namespace s7200::tools {
namespace {

bool is_above_0(const nlohmann::json& figure, const char* key) {
  const auto number = figure.value(key, nlohmann::json());
  return number.is_number() && number > 0;
}

/// What Figure::speed() was; nothing if it is no figure.
std::optional<double> speed_of(const nlohmann::json& figure) {
  if (!figure.is_object() || !figure.value("name", nlohmann::json()).is_string()) return {};
  if (is_above_0(figure, "takes")) return 1 / figure["takes"].get<double>();
  return is_above_0(figure, "per_second") ? std::optional(figure["per_second"].get<double>()) : std::nullopt;
}

}  // namespace

nlohmann::ordered_json measured_with(const ProgramOptions& options, const Program& program, Time each) {
  return {{"program", program.source.name},
          {"cpu", program.model->name},
          {"times", options.times_table},
          {"no_skip", options.every_scan},
          {"each_ms", static_cast<double>(each) / kMillisecond},
          {"build", S7200_BUILD_TYPE}};
}

std::optional<EarlierBench> read_earlier_bench(const std::string& path) {
  const auto text = read_text(path);
  const nlohmann::json json = parse_json(text.value_or("")).value_or(nlohmann::ordered_json());
  const bool printed =
      json.is_object() && json.contains("figures") && json["figures"].is_array() && !json["figures"].empty();
  if (!text || !printed) {
    print_error(fmt::format("cannot read {}: {}", path, text ? "it is not what `s7200 bench --json` printed" : text.why()));
    return {};
  }
  EarlierBench before{{}, json};
  for (const auto& figure : json["figures"]) {
    const auto speed = speed_of(figure);
    if (!speed) {
      print_error(fmt::format("cannot read {}: '{}' is not a figure with a name and a rate above 0", path, shown(figure)));
      return {};
    }
    before.speeds[figure["name"]] = *speed;
  }
  return before;
}

void warn_of_differences(const nlohmann::ordered_json& now, const EarlierBench& before, const std::string& path) {
  for (const auto& [key, value] : now.items()) {
    const nlohmann::json then = before.measured.value(key, nlohmann::json());
    if (then.is_null())
      print_note(fmt::format("{} does not say with which {} it was measured", path, key));
    else if (then != nlohmann::json(value))
      print_note(fmt::format("{} was measured with {} {}, this with {}", path, key, then.dump(), value.dump()));
  }
}

std::optional<double> ratio_of(const Figure& figure, const EarlierBench& before) {
  const auto found = before.speeds.find(std::string(figure.name));
  return found == before.speeds.end() ? std::nullopt : std::optional(figure.speed() / found->second);
}

nlohmann::ordered_json json_of(const Figure& figure, const EarlierBench& before) {
  const auto if_any = [](double value) { return value > 0 ? nlohmann::ordered_json(value) : nullptr; };
  const auto ratio = ratio_of(figure, before);
  return {{"name", figure.name},
          {"unit", figure.unit},
          {"per_second", if_any(figure.per_second)},
          {"takes", if_any(figure.takes)},
          {"ratio", ratio ? nlohmann::ordered_json(*ratio) : nullptr}};
}

}  // namespace s7200::tools
