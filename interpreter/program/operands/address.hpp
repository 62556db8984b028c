// Addresses as people write them outside a program: `VB0:16` to look, `VW100=5` to set.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {

/// `count` objects of `width`, starting at an address.
struct MemoryRange {
  Area area{};
  Width width{};
  std::uint32_t number = 0;  ///< byte, or number of a T, C, HC or AC
  std::uint8_t bit = 0;
  std::uint32_t count = 1;
  std::uint32_t at = 0;  ///< in the image
  bool real = false;     ///< the double words are real numbers

  std::uint32_t bytes() const { return width == Width::Bit ? 1 : count * bytes_of(width); }
  /// Address of object `i` of the range.
  std::string name_of(std::uint32_t i) const;
  /// The bytes of the range as they lie in an image; of a bit, 00 or 01.
  std::vector<std::uint8_t> bytes_in(std::span<const std::uint8_t> image) const;
};

/// Addresses are looked up here: in the areas of a CPU, and among the symbols of its program if there is one.
struct AddressSpace {
  AddressSpace(const CpuModel& of_cpu) : model(of_cpu) {}
  AddressSpace(const CpuModel& of_cpu, const std::vector<stl::Symbol>& of_program) : model(of_cpu), symbols(&of_program) {}
  AddressSpace(const Program& program) : model(*program.model), symbols(&program.source.symbols) {}

  const CpuModel& model;
  const std::vector<stl::Symbol>* symbols = nullptr;
};

/// `VB0:16`, `M31.7`, `AC0`, `T5`, `VD20:real`, `VD20:4:real`; `Speed`, `"Pump 1"` for a symbol's address. Bits have no
/// count. Trouble if the text is not an address of this CPU.
Result<MemoryRange> parse_range(std::string_view text, const AddressSpace& space);

/// `&VB100`: what a pointer to that address holds. Trouble if the text is none.
Result<std::uint32_t> parse_pointer(std::string_view text, const AddressSpace& space);

struct Assignment {
  MemoryRange place;  ///< real if the value was written as one
  std::uint32_t value = 0;
};

/// `VW100=5`, `VB0=16#FF`, `I0.3=1`, `VD4=1.5`, `VD4:real=2`, `VD4=&VB100`.
Result<Assignment> parse_assignment(std::string_view text, const AddressSpace& space);

/// The value alone, for a place that is known.
std::optional<Assignment> parse_value(const MemoryRange& place, std::string_view value);

/// The values that may be written there: `a byte is -128 to 255`, `a word is -32768 to 65535, and T37 counts 100 ms`.
std::string values_text(const MemoryRange& place);

}  // namespace s7200
