#include "tools/session/causes/memory_cause.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/analysis/effects/sources.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/trace/rung_contacts.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "interpreter/trace/trace_reasons.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/causes/last/last_turn.hpp"
#include "tools/session/causes/last/last_write.hpp"
#include "tools/session/causes/last/passed_over.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/past/actions/access.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostSteps = 8;    // back from a bit to what decided it
constexpr std::size_t kMostWriters = 3;  // that are named of memory that nobody has written
constexpr Time kLookedAt = kSecond;      // whether they were executed

bool is_same_place(const MemoryRange& a, const MemoryRange& b) {
  return a.width == b.width && a.count == b.count && a.at == b.at && a.bit == b.bit;
}

bool is_input(Area area) { return area == Area::I || area == Area::AI; }

class MemoryInquiry {
 public:
  MemoryInquiry(History& history, std::size_t station, StopToken stop_request)
      : history_(history), station_(station), stop_request_(stop_request) {}

  bool interrupted() const { return interrupted_; }

  /// From where the history stands; what the value came from and the bits that decided it are in `next()`, where the history
  /// then stands.
  std::string who(const MemoryRange& range) {
    next_.clear();
    const WriteSearch search = find_last_write(history_, station_, range, stop_request_);
    interrupted_ |= search.interrupted;
    if (interrupted_) return {};
    if (!search.write) return fmt::format("nothing has written it {}; {}", since_oldest_text(history_), who_could(range));
    const LastWrite& write = *search.write;
    if (!write.by)
      return fmt::format("last written at {} by {}", moment_text(write.at),
                         changer_text(history_, write.action, write.planned));
    return fmt::format("last written at {} by {}", moment_text(write.at), written_by(write, range));
  }

  /// The same of a bit that has led to itself: since when it is as it is, and what made it so.
  std::string held_since(const MemoryRange& bit) {
    next_.clear();
    const bool on = is_on(here().cpu().state(), bit);
    const TurnSearch search = find_last_turn(
        history_, station_, [&](const State& state) { return is_on(state, bit) == on; }, stop_request_);
    interrupted_ |= search.interrupted;
    if (interrupted_) return {};
    const std::string_view holds = on ? "it holds itself" : "it has been so";
    if (!search.turn) return fmt::format("{} {}", holds, since_oldest_text(history_));
    const std::string since = fmt::format("{} since {}", holds, moment_text(search.turn->at));
    if (!search.turn->by) return since;
    LastWrite write;
    write.moment = search.turn->moment;
    write.by = search.turn->by;
    return fmt::format("{}, switched {} by {}", since, on ? "on" : "off", written_by(write, bit));
  }

  /// The bits that decided the rung in which the history stands are in `next()`.
  void look_at_rung() {
    next_.clear();
    rung_in_front_of(history_.now(), {});
  }

  const std::vector<MemoryRange>& next() const { return next_; }

 private:
  serial::Simulation& here() const { return history_.station(station_); }
  const Program& program() const { return here().cpu().program(); }

  static bool is_on(const State& state, const MemoryRange& bit) { return (state.image[bit.at] >> bit.bit & 1) != 0; }

  /// The instruction that wrote memory, with the contacts that decided it.
  std::string written_by(const LastWrite& write, const MemoryRange& range) {
    const std::string by = named_in_sentence(write.by->op, program());
    if (write.call) {
      history_.go_to(write.moment);
      next_ = parameters_for(*write.call, range, true);
      return fmt::format("{}, as an output of {}", by, named_in_sentence(*write.call, program()));
    }
    const std::string contacts = rung_in_front_of(write.moment, write.by->op);
    if (const auto source = moved_to(write.by->op, range)) next_.insert(next_.begin(), *source);
    if (range.area == Area::L && program().ops[write.by->op].instruction->structure == Structure::Call)
      next_ = parameters_for(write.by->op, range, false);
    return fmt::format("{}{}{}", by, contacts.empty() ? "" : fmt::format(" ({})", contacts), forced_);
  }

