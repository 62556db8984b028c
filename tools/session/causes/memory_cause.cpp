#include "tools/session/causes/memory_cause.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "interpreter/trace/statement_text.hpp"
#include "interpreter/trace/trace_reasons.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/causes/last_write.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/past/access.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/past/reader.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostSteps = 5;    // back from a bit to what decided it
constexpr std::size_t kMostWriters = 3;  // that are named of memory that nobody has written
constexpr Time kLookedAt = kSecond;      // whether they were executed

/// Where the rungs of a program come to while a part of the past is played.
class RungReader final : public Reader {
 public:
  RungReader(const Program& program, std::size_t station, const std::atomic<bool>* stop_request)
      : Reader(station, stop_request), reasons(program) {}

  void record(const TraceRecord& record) override { reasons.note(record); }
  void instruction(const InstructionRecord& record) override {
    if (!record.powered) passed_over[record.op] = {record.at, reasons.contacts()};
    reasons.note(record);
  }

  struct PassedOver {
    Time at = 0;
    std::string contacts{};
  };
  std::map<std::uint32_t, PassedOver> passed_over{};  ///< by op, the last time that it had no power flow
  TraceReasons reasons;
};

class MemoryInquiry {
 public:
  MemoryInquiry(History& history, std::size_t station, const std::atomic<bool>* stop_request)
      : history_(history), station_(station), stop_request_(stop_request) {}

  bool interrupted() const { return interrupted_; }

  /// From where the history stands; the bit that decided it is in `next()`, where the history then stands.
  std::string who(const MemoryRange& range) {
    next_.reset();
    const WriteSearch search = find_last_write(history_, station_, range, stop_request_);
    interrupted_ |= search.interrupted;
    if (interrupted_) return {};
    if (!search.write) return fmt::format("nothing has written it {}; {}", since_oldest_text(history_), who_could(range));
    const LastWrite& write = *search.write;
    if (!write.by)
      return fmt::format("last written at {} by {}", moment_text(write.at),
                         changer_text(history_, write.action, write.planned));
    const std::string contacts = rung_in_front_of(write);
    return fmt::format("last written at {} by {}{}", moment_text(write.at), named_in_sentence(write.by->op, program()),
                       contacts.empty() ? "" : fmt::format(" ({})", contacts));
  }

  const std::optional<MemoryRange>& next() const { return next_; }

 private:
  serial::Simulation& here() const { return history_.station(station_); }
  const Program& program() const { return here().cpu().program(); }

  /// The contacts that decided an instruction; the history stands in front of it then.
  std::string rung_in_front_of(const LastWrite& write) {
    history_.go_to(write.moment);
    RungReader reader(program(), station_, stop_request_);
    if (history_.go_to(here().cpu().state().scan_begin)) history_.play(reader, write.moment);
    history_.go_to(write.moment);
    const auto cause = reader.reasons.cause();
    if (cause && cause->contacts) next_ = decisive(cause->looked_at, write);
    return reader.reasons.contacts();
  }

  /// Of the contacts of a rung the first one that let no power through, or of one with power the first one; nothing where
  /// nothing in the program decides it: an input, special memory, a timer or counter, a comparison.
  std::optional<MemoryRange> decisive(const std::vector<InstructionRecord>& contacts, const LastWrite& write) const {
    const bool has_power = contacts.back().top;
    for (const InstructionRecord& contact : contacts) {
      const Op& op = program().ops[contact.op];
      const std::string_view mnemonic = op.instruction->mnemonic;
      const bool is_plain = mnemonic == "LD" || mnemonic == "A" || mnemonic == "O";
      const bool is_negated = mnemonic == "LDN" || mnemonic == "AN" || mnemonic == "ON";
      if (!(is_plain || is_negated) || !contact.value[0] || op[0].pointer) continue;
      if ((*contact.value[0] != 0) == is_plain ? !has_power : has_power) continue;
      auto range = range_at(op[0].at, Width::Byte, *program().model);
      if (!range || !is_of_program(range->area)) return {};
      range->width = Width::Bit;
      range->bit = op[0].bit;
      if (write.by->op == contact.op) return {};
      return range;
    }
    return {};
  }

  static bool is_of_program(Area area) { return area == Area::Q || area == Area::M || area == Area::V || area == Area::S; }

  /// `= Q0.1 in line 3 could, which had no power flow at 9.5 ms (LD I0.0: I0.0=0)`
  std::string who_could(const MemoryRange& range) {
    const Cpu& cpu = here().cpu();
    const Bits bits = bits_of(range);
    std::vector<std::uint32_t> writers;
    bool by_pointer = false;
    for (std::uint32_t op = 0; op < program().ops.size(); ++op) {
      if (program().ops[op].has_pointer)
        by_pointer |= may_access(cpu, op, Access::Write, bits);
      else if (accesses(cpu, op, Access::Write, bits))
        writers.push_back(op);
    }
    if (range.area == Area::I || range.area == Area::AI) return "it is an input, which the program does not write";
    if (writers.empty())
      return by_pointer ? "no instruction names it; one that writes through a pointer could"
                        : "no instruction of the program writes it";
    const Moment now = history_.now();
    RungReader reader(program(), station_, stop_request_);
    if (history_.go_to(now.time - std::min(now.time, kLookedAt))) interrupted_ |= !history_.play(reader, now);
    history_.go_to(now);
    std::vector<std::string> all;
    for (std::size_t i = 0; i < std::min(kMostWriters, writers.size()); ++i) all.push_back(could_text(writers[i], reader));
    const std::size_t more = writers.size() - all.size();
    return fmt::format("{}{}", fmt::join(all, "; "), more == 0 ? "" : fmt::format("; and {} more could", more));
  }

  std::string could_text(std::uint32_t op, const RungReader& reader) const {
    std::string name = named_in_sentence(op, program());
    name.resize(name.size() - comment_of(program().statement(op)).size());
    const auto passed = reader.passed_over.find(op);
    if (passed == reader.passed_over.end()) return fmt::format("{} could, which was not executed lately", name);
    const auto& [at, contacts] = passed->second;
    return fmt::format("{} could, which had no power flow at {}{}", name, moment_text(at),
                       contacts.empty() ? "" : fmt::format(" ({})", contacts));
  }

  History& history_;
  std::size_t station_;
  const std::atomic<bool>* stop_request_;
  bool interrupted_ = false;
  std::optional<MemoryRange> next_{};
};

std::string value_of(const Cpu& cpu, const MemoryRange& range) {
  return value_text(cpu.program(), range, range.bytes_in(cpu.state().image));
}

}  // namespace

std::string named(const Program& program, const MemoryRange& range) {
  const std::string symbol = symbol_name(program, range);
  return symbol.empty() ? range.name_of(0) : fmt::format("{} ({})", symbol, range.name_of(0));
}

std::optional<std::vector<std::string>> memory_cause(History& history, std::size_t station, const MemoryRange& range,
                                                     const std::atomic<bool>* stop_request) {
  const Moment start = history.now();
  MemoryInquiry inquiry(history, station, stop_request);
  std::vector<std::string> lines{inquiry.who(range)};
  while (!inquiry.interrupted() && inquiry.next() && lines.size() < kMostSteps) {
    const MemoryRange bit = *inquiry.next();
    const Cpu& cpu = history.station(station).cpu();
    const std::string name = fmt::format("{} was {}", named(cpu.program(), bit), value_of(cpu, bit));
    lines.push_back(fmt::format("{}: {}", name, inquiry.who(bit)));
  }
  history.go_to(start);
  if (inquiry.interrupted()) return {};
  return lines;
}

}  // namespace s7200::tools
