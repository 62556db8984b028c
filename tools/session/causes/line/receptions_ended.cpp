// Why did no RCV take characters: how did the last one end, and which could have started the next?
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/causes/inquiry.hpp"
#include "tools/session/causes/last/last_reception.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

using namespace sm::message;

/// The receive message service of a port, as RCV found it in special memory when it was executed.
class Settings {
 public:
  Settings(const State& state, std::uint8_t port)
      : bytes_(&state.image[kPorts[port].message]), first_(kPorts[port].message - image::kSM) {}

  std::uint8_t byte(std::uint32_t field) const { return bytes_[field]; }
  std::uint16_t word(std::uint32_t field) const { return load16(bytes_ + field); }
  bool has(Control bit) const { return (byte(kControl) & bit) != 0; }
  /// `SMB94`
  std::string name(std::uint32_t field) const { return fmt::format("SMB{}", first_ + field); }
  /// `SM87.7`
  std::string enable() const { return fmt::format("SM{}.7", first_ + kControl); }

 private:
  const std::uint8_t* bytes_;
  std::uint32_t first_;
};

std::string parameters_text(const Settings& settings) {
  if (settings.byte(kMost) == 0) return fmt::format("{} is 0: a message must be allowed a character", settings.name(kMost));
  return fmt::format("{} is 16#{:02X}, which has no start condition", settings.name(kControl), settings.byte(kControl));
}

/// A message that any character starts begins with the RCV.
std::string time_text(const TraceRecord& end, const Settings& settings) {
  const std::string time = fmt::format("{} ms passed ", settings.word(kTimeout));
  if (end.count == 0) return time + "after the RCV without a character";
  return time + (settings.has(kWholeMessage) ? "since the message began" : "without another character");
}

/// `the character 42 had a parity error`
std::string damage_text(const std::optional<TraceRecord>& character) {
  if (!character) return "a character was damaged, or the line had a break";
  if (character->framing_error && character->byte == 0) return "the line had a break, or a 00 had a framing error";
  return fmt::format("the character {:02x} had a {} error", character->byte, character->parity_error ? "parity" : "framing");
}

/// Why a message ended as it did (facts 10.3).
std::string reason_text(const LastReception& last, const Settings& settings) {
  const std::uint8_t status = last.end->byte;
  std::vector<std::string> reasons;
  if (status & kUser) reasons.push_back(fmt::format("{} is 0, which ends a reception", settings.enable()));
  if (status & kParameters) reasons.push_back(parameters_text(settings));
  if (status & kEndCharacter)
    reasons.push_back(fmt::format("the end character 16#{:02X} came", settings.byte(kEndOfMessage)));
  if (status & kTimer) reasons.push_back(time_text(*last.end, settings));
  if (status & kCount)
    reasons.push_back(
        fmt::format("{} came, as many as {} allows", counted(settings.byte(kMost), "character"), settings.name(kMost)));
  if (status & kParity) reasons.push_back(damage_text(last.damaged));
  return fmt::format("{}", fmt::join(reasons, ", and "));
}

std::string abandoned_text(const TraceRecord& by) {
  return by.kind == TraceKind::ModeChange ? "was given up when the CPU went to STOP"
                                          : "was given up when the port left Freeport mode";
}

/// `ended at 0.180000 ms with SMB86 = 16#40 because SMB94 is 0`; the simulation stands in front of the RCV.
std::string ended_text(const LastReception& last, const State& state, std::uint8_t port) {
  if (last.refused)
    return fmt::format("was refused with run-time error {:04X}, {}", *last.refused, meaning_of(RunError{*last.refused}));
  if (last.end) {
    const Settings settings(state, port);
    return fmt::format("ended at {} with {} = 16#{:02X} because {}", moment_text(last.end->at), settings.name(0),
                       last.end->byte, reason_text(last, settings));
  }
  if (last.abandoned) return fmt::format("{} at {}", abandoned_text(*last.abandoned), moment_text(last.abandoned->at));
  const Settings settings(state, port);
  if (settings.has(kEnable)) return "is over";
  return fmt::format("received nothing because {} is 0: {} = 16#{:02X}", settings.enable(), settings.name(kControl),
                     settings.byte(kControl));
}

