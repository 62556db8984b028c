#include "tools/session/past/digest.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "interpreter/stl/printer.hpp"
#include "tools/session/past/state_members.hpp"

namespace s7200::tools {
namespace {

template <class T>
constexpr bool kIsNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// FNV-1a.
class Digest {
 public:
  void add(const void* data, std::size_t size) {
    for (const auto* byte = static_cast<const std::uint8_t*>(data); size > 0; --size, ++byte)
      sum_ = (sum_ ^ *byte) * 0x100000001B3;
  }
  void add(std::string_view text) { add(text.data(), text.size()); }

  template <class T>
  requires kIsNumber<T>
  void add(T number) {
    const auto bits = static_cast<std::uint64_t>(number);
    add(&bits, sizeof bits);
  }

  template <class T, std::size_t N>
  void add(const std::array<T, N>& all) {
    if constexpr (kIsNumber<T> && sizeof(T) == 1)
      add(all.data(), N);
    else
      for (const T& one : all) add(one);
  }

  template <class T>
  void add(const std::optional<T>& one) {
    add(one.has_value());
    if (one) add(*one);
  }

  void add(const LogicStack& stack) { add(stack.bits()); }

  template <class T>
  requires std::is_class_v<T>
  void add(const T& part) {
    std::apply([this](const auto&... member) { (this->add(member), ...); }, members(part));
  }

  std::string text() const { return fmt::format("{:016x}", sum_); }

 private:
  std::uint64_t sum_ = 0xCBF29CE484222325;
};

}  // namespace

std::string digest_of(std::string_view text) {
  Digest digest;
  digest.add(text);
  return digest.text();
}

std::string digest_of(const Program& program) {
  Digest digest;
  digest.add(program.model->name);
  for (std::uint32_t number = 0; number < program.ops.size(); ++number) {
    const Op& op = program.ops[number];
    const stl::Statement& statement = program.statement(number);
    digest.add(std::string_view(stl::to_text(statement)));
    digest.add(statement.position.line);
    digest.add(op.cost);
    digest.add(op.unit_cost);
    digest.add(op.target);
  }
  digest.add(program.constants.data(), program.constants.size());
  for (const InitialData& data : program.data) {
    digest.add(data.offset);
    digest.add(data.bytes.data(), data.bytes.size());
  }
  for (const Time time : {program.no_power_flow, program.interrupt_entry, program.eeprom_save}) digest.add(time);
  for (const Time time : program.scan_phase) digest.add(time);
  for (const std::uint32_t baud : program.system_block.ppi_rates) digest.add(baud);
  for (const std::uint8_t station : program.system_block.ppi_stations) digest.add(station);
  digest.add(program.system_block.second_request);
  if (program.system_block.retentive) digest.add(std::string_view(to_text(*program.system_block.retentive)));
  return digest.text();
}

std::string digest_of(const State& state) {
  Digest digest;
  digest.add(state);
  return digest.text();
}

std::string digest_of(const serial::FieldScript& script) {
  Digest digest;
  for (const serial::FieldChange& change : script.changes) {
    digest.add(change.at);
    digest.add(change.place);
    digest.add(change.mask);
    digest.add(change.value);
  }
  for (const serial::FieldPulses& pulses : script.pulses) {
    digest.add(pulses.at);
    digest.add(pulses.place);
    digest.add(pulses.mask);
    digest.add(pulses.pulses);
    digest.add(pulses.millihertz);
  }
  return digest.text();
}

}  // namespace s7200::tools
