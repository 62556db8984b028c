#include "tools/views/state/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace s7200::tools {
namespace {

using serial::Faults;

struct Counts {
  std::uint64_t happened = 0, impossible = 0;
  bool operator==(const Counts&) const = default;
};

Counts counts_of(const Faults::Injected& injected) { return {injected.count, injected.impossible}; }

/// The counts of the same fault at that time; none if it was injected since.
Counts counts_then(const Faults::Injected& injected, const Faults::State& then) {
  const auto same = [&](const Faults::Injected& i) {
    return i.fault == injected.fault && i.at == injected.at && i.driver == injected.driver;
  };
  const auto found = std::ranges::find_if(then.injected, same);
  return found == then.injected.end() ? Counts{} : counts_of(*found);
}

/// The name of the fault's station; nothing if the fault is of the whole line.
std::string name_of(const Faults::Injected& injected, const StationName& station) {
  return injected.driver == Faults::kAnyDriver ? "" : station(injected.driver);
}

nlohmann::ordered_json to_json(const Faults::Injected& injected, const Counts& since, const StationName& station) {
  nlohmann::ordered_json json{{"fault", serial::to_text(injected.fault)}};
  if (const std::string name = name_of(injected, station); !name.empty()) json["station"] = name;
  json["count"] = injected.count - since.happened;
  json["impossible"] = injected.impossible - since.impossible;
  return json;
}

/// Parameters that say when it happens: every kind has them.
bool is_about_when(std::string_view name) {
  const auto& of_all = serial::info_of(serial::FaultKind::Echo).parameters;  // an echo has no others
  return std::ranges::find(of_all, name, &serial::ParameterOfKind::name) != of_all.end();
}

std::string note_of(const Faults::Injected& injected, const StationName& station) {
  const std::string name = name_of(injected, station);
  return fmt::format("fault {}{}{}", serial::to_text(injected.fault), name.empty() ? "" : " of ", name);
}

std::string note_of(const Faults::Injected& injected, std::uint64_t count, const StationName& station) {
  return fmt::format("{}: {}×", note_of(injected, station), count);
}

/// Whether the fault still cuts the line. The start of a cut in a character is not kept: only a cut for ever is known to
/// last.
bool still_cuts(const Faults::Injected& injected, Time now) {
  const serial::Fault& fault = injected.fault;
  if (fault.kind != serial::FaultKind::Cut || injected.count == 0) return false;
  return fault.lasts == kNever || (fault.from && now - injected.at < *fault.from + fault.lasts);
}

/// Why an answer was not changed. The length of one is known if a program of the simulator sends it.
std::string_view why_answer_stays(serial::Misbehaviour misbehaviour) {
  using serial::Misbehaviour;
  switch (misbehaviour) {
    case Misbehaviour::Stale:
      return "there was no earlier answer to repeat";
    case Misbehaviour::Nothing:
    case Misbehaviour::Silent:
    case Misbehaviour::Twice:
      return "it was not known how long the answer is";
    default:
      return "the answer was too short, or of unknown length";
  }
}

}  // namespace

std::string fault_kinds_text() {
  std::string text;
  for (const serial::FaultKindInfo& kind : serial::fault_kinds())
    text += fmt::format("  {:<43} {}\n", kind.example, kind.meaning);
  return text;
}

std::string described(const serial::Fault& fault) {
  const serial::FaultKindInfo& kind = serial::info_of(fault.kind);
  const std::string written = serial::to_text(fault);
  std::string text(kind.meaning), separator = ": ";
  if (serial::at_an_instant(fault)) return text;
  for (const serial::ParameterOfKind& p : kind.parameters) {
    const bool has_standard = p.standard != serial::kRequired && p.standard != serial::kLeftOut;
    if (!has_standard || is_about_when(p.name) || written.find(fmt::format("{}=", p.name)) != std::string::npos) continue;
    text += fmt::format("{}{}={}", separator, p.name, p.standard);
    separator = ", ";
  }
  return text;
}

std::vector<std::string> fault_notes(const Faults& faults, const StationName& station) {
  std::vector<std::string> notes;
  for (const Faults::Injected& injected : faults.state().injected) {
    std::string& note = notes.emplace_back(note_of(injected, injected.count, station));
    if (injected.impossible != 0)
      note += fmt::format(", and {}× {}", injected.impossible,
                          injected.fault.kind == serial::FaultKind::Answer ? why_answer_stays(injected.fault.misbehaviour)
                                                                           : "the format of the character had no such bit");
  }
  return notes;
}

std::vector<std::string> fault_notes(const Faults::State& faults, const Faults::State& since, Time now,
                                     const StationName& station) {
  std::vector<std::string> notes;
  for (const Faults::Injected& injected : faults.injected) {
    const std::uint64_t count = injected.count - counts_then(injected, since).happened;
    if (count != 0)
      notes.push_back(note_of(injected, count, station));
    else if (still_cuts(injected, now))
      notes.push_back(note_of(injected, station));
  }
  return notes;
}

nlohmann::ordered_json faults_json(const Faults& faults, const StationName& station) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Faults::Injected& injected : faults.state().injected) json.push_back(to_json(injected, {}, station));
  return json;
}

nlohmann::ordered_json faults_json(const Faults& faults, const Faults::State& since, const StationName& station) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Faults::Injected& now : faults.state().injected) {
    const Counts then = counts_then(now, since);
    if (counts_of(now) != then) json.push_back(to_json(now, then, station));
  }
  return json;
}

}  // namespace s7200::tools