bool is_rcv(const Op& op, std::uint8_t port) { return op.instruction->mnemonic == "RCV" && op[1].at == port; }

/// Who calls an interrupt routine, and that it has not come to an instruction.
std::string not_executed_text(const State& state, std::uint32_t routine) {
  std::vector<std::string> events;
  for (std::size_t event = 0; event < state.attached.size(); ++event)
    if (state.attached[event] == routine) events.push_back(fmt::format("{}", event));
  if (events.empty()) return fmt::format("INT {} is attached to no event", routine);
  return fmt::format("INT {}, which serves event {}, has not executed it since", routine, list_text(events));
}

/// The interrupt routine that an instruction is in; nothing if it is in another one.
std::optional<std::uint32_t> interrupt_routine_of(const Program& program, std::uint32_t op) {
  const auto is_head = [](const Op& one) { return begins_routine(one.instruction->structure); };
  const auto end = std::make_reverse_iterator(program.ops.begin() + op);
  const auto head = std::find_if(end, program.ops.rend(), is_head);
  const bool is_interrupt = head != program.ops.rend() && head->instruction->structure == Structure::InterruptHead;
  return is_interrupt ? std::optional((*head)[0].at) : std::nullopt;
}

/// What keeps an RCV from being executed.
std::string waiting_text(const Inquiry& inquiry, const State& now, std::uint32_t op, Time since) {
  const std::string rcv = named_in_sentence(op, inquiry.program());
  if (const Witness::PassedOver* const passed = inquiry.witness().passed_over(op); passed && passed->at >= since)
    return fmt::format("{}, which had no power flow at {}{}", rcv, moment_text(passed->at),
                       passed->contacts.empty() ? "" : fmt::format(" ({})", passed->contacts));
  if (const auto routine = interrupt_routine_of(inquiry.program(), op))
    return fmt::format("{}: {}", rcv, not_executed_text(now, *routine));
  return fmt::format("{}, which has not been executed since", rcv);
}

/// Which RCV could start the next reception, and what keeps each from it; or that one has started it, too late.
std::string could_start_text(Inquiry& inquiry, std::uint8_t port, Time since) {
  const State& now = inquiry.here_at_start().cpu().state();
  if (const Keeper waits = inquiry.kept_by_rcv(port); !waits.text.empty()) return "RCV waits again, for " + waits.text;
  inquiry.here_at_start();
  std::vector<std::string> all;
  for (std::uint32_t op = 0; op < inquiry.program().ops.size(); ++op)
    if (is_rcv(inquiry.program().ops[op], port)) all.push_back(waiting_text(inquiry, now, op, since));
  return fmt::format("the next would be started by {}", fmt::join(all, "; or by "));
}

}  // namespace

Keeper what_ended_receiving(Inquiry& inquiry, const TraceRecord& ignored) {
  const std::uint8_t port = ignored.port;
  History& history = inquiry.history();
  if (!history.go_to(ignored.at)) return inquiry.answers.interrupted = true, Keeper{};
  const ReceptionSearch search = find_last_reception(history, inquiry.station(), port, inquiry.stop_request());
  inquiry.answers.interrupted |= search.interrupted;
  if (search.interrupted) return {};
  if (!search.reception)
    return {.text =
                fmt::format("; none was executed {}; {}", since_oldest_text(history), could_start_text(inquiry, port, 0))};
  const LastReception& last = *search.reception;
  history.go_to(last.moment);
  const std::string ended = ended_text(last, inquiry.here().cpu().state(), port);
  LastDecision by{last.moment, named_in_sentence(last.by.op, inquiry.program()), last.by};
  std::string text = fmt::format("; the last one, {} at {}, {}; {}", by.text, moment_text(last.by.at), ended,
                                 could_start_text(inquiry, port, last.by.end));
  return {.text = std::move(text), .by = std::move(by), .since = last.by.at};
}

}  // namespace s7200::tools
