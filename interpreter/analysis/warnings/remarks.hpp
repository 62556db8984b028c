// What is worth a look in a program, and may be meant so: panels and masters write memory, unions and clearing over several
// symbols are usual. So these are no warnings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/analysis/cross_reference.hpp"

namespace s7200 {

struct Remark {
  enum class Kind : std::uint8_t {
    NeverReset,        ///< a bit that S sets and no instruction ever switches off
    NeverSet,          ///< a bit that R resets, that a contact looks at, and that no instruction ever switches on
    SharedMemory,      ///< a symbol for a byte or a word inside the word of another one; instructions use both
    PastItsSymbol,     ///< a block that begins at a symbol and goes on over others
    MayPassItsSymbol,  ///< the same of a message or a table, if it becomes as long as it may
    OtherCoil,         ///< an output with a coil in every scan and one in a subroutine that is called under a condition
    WrittenWhole,  ///< an output with a coil, over which an instruction writes that under a condition writes more than the
                   ///< bit
    SwitchedOff    ///< LDN SM0.0 alone in front of an output: a rung that does nothing, or a coil that is always 0
  };
  Kind kind = Kind::NeverReset;
  Bits bits;                         ///< the bit; the memory of the inner symbol; the block
  std::vector<std::string> symbols;  ///< SharedMemory: the outer and the inner one; of a block: the first, then the others
  std::vector<std::uint32_t> ops;    ///< that set or reset it, use both, write the block; the coil, then what writes over it
};

/// By kind, then by memory. Accesses through pointers count as writing what they may reach. Empty for a program with errors.
std::vector<Remark> remarks_of(const Facts& facts, const CrossReference& reference);

}  // namespace s7200
