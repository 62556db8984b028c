// One operand: checked against the rule of its instruction and given its place in the image.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {

/// The program's constants, each once, as they will be in the image.
class ConstantPool {
 public:
  /// Place in the image of a constant of `width` bytes.
  std::uint32_t place(std::uint32_t value, std::uint32_t width);
  /// Place of a string: its length byte, then its characters.
  std::uint32_t place(const std::string& characters);
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> places_;
  std::map<std::string, std::uint32_t> texts_;
  std::vector<std::uint8_t> bytes_;
};

/// A checked operand.
struct PlacedOperand {
  Operand operand;
  std::optional<Area> area;              ///< of a direct address
  std::optional<std::int64_t> constant;  ///< the value of a constant as the instruction reads it, or a plain number
  bool read = true;                      ///< false: it has an error
};

/// The cause of the diagnostics about names that nothing defines: often a symbol table that was not given.
inline constexpr const char* kUndefinedSymbols = "symbols";

/// Checks `written` against `rule` on `model`; adds a diagnostic and returns nothing if it does not fit.
std::optional<PlacedOperand> place_operand(const Instruction& instruction, const OperandRule& rule,
                                           const stl::Operand& written, const CpuModel& model, ConstantPool& constants,
                                           stl::Diagnostics& diagnostics);

/// Whether an address says how wide it is, by a letter or by its area: `V100` does not.
bool names_width(const stl::Address& address, Area area);

/// The width that an address names; nothing for an accumulator without a letter, which takes any width.
std::optional<Width> width_of(const stl::Address& address, Area area);

/// `bit`, `byte`, `word` or `double word`.
std::string_view name_of(Width width);

/// The value of a pointer to an address; nothing of an area or a bit that none can point to.
std::optional<std::uint32_t> pointer_to(const CpuModel& model, Area area, Width width, std::uint32_t number);

/// `a pointer can point to bytes of I, Q, M, V or S, or …`: what pointer_to() takes.
std::string pointer_targets_text(const CpuModel& model);

/// `VB100`, `T33`, `M31.7`: the text of an address.
std::string address_text(Area area, Width width, std::uint32_t number, std::uint8_t bit);

/// `VB100`: the byte at a place in the image.
std::string byte_text(std::uint32_t place);

/// `VB0 to VB4095`: what there is of an area on a CPU.
std::string range_text(const CpuModel& model, Area area, Width width);

}  // namespace s7200