  /// The local memory behind memory of the caller that a CALL gets back, or the other way round; only bits.
  std::vector<MemoryRange> parameters_for(std::uint32_t call, const MemoryRange& range, bool local) const {
    std::vector<MemoryRange> bits;
    for (const Parameter& parameter : parameters_of(program(), call)) {
      const Operand &other = local ? parameter.local : parameter.actual, &known = local ? parameter.actual : parameter.local;
      const bool copied = parameter.role == Role::InOut || (parameter.role == Role::Out) == local;
      if (!copied || parameter.width != Width::Bit || other.pointer) continue;
      if (known.at == range.at && known.bit == range.bit && range.width == Width::Bit)
        if (const auto bit = bit_of(other)) bits.push_back(*bit);
    }
    return bits;
  }

  /// The memory from which an instruction moves something, in front of which the history stands.
  std::optional<MemoryRange> moved_to(std::uint32_t op, const MemoryRange& range) const {
    const auto source = source_of(program(), op, bits_of(range), here().cpu().state().image);
    if (!source || constant_bit(program(), *source)) return {};
    const Width width = source->count == 1    ? Width::Bit
                        : source->count == 8  ? Width::Byte
                        : source->count == 16 ? Width::Word
                                              : Width::Double;
    const std::uint32_t one = width == Width::Bit ? 1 : 8 * bytes_of(width);
    auto from =
        range_at(static_cast<std::uint32_t>(source->first / 8), width == Width::Bit ? Width::Byte : width, *program().model);
    if (!from || source->count % one != 0) return {};
    from->width = width;
    from->bit = static_cast<std::uint8_t>(source->first % 8);
    from->count = static_cast<std::uint32_t>(source->count / one);
    return from;
  }

  /// Of memory that the program decides.
  std::optional<MemoryRange> bit_of(const Operand& operand) const {
    auto range = range_at(operand.at, Width::Byte, *program().model);
    if (!range || !is_of_program(range->area)) return {};
    range->width = Width::Bit;
    range->bit = operand.bit;
    return range;
  }

  /// The contacts that decided what comes at a moment, where the history stands then; `op` is none of them.
  std::string rung_in_front_of(const Moment& moment, std::optional<std::uint32_t> op) {
    forced_.clear();
    history_.go_to(moment);
    RungReader reader(program(), station_, stop_request_);
    if (history_.go_to(here().cpu().state().scan_begin)) history_.play(reader, moment);
    history_.go_to(moment);
    const auto cause = reader.reasons.cause();
    if (cause && cause->contacts) {
      next_ = decisive(cause->looked_at, op);
      forced_ = forced_text(contacts_of_top(program(), cause->looked_at));
    }
    return reader.reasons.contacts();
  }

  /// `; I0.0 was forced` of what contacts looked at, where the history stands.
  std::string forced_text(const std::vector<InstructionRecord>& contacts) const {
    std::vector<std::string> names;
    for (const InstructionRecord& contact : contacts)
      for (const Bits& bits : accessed(here().cpu(), contact.op, Access::Read))
        for (const Assignment& forced : forcing::listed(here().cpu().state().forcing)) {
          const std::string name = forced.place.name_of(0);
          if (bits_of(forced.place).overlaps(bits) && std::ranges::find(names, name) == names.end()) names.push_back(name);
        }
    if (names.empty()) return {};
    return fmt::format("; {} {} forced", fmt::join(names, " and "), names.size() == 1 ? "was" : "were");
  }

  /// The bits of the contacts that decided a rung: of contacts in series without power those that have none, of those in
  /// parallel with power those that have it, otherwise all of them; only what the program itself decides: no input, special
  /// memory, timer, counter or comparison.
  std::vector<MemoryRange> decisive(const std::vector<InstructionRecord>& contacts,
                                    std::optional<std::uint32_t> decided) const {
    std::vector<MemoryRange> bits;
    for (const InstructionRecord& contact : rung_decided_by(contacts)) {
      const Op& op = program().ops[contact.op];
      if (!is_bit_contact(op) || op[0].pointer || decided == contact.op) continue;
      const auto bit = bit_of(op[0]);
      if (bit && std::ranges::none_of(bits, [&](const MemoryRange& one) { return is_same_place(one, *bit); }))
        bits.push_back(*bit);
    }
    return bits;
  }

