#include "tools/debugger/asked_by.hpp"

#include "serial_sim/modbus/answer.hpp"

namespace s7200::tools {

std::string wrong_with(std::span<const std::uint8_t> request, std::span<const std::uint8_t> answer,
                       std::string_view damage) {
  if (!damage.empty() || !is_rtu_frame(request)) return std::string(damage);
  return modbus::check_answer(request, answer).fault;
}

}  // namespace s7200::tools
