#include "tools/plan/reading/event_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/plan/reading/system_reading.hpp"

namespace s7200::tools {
namespace {

using Where = SystemKey::Where;

class EventReader {
 public:
  EventReader(const SystemPlan& plan, YamlValues& values) : plan_(plan), values_(values) {}

  std::optional<EventPlan> read_timed(const YamlNode& node) {
    if (!node.is_map()) {
      values_.wrong(node, "an event is a map, not " + to_text(node), std::string(kEventExample));
      return {};
    }
    check_keys(node, {Where::Event}, values_);
    auto event = read_what(node);
    if (!event) return {};
    if (!node.find("at")) {
      values_.wrong(node, "an event without 'at'", std::string(kEventExample));
      return {};
    }
    event->at = values_.duration(node.find("at")).value_or(0);
    return event;
  }

  /// Reads the action of an event; nothing after a complaint.
  std::optional<EventPlan> read_what(const YamlNode& node) {
    const EventWord* done = nullptr;
    for (const EventWord& each : event_words()) {
      if (!node.find(each.word)) continue;
      if (done) {
        values_.wrong(node, fmt::format("both '{}' and '{}'", done->word, each.word), "one is done at a time");
        return {};
      }
      done = &each;
    }
    if (!done) {
      values_.wrong(node, "nothing is done in this event", std::string(kEventExample));
      return {};
    }
    EventPlan event{.what = done->what};
    const bool good = only_its_own_beside(node, *done) && read_object(node, *node.find(done->word), event);
    return good ? std::optional(event) : std::nullopt;
  }

 private:
  static constexpr std::string_view kEventExample = "write for example {at: 1s, power_off: slave}";

  /// Checks that no key of another action is given. Returns false after a complaint.
  bool only_its_own_beside(const YamlNode& node, const EventWord& word) {
    for (const YamlNode& key : node.keys) {
      const auto belongs_to = [&](const EventWord& w) { return std::ranges::find(w.beside, key.text) != w.beside.end(); };
      if (belongs_to(word) || std::ranges::none_of(event_words(), belongs_to)) continue;
      const EventWord& other = *std::ranges::find_if(event_words(), belongs_to);
      values_.wrong(key, fmt::format("'{}' has no place beside '{}'", key.text, word.word),
                    fmt::format("it belongs beside '{}'", other.word));
      return false;
    }
    return true;
  }

  /// Reads the object of an event. Returns false after a complaint.
  bool read_object(const YamlNode& node, const YamlNode& what, EventPlan& event) {
    using What = EventPlan::What;
    if (event.what == What::Fault) return read_fault_event(node, what, event);
    if (event.what == What::Set) return read_set_event(node, what, event);
    if (event.what == What::PowerOff || event.what == What::PowerOn) return read_powered(what, event);
    const auto line = line_named(what);
    if (!line) return false;
    event.line = *line;
    return event.what != What::Cut || read_cut(node, event);
  }

  bool read_powered(const YamlNode& what, EventPlan& event) {
    const auto name = values_.text(what);
    if (!name) return false;
    if (const auto plc = place_of(plan_.plcs, *name)) {
      event.station = {StationPlan::Kind::Plc, *plc};
      return true;
    }
    if (const auto peer = place_of(plan_.peers, *name)) {
      event.station = {StationPlan::Kind::Peer, *peer};
      return true;
    }
    if (std::ranges::find(plan_.bridges, *name, &BridgePlan::name) != plan_.bridges.end()) {
      values_.wrong(what, fmt::format("'{}' is a bridge, which has no power to switch", *name), "cut the cable before it");
      return false;
    }
    std::vector<std::string> known = names_of(plan_.plcs), peers = names_of(plan_.peers);
    const std::string_view kinds = peers.empty() ? "PLC" : known.empty() ? "peer" : "PLC or peer";
    known.insert(known.end(), peers.begin(), peers.end());
    is_unknown(what, kinds, *name, known);
    return false;
  }

