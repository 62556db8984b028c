#include "tools/session/past/actions/action.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/rig/programming_device.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

struct Doer {
  serial::Simulation& simulation;
  serial::HostPort* host;
  const LineStation* of;

  void operator()(const SetMemory& set) const {
    for (const Assignment& assignment : set.assignments) assign(simulation.cpu(), assignment);
  }
  void operator()(const SendFrame& send) const {
    if (simulation.master().busy()) return;  // only a changed session file can ask for it: it runs another way then
    simulation.configure_master(send.format);
    simulation.master().start(send.request, std::max(simulation.time(), simulation.master_uart().state().send_end));
  }
  void operator()(const CancelRequest&) const { simulation.master().give_up(simulation.time()); }
  void operator()(const Force& force) const {
    for (const Assignment& assignment : force.assignments) simulation.cpu().force(assignment.place, assignment.value);
  }
  void operator()(const Unforce& unforce) const {
    for (const MemoryRange& place : unforce.places) simulation.cpu().unforce(place);
  }
  void operator()(const Jump& jump) const {
    if (jump.to < simulation.cpu().program().ops.size()) simulation.cpu().go_to(jump.to);
  }
  void operator()(const InjectFault& inject) const {
    if (!inject.fault)
      simulation.clear_faults();
    else if (of)
      of->line->faults().inject(*inject.fault, simulation.time(), of->driver);
    else
      simulation.inject(*inject.fault);
  }
  void operator()(const SetStack& set) const { simulation.cpu().set_stack(set.stack); }
  void operator()(const SetMode& set) const { change_mode(simulation.cpu(), set.mode); }
  void operator()(const SetPower& power) const {
    if (simulation.plc().powered() == power.on) return;
    power.on ? simulation.system().power_on(simulation.plc()) : simulation.system().power_off(simulation.plc());
  }
  void operator()(const SystemEvent&) const {}
  void operator()(const serial::HostCall& call) const { host->repeat(call, simulation.time()); }
};

struct Teller {
  std::string operator()(const SetMemory& set) const {
    std::string text = are_inputs(set) ? "input" : "set";
    for (const Assignment& assignment : set.assignments) text += " " + assignment.place.name_of(0);
    return text;
  }
  std::string operator()(const Force& force) const {
    std::string text = "force";
    for (const Assignment& assignment : force.assignments) text += " " + assignment.place.name_of(0);
    return text;
  }
  std::string operator()(const Unforce& unforce) const {
    std::string text = "unforce";
    for (const MemoryRange& place : unforce.places) text += " " + place.name_of(0);
    return text;
  }
  std::string operator()(const SendFrame& send) const { return "send " + serial::to_hex(send.request.frame); }
  std::string operator()(const CancelRequest&) const { return "send cancel"; }
  std::string operator()(const SetPower& power) const { return power.on ? "power on" : "power off"; }
  std::string operator()(const Jump&) const { return "goto"; }
  std::string operator()(const InjectFault& inject) const {
    return "fault " + (inject.fault ? serial::to_text(*inject.fault) : "none") +
           (inject.of.empty() ? "" : " station=" + inject.of);
  }
  std::string operator()(const SetStack&) const { return "set the logic stack"; }
  std::string operator()(const SetMode& set) const { return set.mode == Mode::Run ? "mode run" : "mode stop"; }
  std::string operator()(const SystemEvent& event) const { return event.words; }
  std::string operator()(const serial::HostCall&) const { return "the other end of the bridge"; }
};

}  // namespace

void perform(const Action& action, serial::Simulation& simulation, serial::HostPort* host, const LineStation* of) {
  std::visit(Doer{simulation, host, of}, action);
}

bool are_inputs(const SetMemory& set) {
  return std::ranges::all_of(set.assignments, [](const Assignment& one) { return one.place.area == Area::I; });
}

std::string describe(const Action& action) { return std::visit(Teller{}, action); }

}  // namespace s7200::tools
