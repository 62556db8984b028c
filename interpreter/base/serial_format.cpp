#include "interpreter/base/serial_format.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/counted.hpp"

namespace s7200 {
namespace {

std::string_view parity_text(Parity parity) {
  return parity == Parity::None ? "no parity" : parity == Parity::Even ? "even parity" : "odd parity";
}

}  // namespace

std::string format_text(const SerialFormat& format) {
  return fmt::format("{} baud, {} data bits, {}, {}", format.baud, format.data_bits, parity_text(format.parity),
                     counted(format.stop_bits, "stop bit"));
}

std::string character_text(const SerialFormat& format) {
  const char parity = format.parity == Parity::None ? 'N' : format.parity == Parity::Even ? 'E' : 'O';
  return fmt::format("{}{}{}", format.data_bits, parity, format.stop_bits);
}

}  // namespace s7200
