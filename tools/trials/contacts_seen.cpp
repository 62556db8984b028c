#include "tools/trials/contacts_seen.hpp"

#include <bit>

namespace s7200::tools {
namespace {

/// Orders of magnitude of a count: 1, 2, 3, 4 to 7, 8 to 15, 16 to 31, 32 to 127, and more.
std::uint8_t magnitude(std::uint16_t count) {
  if (count < 4) return static_cast<std::uint8_t>(1u << (count - 1));
  if (count < 32) return static_cast<std::uint8_t>(1u << std::bit_width(count));
  return count < 128 ? 1u << 6 : 1u << 7;
}

}  // namespace

ContactsSeen::ContactsSeen(const Cpu& cpu)
    : cpu_(cpu), counts_(2 * cpu.program().ops.size()), seen_(counts_.size()), numbers_(counts_.size()) {
  for (const Op& op : cpu.program().ops) {
    forms_.push_back(contact_form(*op.instruction));
    if (forms_.back().is_contact() && why_constant(op, forms_.back()).empty())
      contacts_.push_back(static_cast<std::uint32_t>(forms_.size() - 1));
  }
}

bool ContactsSeen::add_run() {
  bool news = new_number_;
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
  new_number_ = false;
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
