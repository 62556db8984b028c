// Finding an instruction by its mnemonic, and how it is written.
#include <string>
#include <unordered_map>

#include "interpreter/model/instruction.hpp"

namespace s7200 {

const Instruction* find_instruction(std::string_view mnemonic) {
  static const std::unordered_map<std::string_view, const Instruction*> kIndex = [] {
    std::unordered_map<std::string_view, const Instruction*> index;
    for (const Instruction& instruction : all_instructions()) index.emplace(instruction.mnemonic, &instruction);
    return index;
  }();
  const auto found = kIndex.find(mnemonic);
  return found == kIndex.end() ? nullptr : found->second;
}

std::string syntax(const Instruction& instruction) {
  std::string text(instruction.mnemonic);
  const char* separator = " ";
  for (const OperandRule& rule : instruction.rules()) {
    text.append(separator).append(rule.name);
    separator = ", ";
  }
  return text;
}

}  // namespace s7200
