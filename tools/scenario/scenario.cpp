#include "tools/scenario/scenario.hpp"

#include <algorithm>
#include <bit>

#include "interpreter/base/bytes.hpp"

namespace s7200::tools {
namespace {

/// As an instruction reads the value.
double value_of(const MemoryRange& range, bool is_signed, const std::vector<std::uint8_t>& bytes) {
  switch (range.width) {
    case Width::Bit:
    case Width::Byte:
      return bytes[0];
    case Width::Word: {
      const std::uint16_t value = load16(bytes.data());
      return is_signed ? static_cast<std::int16_t>(value) : value;
    }
    case Width::Double: {
      const std::uint32_t value = load32(bytes.data());
      if (range.real) return std::bit_cast<float>(value);
      return is_signed ? static_cast<std::int32_t>(value) : static_cast<double>(value);
    }
  }
  return 0;
}

}  // namespace

Time Span::in(const SerialFormat& format) const {
  if (fixed == kNever) return kNever;
  const std::int64_t divisor = 1000 * std::int64_t{format.baud};
  return fixed + (millicharacters * format.bits() * kSecond + divisor / 2) / divisor;
}

bool MemoryExpected::fits(const std::vector<std::uint8_t>& found) const {
  if (limits) {
    const double value = value_of(range, limits->is_signed, found);
    return value >= limits->from && value <= limits->to;
  }
  return std::equal(bytes.begin(), bytes.end(), found.begin(), found.end(),
                    [](const BytePattern& pattern, std::uint8_t byte) { return !pattern || *pattern == byte; });
}

const Reception* reception_of(const Step& step) {
  if (const auto* exchange = std::get_if<ExchangeStep>(&step.action)) return exchange;
  return std::get_if<ReceiveStep>(&step.action);
}

bool looks_inside(const Step& step) {
  return std::holds_alternative<MemoryStep>(step.action) || std::holds_alternative<InterruptsStep>(step.action) ||
         std::holds_alternative<ModeStep>(step.action) || std::holds_alternative<FatalStep>(step.action) ||
         std::holds_alternative<ErrorsStep>(step.action);
}

bool acts_inside(const Step& step) {
  if (const auto* wait = std::get_if<WaitStep>(&step.action)) return wait->scans != 0;
  return reception_of(step) == nullptr && !looks_inside(step);
}

}  // namespace s7200::tools
