// The command status: the program with what each instruction last did beside it, as Micro/WIN's STL status shows it.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ostream>

#include "interpreter/stl/printer.hpp"
#include "tools/debugger/debugger.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint32_t kShown = 15, kBefore = 6;
constexpr Time kLookedAt = 2 * kSecond;

/// The last execution of each instruction of [first, end).
class Status final : public Observer {
 public:
  Status(std::uint32_t first, std::uint32_t end, const std::atomic<bool>* stop_request)
      : first_(first), end_(end), stop_request_(stop_request) {}

  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override { return !(stop_request_ && *stop_request_); }
  void instruction(const InstructionRecord& record) override {
    if (record.op >= first_ && record.op < end_) part_[record.op] = record;
  }

  /// The part that was played is over; what was found later stands.
  void end_part() {
    last.merge(part_);
    part_.clear();
  }
  bool complete() const { return last.size() == end_ - first_; }

  std::map<std::uint32_t, InstructionRecord> last;

 private:
  std::uint32_t first_, end_;
  const std::atomic<bool>* stop_request_;
  std::map<std::uint32_t, InstructionRecord> part_;
};

}  // namespace

Debugger::Error Debugger::status(const Arguments& arguments) {
  std::string why;
  const auto place = arguments.empty() ? current_op() : find_place(arguments, "status", why);
  if (!why.empty()) return why;
  const auto ops = static_cast<std::uint32_t>(simulation_.cpu().program().ops.size());
  const std::uint32_t at = place.value_or(0);
  const std::uint32_t first = arguments.empty() ? at - std::min(at, kBefore) : at;
  const std::uint32_t end = std::min(ops, first + kShown);
  Status status(first, end, options_.stop_request);
  const Moment start = history_.now();
  const Time oldest = start.time - std::min(start.time, kLookedAt);
  Time looked_at = start.time;
  history_.search_back(
      status, start, [&] { looked_at = simulation_.time(); },
      [&] {
        status.end_part();
        return status.complete() || looked_at <= oldest;
      });
  history_.go_to(start);
  const Program& program = simulation_.cpu().program();
  for (std::uint32_t op = first; op < end; ++op) {
    const auto found = status.last.find(op);
    out_ << fmt::format("{:>2} {}\n", mark_of(op),
                        found != status.last.end()
                            ? instruction_text(found->second)
                            : fmt::format("line {:<5} {:<28} not executed within {}", listing_.line_of(op),
                                          stl::to_text(program.statement(op)), format_duration(start.time - looked_at)));
  }
  return {};
}

Debugger::Error Debugger::expect(const Arguments& arguments) {
  std::string why;
  if (arguments.empty()) return expects("expect", "what must hold, for example: expect VW20 = 5 and M0.1");
  const auto expression = Expression::parse(joined(arguments), simulation_.cpu().program(), why);
  if (!expression) return why;
  if (!expression->holds(simulation_.cpu())) return fmt::format("expected {}, which does not hold here", expression->text());
  return {};
}

}  // namespace s7200::tools
