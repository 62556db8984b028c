#include "tools/trials/contacts_seen.hpp"

#include <bit>
#include <string_view>

#include "interpreter/model/special_memory.hpp"

namespace s7200::tools {
namespace {

bool is_always_on(const Op& op) { return !op[0].pointer && op[0].at == image::kSM && op[0].bit == 0; }

/// Orders of magnitude of a count: 1, 2, 3, 4 to 7, 8 to 15, 16 to 31, 32 to 127, and more.
std::uint8_t magnitude(std::uint16_t count) {
  if (count < 4) return static_cast<std::uint8_t>(1u << (count - 1));
  if (count < 32) return static_cast<std::uint8_t>(1u << std::bit_width(count));
  return count < 128 ? 1u << 6 : 1u << 7;
}

}  // namespace

ContactsSeen::ContactsSeen(const Program& program)
    : kinds_(program.ops.size()), counts_(2 * program.ops.size()), seen_(2 * program.ops.size()) {
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
    const Op& of = program.ops[op];
    const std::string_view name = of.instruction->mnemonic;
    if (!of.is_contact || of.instruction->rules().empty() || name == "LPS" || name.starts_with("LDS")) continue;
    const bool bit = of.instruction->rules().front().width == Width::Bit;
    kinds_[op] = bit              ? Kind::Bit
                 : name[0] == 'A' ? Kind::ComparisonAnd
                 : name[0] == 'O' ? Kind::ComparisonOr
                                  : Kind::Comparison;
    if (!bit || !is_always_on(of)) contacts_.push_back(op);
  }
}

bool ContactsSeen::add_run() {
  bool news = false;
  for (const std::uint32_t index : touched_) {
    const std::uint8_t is = magnitude(counts_[index]);
    news |= (seen_[index] & is) == 0;
    seen_[index] |= is;
  }
  forget_run();
  return news;
}

void ContactsSeen::forget_run() {
  for (const std::uint32_t index : touched_) counts_[index] = 0;
  touched_.clear();
}

std::vector<ContactsSeen::Never> ContactsSeen::never() const {
  std::vector<Never> all;
  for (const std::uint32_t op : contacts_) {
    const bool open = seen_[2 * op] != 0, closed = seen_[2 * op + 1] != 0;
    if (!open || !closed) all.push_back({op, closed, open});
  }
  return all;
}

}  // namespace s7200::tools
