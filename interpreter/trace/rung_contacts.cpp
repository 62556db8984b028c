#include "interpreter/trace/rung_contacts.hpp"

#include <algorithm>
#include <string_view>

namespace s7200 {
namespace {

/// The logic stack with the contacts that have made each of its levels, as places in the rung.
class ContactStack {
 public:
  /// False if it has not as many levels.
  bool step(const Op& op, std::size_t place) {
    const std::string_view mnemonic = op.instruction->mnemonic;
    if (mnemonic == "LPS") return copy(0);
    if (mnemonic == "LPP") return pop();
    if (mnemonic == "LRD") return pop() && copy(0);
    if (mnemonic == "LDS") return copy(op[0].at);
    if (mnemonic == "ALD" || mnemonic == "OLD") return join(place);
    if (mnemonic.starts_with("LD")) levels_.emplace_back();
    if (levels_.empty()) return false;
    levels_.back().push_back(place);
    return true;
  }

  const std::vector<std::size_t>& top() const { return levels_.back(); }

 private:
  bool copy(std::size_t depth) {
    if (depth >= levels_.size()) return false;
    std::vector<std::size_t> level = levels_[levels_.size() - 1 - depth];
    levels_.push_back(std::move(level));
    return true;
  }
  bool pop() {
    if (levels_.size() < 2) return false;
    levels_.pop_back();
    return true;
  }
  /// Both may have come from the same branch.
  bool join(std::size_t place) {
    if (levels_.size() < 2) return false;
    const std::vector<std::size_t> last = std::move(levels_.back());
    levels_.pop_back();
    std::vector<std::size_t>& level = levels_.back();
    for (const std::size_t one : last)
      if (std::ranges::find(level, one) == level.end()) level.push_back(one);
    std::ranges::sort(level);
    level.push_back(place);
    return true;
  }

  std::vector<std::vector<std::size_t>> levels_{};
};

}  // namespace

std::vector<InstructionRecord> contacts_of_top(const Program& program, const std::vector<InstructionRecord>& executed) {
  ContactStack stack;
  for (std::size_t place = 0; place < executed.size(); ++place)
    if (!stack.step(program.ops[executed[place].op], place)) return executed;
  std::vector<InstructionRecord> contacts;
  if (!executed.empty())
    for (const std::size_t place : stack.top()) contacts.push_back(executed[place]);
  return contacts;
}

}  // namespace s7200
