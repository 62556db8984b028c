#include "tools/session/words/bad_pointers.hpp"

#include <fmt/format.h>

#include "interpreter/base/bytes.hpp"
#include "tools/session/causes/expression.hpp"

namespace s7200::tools {

std::vector<MemoryRange> bad_pointers(const Cpu& cpu, std::uint32_t number) {
  const Op& op = cpu.program().ops[number];
  const auto rules = op.instruction->rules();
  std::vector<MemoryRange> bad;
  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (rules[i].kind != OperandKind::Memory || !op[i].pointer || cpu.place_of(op[i])) continue;
    if (const auto pointer = range_at(op[i].at, Width::Double, *cpu.program().model)) bad.push_back(*pointer);
  }
  return bad;
}

std::string bad_pointer_text(const Cpu& cpu, const MemoryRange& pointer, std::string_view name, std::string_view address) {
  return fmt::format("{}: {} is 16#{:08X}, which points nowhere", name, address, load32(&cpu.state().image[pointer.at]));
}

}  // namespace s7200::tools
