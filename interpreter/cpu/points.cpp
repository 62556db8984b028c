// The input and output points themselves, and the EEPROM behind V memory.
#include <algorithm>

#include "interpreter/cpu/cpu.hpp"

namespace s7200 {

static constexpr std::uint32_t kSaveRequest = image::kSM + 31;

void Cpu::set_input(std::uint32_t byte, std::uint8_t value, Time at) {
  std::uint8_t& input = s.image[image::kInputs + byte];
  const std::uint8_t before = input, changed = before ^ value;
  input = value;
  if (changed == 0 || byte > 1) return;
  for (std::uint8_t point = 0; byte == 0 && point < 4; ++point)  // events 0–7: rising and falling edges of I0.0–I0.3
    if (changed & (1 << point)) occurred(static_cast<std::uint8_t>(2 * point + (before >> point & 1)), at);
  for (std::uint8_t number = 0; number < s.counter.size(); ++number) {
    if (!s.counter[number].defined) continue;
    for (std::uint8_t bit = 0; bit < 8; ++bit)
      if (changed & (1 << bit)) counter_sees(number, static_cast<std::uint8_t>(byte * 8 + bit), value >> bit & 1, at);
  }
}

bool Cpu::pulses_drive(std::uint32_t byte, std::uint8_t bit) const {
  return byte == 0 && bit < s.pulse.size() && s.pulse[bit].running;
}

/// Writes an output byte; the points of running pulse outputs keep their level.
void Cpu::put_output_byte(std::uint32_t byte, std::uint8_t value, Time at) {
  for (std::uint8_t output = 0; output < s.pulse.size(); ++output) {
    const auto mask = static_cast<std::uint8_t>(1u << output);
    if (pulses_drive(byte, output)) value = static_cast<std::uint8_t>((value & ~mask) | (s.image[image::kOutputs] & mask));
  }
  std::uint8_t& point = s.image[image::kOutputs + byte];
  if (point == value) return;
  point = value;
  trace({.at = at, .kind = TraceKind::OutputChanged, .byte = value, .op = byte});
}

void Cpu::put_output_point(std::uint32_t byte, std::uint8_t bit, bool value, Time at) {
  std::uint8_t& point = s.image[image::kOutputs + byte];
  const auto mask = static_cast<std::uint8_t>(1u << bit);
  const auto after = static_cast<std::uint8_t>(value ? point | mask : point & ~mask);
  if (point == after) return;
  point = after;
  trace({.at = at, .kind = TraceKind::OutputChanged, .byte = after, .op = byte});
}

void Cpu::write_output_point(std::uint32_t byte, std::uint8_t bit, bool value) {
  if (!pulses_drive(byte, bit)) put_output_point(byte, bit, value, s.time);
}

void run_with_analog_output(Cpu& cpu, const Op& op) {
  std::array<std::uint8_t, image::kT - image::kAQ> before{};
  std::copy_n(cpu.s.image.begin() + image::kAQ, before.size(), before.begin());
  if (op.has_pointer)
    run_with_pointers(cpu, op);
  else
    op.instruction->body(cpu, op);
  cpu.analog_outputs_written(before.data());
}

void Cpu::analog_outputs_written(const std::uint8_t* before) {
  for (std::uint32_t word = 0; word < program_->model->size_of(Area::AQ); word += 2) {
    const std::uint16_t value = load16(&s.image[image::kAQ + word]);
    if (value != load16(before + word)) trace({.at = s.time, .kind = TraceKind::AnalogChanged, .op = word, .count = value});
  }
}

void Cpu::write_outputs() {
  for (std::uint32_t byte = 0; byte < program_->model->size_of(Area::Q); ++byte)
    put_output_byte(byte, s.image[image::kQ + byte], s.time);
}

void Cpu::clear_outputs() {
  for (std::uint8_t output = 0; output < s.pulse.size(); ++output)
    if (s.pulse[output].running) end_pulses(output);
  for (std::uint32_t byte = 0; byte < program_->model->size_of(Area::Q); ++byte) put_output_byte(byte, 0, s.time);
}

/// SM31.7 asks for one V value to be saved to EEPROM: SM31.1–0 its size, SMW32 its offset. It is saved at the end of the
/// scan, which takes so much longer; then the bit is reset (S7-200 manual C230-02, 7-16). False when nothing is to be saved.
/// Not documented, modelled so:
/// - A save takes 17.5 ms, the middle of the 15 to 20 ms that the manual calls typical; `s7200 times` lists it.
///   [Eeprom.ASaveProlongsItsScanByTheTimeInTheTable]
/// - Interrupts are served during a save; it takes the value that V has at its start.
///   [Eeprom.InterruptsAreServedDuringASaveOfTheValueAtItsStart]
/// - A value outside the part of V that the EEPROM holds is error 0094, and the scan takes no longer.
///   [Eeprom.TheLastAddressIsV1023AndBeyondItIs0094, Eeprom.ARefusedSaveTakesNoTime]
bool Cpu::begin_save_to_eeprom() {
  const std::uint8_t request = s.image[kSaveRequest];
  if (!(request & 0x80)) return false;
  const std::uint32_t bytes = (request & 3) == 3 ? 4 : (request & 3) == 2 ? 2 : 1;
  const std::uint32_t offset = load16(&s.image[image::kSM + 32]);
  if (offset + bytes > program_->model->eeprom_bytes) {
    end_save_to_eeprom();
    run_error(RunError::EepromRange);
    return false;
  }
  std::copy_n(s.image.begin() + image::kV + offset, bytes, s.eeprom.begin() + offset);
  return true;
}

void Cpu::end_save_to_eeprom() { s.image[kSaveRequest] &= 0x7F; }

}  // namespace s7200
