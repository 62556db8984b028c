#include "serial_sim/field/field.hpp"

#include <algorithm>
#include <utility>

namespace s7200::serial {

Field::Field(FieldScript script, Cpu& cpu, EventQueue& queue, EventOwner owner)
    : script_(std::move(script)), cpu_(cpu), queue_(queue), owner_(owner) {}

void Field::power_up(Time at) {
  state_ = {};
  play(at);
}

void Field::handle(const Event& event) { play(event.at); }

void Field::play(Time now) {
  for (; state_.next_change < script_.changes.size() && script_.changes[state_.next_change].at <= now;
       ++state_.next_change) {
    const FieldChange& change = script_.changes[state_.next_change];
    put(change.place, change.mask, change.value, change.at);
  }
  for (; state_.next_train < script_.pulses.size() && script_.pulses[state_.next_train].at <= now; ++state_.next_train)
    state_.running.push_back({state_.next_train, 0, script_.pulses[state_.next_train].at});
  for (Running& running : state_.running)
    while (running.next <= now) next_edge(running);
  std::erase_if(state_.running, [](const Running& running) { return running.next == kNever; });
  if (const Time next = next_due(); next != kNever) queue_.schedule(next, owner_, 0);
}

void Field::next_edge(Running& running) {
  const FieldPulses& train = script_.pulses[running.train];
  put(train.place, train.mask, running.edge % 2 == 0 ? train.mask : std::uint8_t{0}, running.next);
  ++running.edge;
  running.next = running.edge < train.edges() ? train.edge(running.edge) : kNever;
}

void Field::put(std::uint32_t place, std::uint8_t mask, std::uint8_t value, Time at) {
  const bool input = place >= image::kInputs && place < image::kOutputs;
  const std::uint8_t before = input ? cpu_.terminals(place - image::kInputs) : cpu_.state().image[place];
  const auto after = static_cast<std::uint8_t>((before & ~mask) | (value & mask));
  if (input)
    cpu_.set_input(place - image::kInputs, after, at);
  else
    cpu_.poke(place, {&after, 1});
}

Time Field::next_due() const {
  Time next = kNever;
  if (state_.next_change < script_.changes.size()) next = script_.changes[state_.next_change].at;
  if (state_.next_train < script_.pulses.size()) next = std::min(next, script_.pulses[state_.next_train].at);
  for (const Running& running : state_.running) next = std::min(next, running.next);
  return next;
}

}  // namespace s7200::serial
