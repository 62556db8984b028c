#include "tools/rig/event_words.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/joined.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {

const std::string& name_of_subject(const EventPlan& event, const SystemPlan& plan) {
  const EventSubject subject = subject_of(event);
  return subject.station ? name_of(plan, *subject.station) : plan.lines[subject.line].name;
}

std::string event_text(const EventPlan& event, const SystemPlan& plan, bool in_vain) {
  using What = EventPlan::What;
  const auto station = [&](std::size_t place) { return name_of(plan, plan.lines[event.line].stations[place]); };
  switch (event.what) {
    case What::PowerOff:
      return "power off";
    case What::PowerOn:
      return "power on";
    case What::Cut:
      return fmt::format("cable cut after {}", station(event.near - 1));
    case What::Mend:
      return "cable whole again";
    case What::Set: {
      const auto text_of = [](const Assignment& each) {
        return fmt::format("{} to {}", each.place.name_of(0), hex_text(each));
      };
      return fmt::format("a programming device sets {}{}", stl::joined(event.set, text_of),
                         in_vain ? ": no effect, the PLC has no power" : "");
    }
    case What::Fault:
      return fmt::format("fault {}{}", serial::to_text(event.fault.fault),
                         event.fault.station ? " of " + station(*event.fault.station) : "");
    case What::ClearFaults:
      return "no fault any more";
  }
  return {};
}

std::string named_event_text(const EventPlan& event, const SystemPlan& plan) {
  return fmt::format("{}: {}", name_of_subject(event, plan), event_text(event, plan, false));
}

std::vector<std::string> event_texts(const SystemPlan& plan) {
  std::vector<std::string> texts;
  for (const EventPlan& event : plan.events) texts.push_back(named_event_text(event, plan));
  return texts;
}

}  // namespace s7200::tools
