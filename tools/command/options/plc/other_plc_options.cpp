#include "tools/command/options/plc/other_plc_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/plan/other_plc.hpp"
#include "tools/slave/slave_target.hpp"

namespace s7200::tools {

CLI::Option* add_protocol_option(CLI::App& app, const Protocol*& protocol, std::vector<const Protocol*> choices,
                                 const std::string& meaning) {
  protocol = choices.front();
  std::vector<std::string> names;
  for (const Protocol* one : choices) names.emplace_back(one->name);
  const std::string known = fmt::format("{}", fmt::join(names, ", "));
  const auto named = [choices = std::move(choices)](const std::string& name) {
    const auto found = std::ranges::find(choices, name, &Protocol::name);
    return found == choices.end() ? nullptr : *found;
  };
  return offer(app.add_option_function<std::string>(
                   "--protocol", [&protocol, named](const std::string& name) { protocol = named(name); },
                   fmt::format("{}: {} [{}]", meaning, known, protocol->name)),
               names)
      ->check([named, known](const std::string& name) {
        return named(name) ? std::string()
                           : fmt::format("'{}' is not a protocol; there are {}", stl::shortened(name), known);
      })
      ->type_name("NAME");
}

std::vector<const Protocol*> protocols_of_other_plcs() {
  std::vector<const Protocol*> spoken;
  std::ranges::copy_if(protocols(), std::back_inserter(spoken), [](const Protocol* one) { return one->plcs != nullptr; });
  return spoken;
}

CLI::Option* OtherPlcOptions::add_to(CLI::App& app) {
  return app.add_option("--plc", settings_, "setting of westinghouse:MODEL: s7200 help westinghouse (repeatable)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->group(help_group::kLine);
}

void offer_other_plcs(CLI::Option* target) {
  std::vector<std::string> models;
  for (const Protocol* one : protocols_of_other_plcs())
    for (const std::string_view model : one->plcs->models) {
      std::string name = std::string(kOtherPlc).append(model);
      if (std::ranges::find(models, name) == models.end()) models.push_back(std::move(name));
    }
  offer_beside_files(target, models);
}

namespace {

/// Throws std::invalid_argument for a model that does not speak the protocol.
void check_model(const Protocol& protocol, std::string_view model) {
  const auto speaks = [&](const Protocol* one) {
    return std::ranges::find(one->plcs->models, model) != one->plcs->models.end();
  };
  if (speaks(&protocol)) return;
  std::string others;
  for (const Protocol* one : protocols_of_other_plcs())
    if (speaks(one)) others.append(others.empty() ? "" : ", ").append(one->name);
  const auto& models = protocol.plcs->models;
  throw std::invalid_argument(fmt::format("no '{}' speaks {} in simulation: {} do{}{}", stl::shortened(model), protocol.name,
                                          fmt::join(models, ", "), models.size() == 1 ? "es" : "",
                                          others.empty() ? "" : fmt::format("; it speaks {}", others)));
}

}  // namespace

std::unique_ptr<westinghouse::Plc> OtherPlcOptions::make(const Protocol& protocol, std::string_view model) const {
  check_model(protocol, model);
  auto plc = make_other_plc(*protocol.plcs, model, settings_);
  if (!plc) throw std::invalid_argument(plc.why());
  return *std::move(plc);
}

}  // namespace s7200::tools
