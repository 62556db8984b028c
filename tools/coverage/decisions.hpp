// What the outputs of a program depend on: the condition of each coil and box, as the logic stack works it out from
// contacts.
//
// A condition is followed from the begin of its network, label or routine. What was on the logic stack there before is not
// known, and an output that depends on it is left out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/coverage/contacts.hpp"

namespace s7200::tools {

/// The condition of a coil, of a box, or of one of a box's inputs.
struct Decision {
  /// A part of the condition. Operands come before the gates that use them, and the last gate is the condition.
  struct Gate {
    enum class Kind : std::uint8_t { True, Contact, Not, And, Or, Rising, Falling } kind = Kind::True;
    std::uint32_t a = 0;  ///< of Contact: in `contacts`; of all others a gate
    std::uint32_t b = 0;  ///< a gate; of Rising and Falling: in `contacts`
  };

  std::uint32_t op = 0;  ///< the coil or box
  std::vector<Gate> gates{};
  std::vector<std::uint32_t> contacts{};  ///< ops, in their order; EU and ED among them
};

/// The conditions of a program, in the order of its ops. Of several outputs with the same condition the first has it.
struct Decisions {
  std::vector<Decision> all;
  std::vector<bool> constant_input;  ///< by op, of NOT, EU and ED: what reaches them never changes
};

Decisions decisions_of(const Program& program, const std::vector<ContactForm>& forms);

/// What contacts saw when a condition was worked out, by their places in Decision::contacts.
struct SeenContacts {
  std::vector<bool> closed;
  std::vector<bool> before;  ///< of EU and ED: what reached them at their execution before this one

  bool operator==(const SeenContacts&) const = default;
};

/// How a contact was when it decided alone, a bit each: if it alone had been otherwise, the condition would have been
/// otherwise too.
enum Alone : std::uint8_t { kOpenOff = 1, kOpenOn = 2, kClosedOff = 4, kClosedOn = 8 };

/// Whether a contact was seen open and closed where it decided alone, with the condition off once and on once: modified
/// condition/decision coverage in its masking form.
constexpr bool has_decided(std::uint8_t alone) {
  return ((alone & kOpenOff) && (alone & kClosedOn)) || ((alone & kOpenOn) && (alone & kClosedOff));
}

/// Adds to `alone`, by contact, which ones have decided alone.
void find_deciding(const Decision& decision, const SeenContacts& seen, std::vector<std::uint8_t>& alone);

}  // namespace s7200::tools
