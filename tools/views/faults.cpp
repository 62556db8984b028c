#include "tools/views/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace s7200::tools {
namespace {

nlohmann::ordered_json to_json(const serial::Fault& fault, std::uint64_t count, std::uint64_t impossible) {
  return {{"fault", serial::to_text(fault)}, {"count", count}, {"impossible", impossible}};
}

/// Parameters that say when it happens: every kind has them.
bool is_about_when(std::string_view name) {
  const auto& of_all = serial::info_of(serial::FaultKind::Echo).parameters;  // an echo has no others
  return std::ranges::find(of_all, name, &serial::ParameterOfKind::name) != of_all.end();
}

std::string note_of(const serial::Fault& fault, std::uint64_t count) {
  return fmt::format("fault {}: {}×", serial::to_text(fault), count);
}

/// When a cut in a character began is not kept: only one for ever is known to last.
bool still_cuts(const serial::Faults::Injected& injected, Time now) {
  const serial::Fault& fault = injected.fault;
  if (fault.kind != serial::FaultKind::Cut || injected.count == 0) return false;
  return fault.lasts == kNever || (fault.from && now - injected.at < *fault.from + fault.lasts);
}

}  // namespace

std::string described(const serial::Fault& fault) {
  const serial::FaultKindInfo& kind = serial::info_of(fault.kind);
  const std::string written = serial::to_text(fault);
  std::string text(kind.meaning), separator = ": ";
  if (fault.from && fault.kind != serial::FaultKind::Noise) return text;  // at an instant, not at a character
  for (const serial::ParameterOfKind& p : kind.parameters) {
    const bool has_standard = p.standard != serial::kRequired && p.standard != serial::kLeftOut;
    if (!has_standard || is_about_when(p.name) || written.find(fmt::format("{}=", p.name)) != std::string::npos) continue;
    text += fmt::format("{}{}={}", separator, p.name, p.standard);
    separator = ", ";
  }
  return text;
}

std::vector<std::string> fault_notes(const serial::Faults& faults) {
  std::vector<std::string> notes;
  for (const serial::Faults::Injected& injected : faults.state().injected) {
    std::string& note = notes.emplace_back(note_of(injected.fault, injected.count));
    if (injected.impossible != 0)
      note += fmt::format(", and {}× the format of the character had no such bit", injected.impossible);
  }
  return notes;
}

std::vector<std::string> fault_notes(const serial::Faults& faults, const serial::Faults::State& since, Time now) {
  std::vector<std::string> notes;
  for (const serial::Faults::Injected& injected : faults.state().injected) {
    const auto then = std::ranges::find_if(since.injected, [&](const serial::Faults::Injected& one) {
      return one.at == injected.at && one.fault == injected.fault;
    });
    const std::uint64_t before = then == since.injected.end() ? 0 : then->count;
    if (injected.count != before)
      notes.push_back(note_of(injected.fault, injected.count - before));
    else if (still_cuts(injected, now))
      notes.push_back("fault " + serial::to_text(injected.fault));
  }
  return notes;
}

nlohmann::ordered_json faults_json(const serial::Faults& faults) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const serial::Faults::Injected& injected : faults.state().injected)
    json.push_back(to_json(injected.fault, injected.count, injected.impossible));
  return json;
}

nlohmann::ordered_json faults_json(const serial::Faults& faults, const serial::Faults::State& since) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < since.injected.size(); ++i) {
    const serial::Faults::Injected &now = faults.state().injected.at(i), &then = since.injected[i];
    if (now.count != then.count || now.impossible != then.impossible)
      json.push_back(to_json(now.fault, now.count - then.count, now.impossible - then.impossible));
  }
  return json;
}

}  // namespace s7200::tools
