#include "tools/views/state/memory_meaning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/model/special_bits.hpp"
#include "interpreter/model/special_memory.hpp"

namespace s7200::tools {
namespace {

/// Bytes of special memory that something other than the program writes (facts 2.1, 2.4, 4.3 to 4.5).
struct Writer {
  std::uint32_t first, last;
  std::string_view name;
};
constexpr Writer kWriters[]{{0, 0, "the CPU"},
                            {1, 1, "each instruction with flags"},
                            {2, 3, "the port"},
                            {4, 27, "the CPU"},
                            {28, 29, "the potentiometer"},
                            {36, 36, "the counter"},
                            {46, 46, "the counter"},
                            {56, 56, "the counter"},
                            {66, 66, "the pulse output"},
                            {76, 76, "the pulse output"},
                            {86, 86, "the port"},
                            {136, 136, "the counter"},
                            {146, 146, "the counter"},
                            {156, 156, "the counter"},
                            {166, 166, "the pulse output"},
                            {176, 176, "the pulse output"},
                            {186, 186, "the port"}};

std::string special_text(const CpuModel& model, const Bits& bits) {
  const auto at = static_cast<std::uint32_t>(bits.first / 8);
  const std::uint32_t first = at - image::kSM, last = static_cast<std::uint32_t>((bits.end() - 1) / 8) - image::kSM;
  std::vector<std::string> parts;
  if (bits.count == 1) {
    const std::string of_bit = special_meanings_text(at, static_cast<std::uint8_t>(1u << (bits.first % 8)));
    if (!of_bit.empty()) parts.push_back(of_bit);
  }
  if (parts.empty())
    for (const SpecialMemory& row : special_memory())
      if (row.first <= last && first <= row.last) {
        parts.emplace_back(row.on(model) == SpecialUse::Plain ? "no meaning on this CPU" : row.meaning);
        break;
      }
  const auto writer =
      std::ranges::find_if(kWriters, [&](const Writer& each) { return each.first <= last && first <= each.last; });
  if (writer != std::end(kWriters)) parts.push_back(fmt::format("{} writes it", writer->name));
  return stl::joined(
      parts, [](const std::string& part) { return part; }, "; ");
}

}  // namespace

std::string timer_text(std::uint32_t number) {
  const TimerBase timer = timer_base(number);
  return fmt::format("{}, {} ms", timer.retentive ? "TONR" : "TON", timer.base / kMillisecond);
}

std::string meaning_text(const CpuModel& model, const Bits& bits) {
  const Area area = area_of(bits);
  switch (area) {
    case Area::SM:
      return special_text(model, bits);
    case Area::T:
      return timer_text(static_cast<std::uint32_t>((bits.first / 8 - image::kT) / 2));
    case Area::I:
      return bits.count == 1 ? "input" : "inputs";
    case Area::Q:
      return bits.count == 1 ? "output" : "outputs";
    case Area::AI:
      return "analog input";
    case Area::AQ:
      return "analog output";
    case Area::C:
      return "counter";
    case Area::HC:
      return "high-speed counter";
    default:
      return {};
  }
}

}  // namespace s7200::tools
