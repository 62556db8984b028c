#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/master/protocol.hpp"

namespace s7200::tools {

std::span<const Protocol* const> protocols() {
  static const std::array kProtocols{&modbus_protocol(),  &freeport_pc_protocol(),  &pc1000_lan_protocol(),
                                     &westnet_protocol(), &pc500_loader_protocol(), &hppc_protocol(),
                                     &ppi_protocol()};
  return kProtocols;
}

nlohmann::ordered_json empty_subject() {
  return {{"station", nullptr}, {"function", nullptr}, {"area", nullptr},
          {"first", nullptr},   {"notation", nullptr}, {"count", nullptr}};
}

const Protocol* find_protocol(std::string_view name) {
  const auto found = std::ranges::find_if(protocols(), [&](const Protocol* protocol) { return protocol->name == name; });
  return found == protocols().end() ? nullptr : *found;
}

std::vector<std::string> raw_frames(const std::vector<MasterAction>& actions) {
  constexpr std::string_view kWord = "raw ";
  std::vector<std::string> frames;
  for (const MasterAction& action : actions)
    if (action.kind == MasterAction::Kind::Raw) frames.push_back(action.text.substr(kWord.size()));
  return frames;
}

std::string protocols_help() {
  std::string text = "Protocols:\n";
  for (const Protocol* protocol : protocols()) text += fmt::format("  {:<38}{}\n", protocol->name, protocol->meaning);
  for (const Protocol* protocol : protocols()) text += protocol->actions_help;
  text +=
      "What documents leave open of a master; [M1] and the like mark choices where the document is silent, here and in the "
      "settings of westinghouse:MODEL:\n";
  for (const Protocol* protocol : protocols())
    if (!protocol->choices.empty()) text += fmt::format("  {:<38}{}\n", protocol->name, protocol->choices);
  return text;
}

std::string simulated_plcs_help() {
  std::string text;
  for (const Protocol* protocol : protocols())
    if (protocol->plcs != nullptr)
      text += fmt::format("Settings of westinghouse:MODEL with --protocol {}, {}:\n{}", protocol->name,
                          fmt::join(protocol->plcs->models, ", "), westinghouse::settings_help(*protocol->plcs));
  return text;
}

}  // namespace s7200::tools
