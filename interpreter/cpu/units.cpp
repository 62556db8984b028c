#include "interpreter/cpu/units.hpp"

#include <cassert>
#include <iterator>

#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/network.hpp"
#include "interpreter/cpu/ports/freeport.hpp"
#include "interpreter/cpu/ports/message_receiver.hpp"
#include "interpreter/cpu/scan.hpp"
#include "interpreter/cpu/units/clock.hpp"
#include "interpreter/cpu/units/eeprom.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/cpu/units/high_speed_counters.hpp"
#include "interpreter/cpu/units/points.hpp"
#include "interpreter/cpu/units/power.hpp"
#include "interpreter/cpu/units/pulse_outputs.hpp"
#include "interpreter/cpu/units/timers.hpp"

namespace s7200::units {
namespace {

/// The unit's own events: `count` of them from `first` on.
struct OwnEvents {
  std::uint8_t first = 0, count = 0;
  void (*handle)(Core&, std::uint8_t what, Time at) = nullptr;
};

template <class... Arguments>
void nothing(Arguments...) {}

/// units.hpp says what the columns mean. A row leaves out the columns where its unit does nothing.
struct Unit {
  void (*power_up)(Core&, const RetentiveMemory*) = nothing;
  void (*enter_run)(Core&) = nothing;
  void (*enter_stop)(Core&) = nothing;
  void (*begin_scan)(Core&) = nothing;
  void (*end_scan)(Core&) = nothing;
  void (*inputs_changed)(Core&, std::uint32_t byte, std::uint8_t changed, Time at) = nothing;
  void (*begin_service)(Core&, const QueuedInterrupt&) = nothing;
  OwnEvents events{};
};

// The order matters: input edges occur before the counters act on them; pulses end before the output points go off; the
// forced values reach the image before the points are written; the points are written before a value is saved; the EEPROM
// fills V memory before the retentive ranges overwrite it, and what is forced comes over all.
constexpr Unit kUnits[] = {
    {.power_up = scan::power_up},
    {.enter_stop = interrupts::enter_stop,
     .inputs_changed = interrupts::inputs_changed,
     .events = {kTimedInterrupt0, 2, interrupts::handle}},
    {.power_up = timers::power_up,
     .enter_run = timers::enter_run,
     .enter_stop = timers::enter_stop,
     .begin_scan = timers::begin_scan,
     .events = {kTick1ms, 1, timers::handle}},
    {.enter_stop = message_receiver::enter_stop, .events = {kMessageTimer0, kPorts.size(), message_receiver::handle}},
    {.events = {kNetworkTimer0, kPorts.size(), network::handle}},
    {.power_up = freeport::power_up,
     .enter_run = freeport::follow_control,
     .enter_stop = freeport::enter_stop,
     .begin_service = freeport::begin_service},
    {.inputs_changed = high_speed_counters::inputs_changed},
    {.power_up = pulse_outputs::power_up,
     .enter_stop = pulse_outputs::enter_stop,
     .events = {kPulse0, 2, pulse_outputs::handle}},
    {.end_scan = forcing::end_scan},
    {.enter_stop = points::enter_stop, .end_scan = points::end_scan},
    {.power_up = eeprom::power_up, .end_scan = eeprom::end_scan},
    {.power_up = power::recall_ranges},
    {.power_up = forcing::power_up},
    {.power_up = clock::power_up},
};

/// Calls the functions of a column, row by row. The calls are chosen at compile time, because a scan may be short.
template <auto column, std::size_t row = 0, class... Arguments>
void each(Arguments&... arguments) {
  if constexpr (row < std::size(kUnits)) {
    (kUnits[row].*column)(arguments...);
    each<column, row + 1>(arguments...);
  }
}

}  // namespace

void power_up(Core& core, const RetentiveMemory* memory) {
  for (const Unit& unit : kUnits)
    for (std::uint8_t i = 0; i < unit.events.count; ++i) core.cancel(static_cast<std::uint8_t>(unit.events.first + i));
  each<&Unit::power_up>(core, memory);
}
void enter_run(Core& core) { each<&Unit::enter_run>(core); }
void enter_stop(Core& core) { each<&Unit::enter_stop>(core); }
void begin_scan(Core& core) { each<&Unit::begin_scan>(core); }
void end_scan(Core& core) { each<&Unit::end_scan>(core); }

void inputs_changed(Core& core, std::uint32_t byte, std::uint8_t changed, Time at) {
  each<&Unit::inputs_changed>(core, byte, changed, at);
}

void begin_service(Core& core, const QueuedInterrupt& interrupt) { each<&Unit::begin_service>(core, interrupt); }

void handle(Core& core, std::uint8_t what, Time at) {
  for (const Unit& unit : kUnits)
    if (what >= unit.events.first && what < unit.events.first + unit.events.count) return unit.events.handle(core, what, at);
  assert(false && "an event that no unit has scheduled");
}

}  // namespace s7200::units
