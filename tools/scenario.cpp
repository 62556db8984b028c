#include "tools/scenario.hpp"

namespace s7200::tools {

Time Span::in(const SerialFormat& format) const {
  if (fixed == kNever) return kNever;
  const std::int64_t divisor = 1000 * std::int64_t{format.baud};
  return fixed + (millicharacters * format.bits() * kSecond + divisor / 2) / divisor;
}

bool needs_inside(const Step& step) {
  const bool outside = std::holds_alternative<ExchangeStep>(step.action) ||
                       (std::holds_alternative<WaitStep>(step.action) && std::get<WaitStep>(step.action).scans == 0);
  return !outside;
}

}  // namespace s7200::tools
