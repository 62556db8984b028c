#include "interpreter/program/loading/unread.hpp"

#include <algorithm>

namespace s7200 {

const Instruction& unread_instruction() {
  static constexpr Instruction kUnreadStatement{.effect = Effect::ConditionalEnd};
  return kUnreadStatement;
}

bool has_unread(const Program& program) { return std::ranges::any_of(program.ops, is_unread); }

}  // namespace s7200
