#include "tools/session/words/fault_words.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/text.hpp"
#include "tools/plan/fault_owner.hpp"
#include "tools/session/words/line_words.hpp"
#include "tools/views/state/faults.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kStation = "station=";

/// Where the last word begins if it is `station=NAME` and no parameter of the fault, which stands after a comma or the
/// colon.
std::size_t station_word(std::string_view text) {
  const std::size_t blank = text.find_last_of(" \t");
  if (blank == std::string_view::npos || !stl::lower_case(text.substr(blank + 1)).starts_with(kStation))
    return std::string_view::npos;
  const std::string_view before = stl::trim(text.substr(0, blank));
  return before.ends_with(',') || before.ends_with(':') ? std::string_view::npos : blank + 1;
}

}  // namespace

Result<InjectFault> fault_of(const std::string& text, const History& history, std::size_t station) {
  const std::string_view trimmed = stl::trim(text);
  const std::size_t word = station_word(trimmed);
  if (word == std::string_view::npos) return inject_of(std::string(trimmed));
  const std::string fault(stl::trim(trimmed.substr(0, word)));
  auto inject = inject_of(fault);
  if (!inject) return inject.trouble();
  const std::string name(trimmed.substr(word + kStation.size()));
  const serial::SharedLine& line = history.station(station).line();
  const std::string known = names_on(history.line_stations(), line);
  const LineStation* const of = known.empty() ? nullptr : find_station(history.line_stations(), line, name);
  if (known.empty())
    return Trouble{"fault: station= is for a system; of=request or of=answer in the fault says whose characters are meant"};
  if (!inject->fault) return Trouble{"fault: none ends all faults of the line, whosever they are; leave station= out"};
  if (!of) return trouble("fault: '{}' is not on this line; known: {}", stl::shortened(name), known);
  if (const auto cannot = why_not_of_station(serial::parse_fault(fault), of->kind == LineStation::Kind::Plc))
    return trouble("fault: {}; {}", cannot->wrong, cannot->hint);
  inject->of = of->name;
  return inject;
}

std::string fault_text(const InjectFault& inject) {
  if (inject.of.empty()) return injected_text(inject);
  serial::Fault whatever = *inject.fault;  // says nothing of whose it is
  whatever.of = serial::Half::Both;
  whatever.station = serial::Station::Plc;
  return fmt::format("on the line from now on, of what {} sends: {}\n  {}\n", stl::printable(inject.of),
                     serial::to_text(*inject.fault), described(whatever));
}

std::string faults_text(const History& history, std::size_t station) {
  const serial::Simulation& simulation = history.station(station);
  const auto name = [&](int driver) {
    for (const LineStation& one : history.line_stations())
      if (one.line == &simulation.line() && one.driver == driver) return stl::printable(one.name);
    return std::string();
  };
  std::string text;
  for (const std::string& note : fault_notes(simulation.faults(), name)) text += note + '\n';
  return text.empty() ? "the line has no fault now; this would be one: fault flip:character=3,bit=5\n" : text;
}

}  // namespace s7200::tools