  static bool is_bit_contact(const Op& op) { return contact_form(*op.instruction).kind == ContactForm::Kind::Bit; }

  /// A part of a rung: whether it has power, and the contacts that are the reason.
  struct Branch {
    bool power = false;
    std::vector<InstructionRecord> because{};
  };

  static Branch joined(Branch a, Branch b, bool in_series) {
    if (a.power != b.power) return a.power == in_series ? std::move(b) : std::move(a);
    a.because.insert(a.because.end(), b.because.begin(), b.because.end());
    return a;
  }

  std::vector<InstructionRecord> rung_decided_by(const std::vector<InstructionRecord>& contacts) const {
    std::vector<Branch> stack{};
    const auto pop = [&] {
      Branch last = std::move(stack.back());
      stack.pop_back();
      return last;
    };
    for (const InstructionRecord& contact : contacts) {
      const std::string_view mnemonic = program().ops[contact.op].instruction->mnemonic;
      const bool joins = mnemonic == "ALD" || mnemonic == "OLD";
      if (joins && stack.size() >= 2) {
        Branch below = pop();
        stack.push_back(joined(pop(), std::move(below), mnemonic == "ALD"));
      } else if (mnemonic == "LPS" && !stack.empty()) {
        stack.push_back(stack.back());
      } else if (mnemonic == "LRD" && stack.size() >= 2) {
        stack.back() = stack[stack.size() - 2];
      } else if (mnemonic == "LPP" && !stack.empty()) {
        stack.pop_back();
      } else if (mnemonic == "NOT" && !stack.empty()) {
        stack.back().power = !stack.back().power;
      } else if (mnemonic.starts_with("LD") || stack.empty()) {
        stack.push_back({contact.top, {contact}});
      } else if (mnemonic.starts_with("A") || mnemonic.starts_with("O")) {
        const bool in_series = mnemonic.starts_with("A");
        const bool power = power_of(contact).value_or(stack.back().power == in_series ? contact.top : in_series);
        stack.push_back(joined(pop(), {power, {contact}}, in_series));
      } else {
        stack.back().power = contact.top;
      }
    }
    return stack.empty() ? std::vector<InstructionRecord>{} : stack.back().because;
  }

  /// Whether a contact of a bit lets power through, whatever is in front of it.
  std::optional<bool> power_of(const InstructionRecord& contact) const {
    const Op& op = program().ops[contact.op];
    if (!is_bit_contact(op) || !contact.value[0]) return {};
    return (*contact.value[0] != 0) != contact_form(*op.instruction).inverted;
  }

  static bool is_of_program(Area area) {
    return area == Area::Q || area == Area::M || area == Area::V || area == Area::S || area == Area::L;
  }

