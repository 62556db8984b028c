// The contacts of a program, and whether power flows through them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "interpreter/cpu/cpu.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/program/program.hpp"

namespace s7200::tools {

/// Whether power flows through a contact that has just been executed, whatever reaches it from the left; of NOT, EU and ED
/// whether any leaves them. In a segment that is off the rail feeds nothing. Returns nothing if the contact has seen
/// nothing: an error of a comparison has stopped the CPU.
std::optional<bool> lets_through(const Cpu& cpu, const Op& op, const ContactForm& form, const InstructionRecord& record);

/// Why a contact is always closed or always open, whatever is tried: `SM0.0 is always 1`. Empty of one that may change.
std::string why_constant(const Op& op, const ContactForm& form);

/// The state of such a contact.
bool is_always_closed(const Program& program, const Op& op, const ContactForm& form);

}  // namespace s7200::tools
