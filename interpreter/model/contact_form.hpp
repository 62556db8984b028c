// How an instruction is a contact: what it looks at, and how it meets what is on the logic stack.
#pragma once

#include <cstdint>

#include "interpreter/model/instruction.hpp"
#include "interpreter/model/relation.hpp"

namespace s7200 {

struct ContactForm {
  enum class Kind : std::uint8_t { None, Bit, Numbers, Strings, Not, Rising, Falling, Eno };
  enum class Type : std::uint8_t { Byte, Word, Double, Real };

  Kind kind = Kind::None;
  Join join = Join::And;  ///< NOT, EU, ED and AENO work on what is there, as a contact in series does
  bool inverted = false;  ///< LDN, AN, ON and their immediate forms
  Type type = Type::Byte;
  Relation relation = Relation::Equal;

  bool is_contact() const { return kind != Kind::None; }
  bool is_edge() const { return kind == Kind::Rising || kind == Kind::Falling; }
  bool compares() const { return kind == Kind::Numbers || kind == Kind::Strings; }
};

ContactForm contact_form(const Instruction& instruction);

/// Whether a comparison of numbers holds: bytes are unsigned, words and double words signed (facts 6.3). `a`, `b`: the bits
/// of the operands.
bool compares(const ContactForm& form, std::uint32_t a, std::uint32_t b);

}  // namespace s7200