  bool read_fault_event(const YamlNode& node, const YamlNode& what, EventPlan& event) {
    const YamlNode* const line = node.find("line");
    if (!line) values_.wrong(node, "a fault without its 'line'");
    const auto number = line ? line_named(*line) : std::nullopt;
    const auto fault = number ? read_fault(what, node.find("station"), plan_.lines[*number], plan_, values_) : std::nullopt;
    if (!fault) return false;
    event.line = *number;
    event.fault = *fault;
    return true;
  }

  bool read_set_event(const YamlNode& node, const YamlNode& what, EventPlan& event) {
    const YamlNode* const name = node.find("plc");
    if (!name) values_.wrong(node, "'set' without the 'plc' whose memory it is");
    const auto number = name ? plc_named(*name) : std::nullopt;
    if (!number) return false;
    event.plc = *number;
    if (const auto& program = plan_.plcs[*number].program) event.set = read_assignments(what, *program, values_);
    return true;
  }

  bool read_cut(const YamlNode& node, EventPlan& event) {
    const YamlNode* const after = node.find("after");
    if (!after) values_.wrong(node, "a cut without 'after', the last station on the first part");
    const LinePlan& line = plan_.lines[event.line];
    const auto place = after ? station_on(line, *after, plan_, values_) : std::nullopt;
    if (!place) return false;
    event.near = *place + 1;
    if (event.near < line.stations.size()) return true;
    values_.wrong(*after, fmt::format("'{}' is the last station of line '{}'", stl::shortened(after->text), line.name),
                  "the cable is cut after one of the others");
    return false;
  }

  template <class Plans>
  static std::optional<std::size_t> place_of(const Plans& plans, std::string_view name) {
    const auto found = std::ranges::find(plans, name, [](const auto& each) -> std::string_view { return each.name; });
    return found == plans.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - plans.begin()));
  }

  template <class Plans>
  static std::vector<std::string> names_of(const Plans& plans) {
    std::vector<std::string> names;
    for (const auto& each : plans) names.push_back(each.name);
    return names;
  }

  void is_unknown(const YamlNode& node, std::string_view kind, const std::string& name,
                  const std::vector<std::string>& known) {
    values_.wrong(node, fmt::format("there is no {} '{}'", kind, stl::shortened(name)),
                  known.empty() ? fmt::format("there is no {} in this system", kind)
                                : fmt::format("known: {}", fmt::join(known, ", ")));
  }

  template <class Plans>
  std::optional<std::size_t> named(const YamlNode& node, const Plans& plans, std::string_view kind) {
    const auto name = values_.text(node);
    if (!name) return {};
    const auto place = place_of(plans, *name);
    if (!place) is_unknown(node, kind, *name, names_of(plans));
    return place;
  }

  std::optional<std::size_t> plc_named(const YamlNode& node) { return named(node, plan_.plcs, "PLC"); }
  std::optional<std::size_t> line_named(const YamlNode& node) { return named(node, plan_.lines, "line"); }

  const SystemPlan& plan_;
  YamlValues& values_;
};

}  // namespace

std::span<const EventWord> event_words() {
  using What = EventPlan::What;
  static const std::vector<EventWord> kWords{{"power_off", What::PowerOff},      {"power_on", What::PowerOn},
                                             {"cut", What::Cut, {"after"}},      {"mend", What::Mend},
                                             {"set", What::Set, {"plc"}},        {"fault", What::Fault, {"line", "station"}},
                                             {"clear_faults", What::ClearFaults}};
  return kWords;
}

const EventWord& word_of(EventPlan::What what) { return *std::ranges::find(event_words(), what, &EventWord::what); }

std::optional<EventPlan> read_event(const YamlNode& node, const SystemPlan& plan, YamlValues& values) {
  return EventReader(plan, values).read_what(node);
}

std::optional<EventPlan> read_timed_event(const YamlNode& node, const SystemPlan& plan, YamlValues& values) {
  return EventReader(plan, values).read_timed(node);
}

}  // namespace s7200::tools