  /// `= Q0.1 in line 3 could, which had no power flow at 9.5 ms (LD I0.0: I0.0=0)`
  std::string who_could(const MemoryRange& range) {
    const Cpu& cpu = here().cpu();
    const Bits bits = bits_of(range);
    std::vector<std::uint32_t> writers;
    bool by_pointer = false;
    for (std::uint32_t op = 0; op < program().ops.size(); ++op) {
      if (program().ops[op].has_pointer)
        by_pointer |= may_access(cpu, op, Access::Write, bits);
      else if (accesses(cpu, op, Access::Write, bits) || gets_back(op, bits))
        writers.push_back(op);
    }
    if (is_input(range.area)) return "it is an input, which the program does not write";
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

  /// Whether it is a CALL with such an output.
  bool gets_back(std::uint32_t op, const Bits& bits) const {
    if (program().ops[op].instruction->structure != Structure::Call) return false;
    return std::ranges::any_of(effects_now(program(), op, here().cpu().state().image),
                               [&](const MemoryAccess& access) { return access.writes() && access.bits.overlaps(bits); });
  }

  std::string could_text(std::uint32_t op, const RungReader& reader) const {
    return fmt::format("{} could, which {}", named_without_comment(op, program()), reader.what_kept(op));
  }

  History& history_;
  std::size_t station_;
  StopToken stop_request_;
  bool interrupted_ = false;
  std::vector<MemoryRange> next_{};
  std::string forced_{};  // of the last rung
};

/// What other memory came from: a bit that decided it, or where its value was; and when.
struct Step {
  MemoryRange place;
  Moment at;
  std::vector<MemoryRange> way{};  ///< what led to it
};

std::string value_of(const Cpu& cpu, const MemoryRange& range) {
  return value_text(cpu.program(), range, range.bytes_in(cpu.state().image));
}

/// `Q0.0 is forced to 0`; empty if nothing of it is.
std::string forced_value_text(const Cpu& cpu, const MemoryRange& range) {
  for (const Assignment& forced : forcing::listed(cpu.state().forcing))
    if (bits_of(forced.place).overlaps(bits_of(range)))
      return fmt::format("{} is forced to {}", forced.place.name_of(0),
                         value_text(cpu.program(), forced.place, forcing::seen_outside(cpu.state(), forced.place)));
  return {};
}

/// Appends a line for each step back from the bits or the memory that `inquiry` has found next to `from`, as far as there are
/// less than kMostSteps, and one that names those that were not followed.
void follow_back(MemoryInquiry& inquiry, History& history, std::size_t station, const std::vector<MemoryRange>& from,
                 std::vector<std::string>& lines) {
  std::vector<Step> steps;  // the next one last
  const auto times_on = [](const std::vector<MemoryRange>& way, const MemoryRange& place) {
    return std::ranges::count_if(way, [&](const MemoryRange& one) { return is_same_place(one, place); });
  };
  const auto add_steps = [&](const std::vector<MemoryRange>& way) {
    for (auto place = inquiry.next().rbegin(); place != inquiry.next().rend(); ++place) {
      const bool may_hold_itself = place->width == Width::Bit;
      if (times_on(way, *place) < (may_hold_itself ? 2 : 1)) steps.push_back({*place, history.now(), way});
    }
  };
  add_steps(from);
  const auto name = [&](const Step& step) {
    history.go_to(step.at);
    const Cpu& cpu = history.station(station).cpu();
    return fmt::format("{} was {}", named(cpu.program(), step.place), value_of(cpu, step.place));
  };
  const auto why = [&](const Step& step) {
    return times_on(step.way, step.place) > 0 ? inquiry.held_since(step.place) : inquiry.who(step.place);
  };
  while (!inquiry.interrupted() && !steps.empty() && lines.size() < kMostSteps) {
    Step step = std::move(steps.back());
    steps.pop_back();
    const std::string was = name(step);
    if (is_input(step.place.area)) {
      lines.push_back(was + ": an input");
      continue;
    }
    lines.push_back(fmt::format("{}: {}", was, why(step)));
    step.way.push_back(step.place);
    add_steps(step.way);
  }
  if (lines.size() <= 1 || steps.empty()) return;
  std::vector<std::string> others;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step)
    if (std::string other = name(*step); std::ranges::find(others, other) == others.end()) others.push_back(std::move(other));
  lines.push_back(fmt::format("{}: not followed further back", fmt::join(others, ", ")));
}

}  // namespace

std::string named(const Program& program, const MemoryRange& range) {
  const std::string symbol = symbol_name(program, range);
  return symbol.empty() ? range.name_of(0) : fmt::format("{} ({})", symbol, range.name_of(0));
}

std::optional<std::vector<std::string>> memory_cause(History& history, std::size_t station, const MemoryRange& range,
                                                     StopToken stop_request) {
  const Moment start = history.now();
  MemoryInquiry inquiry(history, station, stop_request);
  std::vector<std::string> lines{inquiry.who(range)};
  follow_back(inquiry, history, station, {range}, lines);
  history.go_to(start);
  if (inquiry.interrupted()) return {};
  if (const std::string forced = forced_value_text(history.station(station).cpu(), range); !forced.empty())
    lines.push_back(forced);
  return lines;
}

std::optional<std::vector<std::string>> rung_cause(History& history, std::size_t station, StopToken stop_request) {
  const Moment start = history.now();
  MemoryInquiry inquiry(history, station, stop_request);
  std::vector<std::string> lines;
  inquiry.look_at_rung();
  follow_back(inquiry, history, station, {}, lines);
  history.go_to(start);
  return inquiry.interrupted() ? std::nullopt : std::optional(std::move(lines));
}

}  // namespace s7200::tools
