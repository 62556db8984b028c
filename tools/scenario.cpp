#include "tools/scenario.hpp"

namespace s7200::tools {

Time Span::in(const SerialFormat& format) const {
  if (fixed == kNever) return kNever;
  const std::int64_t divisor = 1000 * std::int64_t{format.baud};
  return fixed + (millicharacters * format.bits() * kSecond + divisor / 2) / divisor;
}

bool looks_inside(const Step& step) {
  return std::holds_alternative<MemoryStep>(step.action) || std::holds_alternative<InterruptsStep>(step.action) ||
         std::holds_alternative<ModeStep>(step.action) || std::holds_alternative<FatalStep>(step.action) ||
         std::holds_alternative<ErrorsStep>(step.action);
}

bool acts_inside(const Step& step) {
  if (const auto* wait = std::get_if<WaitStep>(&step.action)) return wait->scans != 0;
  return !std::holds_alternative<ExchangeStep>(step.action) && !looks_inside(step);
}

}  // namespace s7200::tools
