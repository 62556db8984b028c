#include "tools/views/ladder/ladder_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "interpreter/analysis/drawn_networks.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "tools/views/ladder/ladder_json.hpp"
#include "tools/views/ladder/ladder_svg.hpp"
#include "tools/views/ladder/ladder_text.hpp"

namespace s7200::tools {
namespace {

bool is_asked_for(const Inspection& inspection, std::uint32_t op) {
  return inspection.selection.has_op(op) ||
         std::ranges::any_of(inspection.facts.effects[op], [&](const MemoryAccess& access) {
           return access.operand != kNoOperand && inspection.selection.has(as_named(access.bits));
         });
}

std::vector<DrawnNetwork> networks_of(const Inspection& inspection) {
  std::vector<DrawnNetwork> networks = drawn_networks(inspection.program->source);
  if (inspection.selection.everything()) return networks;
  std::erase_if(networks, [&](const DrawnNetwork& network) {
    for (std::uint32_t op = network.first; op < network.end; ++op)
      if (is_asked_for(inspection, op)) return false;
    return true;
  });
  return networks;
}

std::string summary_of(const std::vector<DrawnNetwork>& networks, const stl::Source& program) {
  const auto undrawn = std::ranges::count_if(networks, [](const DrawnNetwork& each) { return !each.why_not.empty(); });
  if (undrawn == 0) return {};
  return fmt::format("{} of {} not representable in ladder:\n{}", undrawn, counted(networks.size(), "network"),
                     undrawn_text(networks, program));
}

}  // namespace

std::string ladder_text(const Inspection& inspection) {
  const auto networks = networks_of(inspection);
  if (networks.empty()) return "no network uses what was asked for\n";
  const stl::Source& program = inspection.program->source;
  return ladder_text(networks, program, inspection.ascii) + stl::wrapped(summary_of(networks, program), kLadderColumns);
}

nlohmann::ordered_json ladder_json(const Inspection& inspection) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const DrawnNetwork& network : networks_of(inspection))
    json.push_back(network_json(network, inspection.program->source));
  return json;
}

std::string ladder_svg(const Inspection& inspection) {
  return ladder_svg(networks_of(inspection), inspection.program->source);
}

}  // namespace s7200::tools
