// Power-up, and what outlasts power off (facts 1.6).
//
// RAM intact: the retentive ranges of the model keep their values, V that is not retentive is loaded from the EEPROM, all
// else is 0, and the clock has gone on. RAM lost: V is loaded from the EEPROM, all else is 0, SM0.2 is 1 during the first
// scan, and the clock starts anew.
#include <algorithm>

#include "interpreter/cpu/cpu.hpp"

namespace s7200 {

void Cpu::power_up(bool run, const RetentiveMemory* memory) {
  for (const std::uint8_t what : {kTimedInterrupt0, kTimedInterrupt1, kTick1ms, kPulse0, kPulse1})
    queue_.cancel(EventOwner::Cpu, what);
  s = State{};
  s.attached.fill(kNotAttached);
  std::copy(program_->constants.begin(), program_->constants.end(), s.image.begin() + image::kConstants);
  for (const Op& op : program_->ops)
    if (op.instruction->hidden == Hidden::RisingMemory) put_bit(op[2].at, op[2].bit, true);
  s.counter_inputs.fill(3);
  for (const std::uint32_t idle : {image::kSM + 66, image::kSM + 76}) s.image[idle] = 0x80;
  s.image[image::kSM] = 0x09;   // SM0.0 always 1; SM0.3: RUN was entered from power-up
  s.image[image::kSM4] = 0x60;  // both transmitters idle
  s.image[image::kSM + 6] = program_->model->identification;
  if (memory) recall(*memory);
  if (run) enter_run();
  begin_scan();
}

void Cpu::recall(const RetentiveMemory& memory) {
  s.eeprom = memory.eeprom;
  std::copy_n(s.eeprom.begin(), program_->model->eeprom_bytes, s.image.begin() + image::kV);
  put_bit(image::kSM, 2, memory.ram_lost);
  if (memory.ram_lost) return;
  for (const RetentiveRange& range : program_->model->retentive)
    std::copy_n(memory.image.begin() + range.at(), range.bytes(), s.image.begin() + range.at());
  set_clock(clock_after(memory.clock, memory.power_off));
}

RetentiveMemory Cpu::retentive_memory() const {
  RetentiveMemory memory{.eeprom = s.eeprom, .clock = clock()};
  for (const RetentiveRange& range : program_->model->retentive)
    std::copy_n(s.image.begin() + range.at(), range.bytes(), memory.image.begin() + range.at());
  return memory;
}

}  // namespace s7200
