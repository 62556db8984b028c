#include "interpreter/trace/signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {
namespace {

constexpr std::string_view kAnyRoutine = "INT";

/// `INT123` or `INT 123`; nothing for another name.
std::optional<Signal> interrupt_of(const std::string& name) {
  const std::string upper = stl::upper_case(name);
  if (!upper.starts_with(kAnyRoutine)) return {};
  const std::string_view number = stl::trim(std::string_view(upper).substr(kAnyRoutine.size()));
  if (number.empty()) return Signal{.kind = Signal::Kind::Interrupts, .name = name};
  const auto routine = parse_decimal<std::uint8_t>(number);
  if (!routine) return {};
  return Signal{.kind = Signal::Kind::Interrupt, .name = fmt::format("INT{}", *routine), .routine = *routine};
}

constexpr std::string_view kPort = "PORT";

constexpr std::array<std::pair<std::string_view, PortLevel>, 3> kLevels{
    {{"RXD", PortLevel::Rxd}, {"TXD", PortLevel::Txd}, {"LINE", PortLevel::Line}}};

Signal level_signal(std::uint8_t port, std::string_view of, PortLevel level) {
  return {.kind = Signal::Kind::Level, .name = fmt::format("{}{}.{}", kPort, port, of), .port = port, .level = level};
}

/// `PORT0.TXD` or `PORT0`. Nothing to say of a name of another kind.
Result<Signal> level_of(const std::string& name, const AddressSpace& space) {
  const std::string upper = stl::upper_case(name);
  if (!upper.starts_with(kPort)) return std::nullopt;
  const std::size_t dot = std::min(upper.find('.'), upper.size());
  const auto port = parse_decimal<std::uint8_t>(std::string_view(upper).substr(kPort.size(), dot - kPort.size()));
  if (!port) return std::nullopt;
  if (*port >= space.model.ports)
    return trouble("{}: the CPU {} has no port {}", stl::shortened(name), space.model.name, *port);
  if (dot == upper.size()) return Signal{.kind = Signal::Kind::Levels, .name = name, .port = *port};
  for (const auto& [of, level] : kLevels)
    if (upper.substr(dot + 1) == of) return level_signal(*port, of, level);
  return trouble("{}: the levels of a port are RXD, TXD and LINE", stl::shortened(name));
}

Result<Signal> signal_of(const std::string& name, const AddressSpace& space) {
  if (auto interrupt = interrupt_of(name)) return *interrupt;
  if (auto level = level_of(name, space); level || !level.why().empty()) return level;
  const auto place = parse_range(name, space);
  if (!place) return place.trouble();
  if (place->count == 1) return Signal{.kind = Signal::Kind::Memory, .name = name, .place = *place};
  return trouble("{} is several values; name each", stl::shortened(name));
}

}  // namespace

Result<std::vector<Signal>> parse_signals(std::string_view text, const AddressSpace& space) {
  std::vector<Signal> signals;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const auto signal = signal_of(std::string(stl::trim(text.substr(0, comma))), space);
    if (!signal) return signal.trouble();
    signals.push_back(*signal);
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  if (!signals.empty()) return signals;
  return Trouble{"there is no signal; name some, for example Q0.0,VW20,INT"};
}

std::vector<Signal> signals_of(const std::vector<Signal>& wanted, const Program& program) {
  std::vector<Signal> all;
  for (const Signal& one : wanted) {
    if (one.kind == Signal::Kind::Levels) {
      for (const auto& [of, level] : kLevels) all.push_back(level_signal(one.port, of, level));
    } else if (one.kind == Signal::Kind::Interrupts) {
      for (std::size_t number = 0; number < program.interrupt.size(); ++number)
        if (program.interrupt[number] != kNoRoutine)
          all.push_back({.kind = Signal::Kind::Interrupt,
                         .name = fmt::format("INT{}", number),
                         .routine = static_cast<std::uint8_t>(number)});
    } else {
      all.push_back(one);
    }
  }
  return all;
}

}  // namespace s7200
