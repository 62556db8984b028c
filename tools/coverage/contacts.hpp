// The contacts of a program, and whether power flows through them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "interpreter/cpu/cpu.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/program/program.hpp"

namespace s7200::tools {

/// How an instruction is a contact.
struct ContactForm {
  enum class Kind : std::uint8_t { None, Bit, Numbers, Strings, Not, Rising, Falling, Eno };
  enum class Type : std::uint8_t { Byte, Word, Double, Real };
  enum class Relation : std::uint8_t { Equal, NotEqual, Greater, GreaterEqual, Less, LessEqual };

  Kind kind = Kind::None;
  Join join = Join::And;  ///< NOT, EU, ED and AENO work on what is there, as a contact in series does
  bool inverted = false;  ///< LDN, AN, ON and their immediate forms
  Type type = Type::Byte;
  Relation relation = Relation::Equal;

  bool is_contact() const { return kind != Kind::None; }
  bool is_edge() const { return kind == Kind::Rising || kind == Kind::Falling; }
};

ContactForm contact_form(const Op& op);

/// Whether power flows through a contact that has just been executed, whatever reaches it from the left; of NOT, EU and ED
/// whether any leaves them. In a segment that is off the rail feeds nothing. Returns nothing if the contact has seen
/// nothing: an error of a comparison has stopped the CPU.
std::optional<bool> lets_through(const Cpu& cpu, const Op& op, const ContactForm& form, const InstructionRecord& record);

/// Why a contact is always closed or always open, whatever is tried: `SM0.0 is always 1`. Empty of one that may change.
std::string why_constant(const Op& op, const ContactForm& form);

/// The state of such a contact.
bool is_always_closed(const Program& program, const Op& op, const ContactForm& form);

}  // namespace s7200::tools
