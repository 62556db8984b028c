#include "interpreter/trace/trace_reasons.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/model/special_bits.hpp"
#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/interrupt_enabling.hpp"
#include "interpreter/trace/rung_contacts.hpp"
#include "interpreter/trace/text/instruction_lines.hpp"
#include "interpreter/trace/text/statement_text.hpp"

namespace s7200 {
namespace {

bool has_place(const TraceRecord& r) {
  switch (r.kind) {
    case TraceKind::Attach:
    case TraceKind::Detach:
    case TraceKind::Enable:
    case TraceKind::Transmit:
    case TraceKind::Receive:
    case TraceKind::PortControl:
      return r.op != kNoRoutine;
    default:
      return false;
  }
}

/// Attaches, detaches or replaces what gets the characters of a port.
bool is_about_reception(const TraceRecord& record) {
  const bool attachment = record.kind == TraceKind::Attach || record.kind == TraceKind::Detach;
  return record.kind == TraceKind::Receive || (attachment && is_receive_event(record.event));
}

std::size_t port_of(const TraceRecord& record) {
  if (record.kind == TraceKind::Receive) return record.port;
  return record.event == kPorts[1].received ? 1 : 0;
}

/// Whether an instruction may look at SMB2, itself or in what it calls. No pointer reaches special memory.
bool may_read_character(const Op& op) {
  if (op.instruction->structure == Structure::Call) return true;
  const auto rules = op.instruction->rules();
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const OperandRule& rule = rules[i];
    if (rule.kind != OperandKind::Memory || rule.role == Role::Out || op[i].pointer) continue;
    const bool several = rule.counted != 0 || rule.elements != 1 || rule.text;
    const std::uint32_t end = several && op[i].at >= image::kSM ? image::kSize : op[i].at + op[i].width;
    if (op[i].at <= sm::kReceivedCharacter && sm::kReceivedCharacter < end) return true;
  }
  return false;
}

bool reads_character(const Program& program, std::uint32_t head) {
  for (std::uint32_t op = head; op < program.ops.size(); ++op) {
    if (may_read_character(program.ops[op])) return true;
    if (program.ops[op].instruction->structure == Structure::InterruptEnd) return false;
  }
  return false;
}

constexpr std::uint8_t kAllPorts = (1u << kPorts.size()) - 1;

/// To which ports some of the instructions [first, end) send, a bit each.
std::uint8_t transmits(const Program& program, std::uint32_t first, std::uint32_t end) {
  std::uint8_t ports = 0;
  for (std::uint32_t op = first; op < end; ++op)
    if (program.ops[op].instruction->effect == Effect::Transmits)
      ports = static_cast<std::uint8_t>(ports | 1u << program.ops[op][1].at);
  return ports;
}

bool ends_routine(const Op& op) {
  const Structure structure = op.instruction->structure;
  return structure == Structure::MainEnd || structure == Structure::SubroutineEnd || structure == Structure::InterruptEnd;
}

std::uint32_t end_of_routine(const Program& program, std::uint32_t op) {
  while (op < program.ops.size() && !ends_routine(program.ops[op])) ++op;
  return op;
}

/// By the number of the subroutine; one that calls others may send whatever they do.
std::uint8_t transmits_when_called(const Program& program, std::uint32_t head) {
  const std::uint32_t end = end_of_routine(program, head);
  for (std::uint32_t op = head; op < end; ++op)
    if (program.ops[op].instruction->structure == Structure::Call) return kAllPorts;
  return transmits(program, head, end);
}

/// Which XMTs are not executed, by their ports, when that is without power flow; or with it, if it is a jump or an end.
std::uint8_t passed_transmits(const Program& program, std::uint32_t number) {
  const Op& op = program.ops[number];
  if (op.instruction->effect == Effect::Transmits) return transmits(program, number, number + 1);
  if (op.instruction->structure == Structure::Jump) return transmits(program, number, std::max(number, op.target));
  if (op.instruction->structure == Structure::Call) return transmits_when_called(program, op.target);
  if (op.instruction->effect == Effect::ConditionalEnd) return transmits(program, number, end_of_routine(program, number));
  return 0;
}

/// ` and ended at 41.000000 ms with SMB86 = 16#04 (the time has passed)` of a message that neither its end character nor the
/// number of its characters has ended; nothing of others.
std::string broken_off_text(const std::optional<TraceRecord>& end, std::string_view ended) {
  if (!end || (end->byte & (sm::message::kEndCharacter | sm::message::kCount)) != 0) return {};
  const std::uint32_t status = kPorts[end->port].message;
  return fmt::format("{} at {}.{:06} ms with SMB{} = 16#{:02X} ({})", ended, end->at / kMillisecond, end->at % kMillisecond,
                     status - image::kSM, end->byte, special_meanings_text(status, end->byte));
}

/// What has kept the program from an XMT, after the message that nothing was sent.
std::string because(const std::optional<TraceReasons::Cause>& kept) {
  return kept ? ": " + kept->text : " (no XMT was executed)";
}

}  // namespace

std::string ignored_because(const TraceRecord& record) {
  if (record.kind == TraceKind::CharacterDropped) return "RCV waits for the start of a message";
  switch (Ignored{record.code}) {
    case Ignored::NotAttached:
      return fmt::format("event {} is not attached", kPorts[record.port].received);
    case Ignored::NoRcvWaits:
      return "no RCV waits";
    case Ignored::NoPpiFrame:
      return "the port is in PPI mode, and this is not a PPI frame";
    case Ignored::WhileSending:
      return "the receiver is off while the port sends";
    case Ignored::NoPower:
      return "the PLC has no power";
  }
  return {};
}

TraceReasons::TraceReasons(const Program& program) : program_(program) {
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
    const Instruction& instruction = *program.ops[op].instruction;
    Role role = program.ops[op].is_contact ? Role::Contact : Role::Mark;
    if (begins_rung(program, op)) role = Role::FirstContact;
    if (is_box_or_coil(program.ops[op])) role = Role::Other;
    if (instruction.structure == Structure::Jump) role = Role::Jump;
    if (instruction.structure == Structure::Call) role = Role::Call;
    if (instruction.structure == Structure::SubroutineEnd) role = Role::Return;
    if (instruction.effect == Effect::ConditionalEnd) role = Role::ConditionalEnd;
    role_.push_back(role);
    passes_transmit_.push_back(passed_transmits(program, op));
  }
  for (std::size_t number = 0; number < program.interrupt.size(); ++number)
    if (program.interrupt[number] != kNoRoutine)
      reads_character_.set(number, reads_character(program, program.interrupt[number]));
}

std::string TraceReasons::line_of(std::uint32_t op) const { return s7200::line_of(op, program_); }

/// Where the program did it.
const std::string& TraceReasons::place_of(std::uint32_t op) {
  const auto [known, added] = places_.try_emplace(op);
  if (!added) return known->second;
  const stl::Statement& statement = program_.statement(op);
  known->second = fmt::format("  {}: {}{}", line_of(op), stl::to_text(statement), comment_of(statement));
  return known->second;
}

std::string TraceReasons::of(const TraceRecord& record) {
  if (has_place(record)) return place_of(record.op);
  if (record.kind == TraceKind::EventOccurred && disabled_) {
    switch (disabled_->by) {
      case Disabled::By::Nothing:
        break;
      case Disabled::By::NoEni:
        return "; it waits: no ENI so far";
      case Disabled::By::Disi:
        return "; it waits: interrupts are disabled by DISI in " + line_of(disabled_->disi);
      case Disabled::By::Forgotten:
        return "; it waits: interrupts are disabled";
    }
  }
  if (record.kind != TraceKind::ServiceBegin) return {};
  const std::string why = cause_of(record);
  return why.empty() ? "" : ": " + why;
}

/// Or the instruction that was not over.
std::string TraceReasons::cause_of(const TraceRecord& begin) const {
  std::string why = held_up_by(begin);
  if (!why.empty() || begin.at <= begin.since || begin.op == kNoRoutine) return why;
  return executed_meanwhile(begin);
}

std::string TraceReasons::executed_meanwhile(const TraceRecord& begin) const {
  const bool measured = last_ && last_->op == begin.op && last_->end > begin.since;
  return fmt::format("{} was being executed{}: {}", line_of(begin.op),
                     measured ? fmt::format(" for {}", format_duration(last_->end - last_->at)) : "",
                     stl::to_text(program_.statement(begin.op)));
}

/// In front of the first routine that ran: a long instruction that was not over.
std::string TraceReasons::executed_before(const TraceRecord& first, Time since) const {
  if (first.at < since + kLongInstruction || first.op == kNoRoutine) return {};
  return fmt::format("{} for {} in {}", format_duration(first.at - since), short_text(program_.statement(first.op)),
                     line_of(first.op));
}

std::string TraceReasons::disabled_text(const std::optional<Disabled>& before) const {
  if (!before) return "interrupts may have been disabled";
  if (before->by == Disabled::By::NoEni) return "no ENI";
  return before->by == Disabled::By::Disi ? "DISI in " + line_of(before->disi) : "interrupts were disabled";
}

std::string TraceReasons::held_up_by(const TraceRecord& begin) const {
  if (begin.at <= begin.since) return {};
  std::string why;
  if (enabled_ && enabled_->record.at > begin.since)
    why = fmt::format("{} until ENI in {}", disabled_text(enabled_->before), line_of(enabled_->record.op));
  std::size_t others = 0;
  for (const Service& service : services_) others += service.end > begin.since ? 1 : 0;
  if (others > 0) {
    const Service& last = services_.back();
    if (why.empty()) why = executed_before((services_.end() - static_cast<std::ptrdiff_t>(others))->begin, begin.since);
    const std::string name = fmt::format("INT {} of event {}", last.routine, last.event);
    why += why.empty() ? "" : ", then ";
    why += others == 1 ? name + " until then" : fmt::format("{} others first, the last {}", others, name);
  }
  const bool long_one =
      last_ && last_->op == begin.op && last_->end > begin.since && last_->end - last_->at >= kLongInstruction;
  return why.empty() && long_one ? executed_meanwhile(begin) : why;
}

// --- what decided ---

std::string TraceReasons::contacts_text(const std::vector<InstructionRecord>& contacts) const {
  std::string text;
  for (const InstructionRecord& contact : contacts_of_top(program_, contacts)) {
    const std::string values = values_text(contact, program_);
    text += fmt::format("{}{}{}{}", text.empty() ? "" : "; ", short_text(program_.statement(contact.op)),
                        values.empty() ? "" : ":", values);
  }
  return text;
}

std::string TraceReasons::power_behind(const std::vector<InstructionRecord>& contacts) const {
  std::string power;
  for (const InstructionRecord& contact : contacts_of_top(program_, contacts)) power += contact.top ? '1' : '0';
  return power;
}

std::string TraceReasons::text_of(const Decision& decision) const {
  if (decision.by_contacts) {
    const std::string first = line_of(decision.contacts.front().op), last = line_of(decision.contacts.back().op);
    const std::string place =
        first == last ? "the contact in " + first : fmt::format("the contacts from {} to {}", first, last);
    return fmt::format("{} ({})", place, contacts_text(decision.contacts));
  }
  const stl::Statement& statement = program_.statement(decision.by.op);
  const std::string_view skipped = role_[decision.by.op] == Role::Other ? ", without power flow" : ", not taken";
  return fmt::format("{} in {}{}{}{}", short_text(statement), line_of(decision.by.op), decision.by.powered ? "" : skipped,
                     decision.contacts.empty() ? "" : fmt::format(" ({})", contacts_text(decision.contacts)),
                     comment_of(statement));
}

/// Not `LD SM0.0`, which decides nothing.
bool TraceReasons::is_own(const InstructionRecord& contact) const {
  const Op& op = program_.ops[contact.op];
  return op[0].at != sm::kScanStatus || op[0].bit != 0 || op.instruction->mnemonic != "LD";
}

bool TraceReasons::has_own_contacts(const Way& way) const {
  return std::ranges::any_of(way.contacts, [&](const auto& one) { return is_own(one); });
}

std::optional<TraceReasons::Cause> TraceReasons::cause() const { return cause_of(decision()); }

std::string TraceReasons::contacts() const {
  const Way& way = flow().way;
  return has_own_contacts(way) ? contacts_text(way.contacts) : "";
}

std::optional<TraceReasons::Decision> TraceReasons::decision() const {
  const Way& way = flow().way;
  if (has_own_contacts(way)) return Decision{way.contacts.back(), way.contacts, in_interrupt_, true};
  return way.decided ? std::optional(way.decision) : std::nullopt;
}

TraceReasons::Cause TraceReasons::cause_of(const Decision& decision) const {
  const InstructionRecord& first = decision.by_contacts ? decision.contacts.front() : decision.by;
  return {.text = text_of(decision),
          .by = decision.by,
          .first = first,
          .contacts = decision.by_contacts,
          .in_interrupt = decision.in_interrupt,
          .looked_at = decision.contacts,
          .power = power_behind(decision.contacts)};
}

std::optional<TraceReasons::Cause> TraceReasons::cause_of(const std::optional<Decision>& decision) const {
  return decision ? std::optional(cause_of(*decision)) : std::nullopt;
}

/// Which XMT was meant for it is not known: all are named, and the first one stands for them.
std::optional<TraceReasons::Cause> TraceReasons::cause_of(const Frame& frame) const {
  if (frame.kept_by.empty()) return cause_of(frame.led_by);
  Cause cause = cause_of(frame.kept_by.front());
  for (auto one = frame.kept_by.begin() + 1; one != frame.kept_by.end(); ++one) {
    cause.text += "; " + text_of(*one);
    cause.power += power_behind(one->contacts);
  }
  return cause;
}

/// The routine that gets the characters gets them from now on too, and nothing has decided on that: it is no step of the
/// program, which does so whatever has come in.
bool TraceReasons::is_attached_already(const TraceRecord& record) const {
  const Reception& reception = reception_[port_of(record)];
  return record.kind == TraceKind::Attach && reception.attached == record.routine && !is_decided();
}

/// Whether the program does not go on with a frame after `record`, and has sent nothing.
bool TraceReasons::is_left(const Frame& frame, const TraceRecord& record) const {
  if (!last_ || frame.characters == 0) return false;
  if (record.kind == TraceKind::Receive) return true;
  const bool attaches = record.kind == TraceKind::Attach && kPorts[port_of(record)].received == record.event;
  return attaches && !serves_character() && (record.routine == frame.routine || frame.unread == frame.characters);
}

/// `INT 121 (attached in line 102) took them without reading SMB2, and executed ATCH 120, 10 in line 665  // not quiet yet`
std::string TraceReasons::unread_text(const Frame& frame) const {
  std::string text = fmt::format("INT {}", frame.routine);
  if (frame.attached_by) text += fmt::format(" (attached in {})", line_of(*frame.attached_by));
  text += fmt::format(" took {} without reading SMB2", frame.characters == 1 ? "it" : "them");
  if (!frame.executed) return text;
  return text + ", and executed " + named_in_sentence(frame.executed->op, program_);
}

TraceReasons::Unanswered TraceReasons::unanswered(const Frame& frame, const std::optional<Cause>& cause) const {
  if (frame.unread < frame.characters) return {frame.characters, frame.since, frame.last, cause ? cause->text : "", cause};
  Unanswered unread{frame.characters, frame.since, frame.last, unread_text(frame)};
  if (const auto& by = frame.executed) unread.cause = Cause{unread.decided_by, *by, *by, false, true};
  return unread;
}

std::vector<TraceReasons::Unanswered> TraceReasons::unanswered(const TraceRecord& record) const {
  std::vector<Unanswered> all;
  if (!is_about_reception(record) || is_attached_already(record)) return all;
  const Reception& reception = reception_[port_of(record)];
  for (const Frame& frame : reception.earlier)
    if (is_left(frame, record)) all.push_back(unanswered(frame, cause_of(frame.cause)));
  if (is_left(reception.frame, record)) all.push_back(unanswered(reception.frame, cause_of_leaving(reception, record)));
  return all;
}

std::optional<TraceReasons::Cause> TraceReasons::cause_of_leaving(const Reception& reception,
                                                                  const TraceRecord& record) const {
  if (const auto own = cause()) return own;
  const bool known = reception.frame.cause || record.kind != TraceKind::Receive || record.op == kNoRoutine;
  return known ? cause_of(reception.frame.cause) : received_again(reception, record);
}

/// Nothing has decided that RCV is executed again: what has kept the program from an XMT before is the reason.
/// `INT 0 took the message, and RCV in line 25 waits for the next one: XMT VB200, 0 in line 19, without power flow (…)`
TraceReasons::Cause TraceReasons::received_again(const Reception& reception, const TraceRecord& record) const {
  const InstructionRecord rcv{.at = record.at - program_.ops[record.op].cost, .end = record.at, .op = record.op};
  const std::optional<Cause> kept = cause_of(reception.frame);
  Cause cause = kept.value_or(Cause{.text = {}, .by = rcv, .first = rcv, .in_interrupt = in_interrupt_});
  cause.text = fmt::format("{} {}{}, and RCV in {} waits for the next one{}",
                           in_interrupt_ ? fmt::format("INT {}", begun_.routine) : "the main program",
                           reception.message_open ? "broke the message off" : "took the message",
                           broken_off_text(reception.ended, ", which ended"), line_of(record.op), because(kept));
  return cause;
}

std::vector<TraceReasons::Unanswered> TraceReasons::unread() const {
  std::vector<Unanswered> all;
  const auto add = [&](const Frame& frame) {
    if (frame.characters > 0 && frame.unread == frame.characters) all.push_back(unanswered(frame, {}));
  };
  for (const Reception& reception : reception_) {
    std::ranges::for_each(reception.earlier, add);
    add(reception.frame);
  }
  return all;
}

/// `INT 0 took them, and nothing was sent since: XMT VB0, 0 in line 20, without power flow (LD M0.0: M0.0=0)`
std::optional<TraceReasons::Unanswered> TraceReasons::taken(const Reception& reception, Time since) const {
  const Frame& frame = reception.frame;
  Part all{};
  for (const Part& part : frame.parts) {
    if (part.since < since) continue;
    if (all.characters == 0) all.since = part.since;
    all.characters += part.characters;
    all.served += part.served;
    all.lost += part.lost;
    all.routine = part.routine;
  }
  if (all.characters == all.lost) return {};
  all.characters -= all.lost;
  const std::optional<Cause> cause = cause_of(frame);
  const std::string text =
      fmt::format("{} took {}{}, and nothing was sent since{}", all.served > 0 ? fmt::format("INT {}", all.routine) : "RCV",
                  all.characters == 1 ? "it" : "them", broken_off_text(reception.ended, " and ended"), because(cause));
  return Unanswered{all.characters, all.since, frame.last, text, cause, reception.message_open, !frame.attached_anew};
}

std::vector<TraceReasons::Unanswered> TraceReasons::taken(Time since) const {
  std::vector<Unanswered> all;
  for (const Reception& reception : reception_)
    if (const auto one = taken(reception, since)) all.push_back(*one);
  return all;
}

// --- what has come ---

/// A frame begins after a pause of three characters, if the program has attached a routine to its characters since, or if
/// the routine that got the last one did not read it: nothing is put together there.
void TraceReasons::note_character(const TraceRecord& record) {
  Reception& reception = reception_[record.port];
  Frame& frame = reception.frame;
  const bool pause = record.since - frame.last > 3 * (record.at - record.since);
  if (frame.characters == 0 || (pause && (frame.attached_anew || !frame.read))) {
    if (frame.characters > 0 && (frame.passed_on || !frame.read)) reception.earlier.push_back(std::move(frame));
    if (reception.earlier.size() > kEarlier) reception.earlier.erase(reception.earlier.begin());
    frame = {.since = record.since, .attached_by = reception.attached_by};
  }
  if (frame.parts.empty() || pause) frame.parts.push_back({.since = record.since});
  if (frame.parts.size() > kEarlier) frame.parts.erase(frame.parts.begin());
  ++frame.parts.back().characters;
  ++frame.characters;
  frame.last = record.at;
  frame.attached_anew = false;
}

/// Which routine gets a character.
void TraceReasons::note_event(const TraceRecord& record) {
  for (std::size_t port = 0; port < kPorts.size(); ++port) {
    if (record.event != kPorts[port].received) continue;
    reception_[port].attached = record.routine;
    Frame& frame = reception_[port].frame;
    if (frame.characters == 1) frame.routine = record.routine;
    const bool served = record.kind == TraceKind::EventOccurred;
    frame.read = !served || reads_character_.test(record.routine);
    if (!frame.read) ++frame.unread;
    frame.kept_by.clear();
    if (frame.parts.empty()) continue;
    Part& part = frame.parts.back();
    ++(served ? part.served : part.lost);
    if (served) part.routine = record.routine;
  }
}

/// A routine that got a character attaches another event: a time begins anew.
void TraceReasons::note_restart(const TraceRecord& record) {
  for (std::size_t port = 0; port < kPorts.size(); ++port)
    if (kPorts[port].received == serving_ && record.op != kNoRoutine)
      reception_[port].frame.executed = {.at = record.at - program_.ops[record.op].cost, .end = record.at, .op = record.op};
}

/// The routine of a character hands the next ones over to another one that reads them: the frame goes on there.
bool TraceReasons::goes_on(const Frame& frame, const TraceRecord& record) const {
  return record.kind == TraceKind::Attach && serves_character() && record.routine != frame.routine &&
         reads_character_.test(record.routine);
}

/// What the routine of a character came by last has decided what became of it.
void TraceReasons::note_end_of_service() {
  for (std::size_t port = 0; port < kPorts.size(); ++port)
    if (kPorts[port].received == serving_) reception_[port].frame.led_by = decision();
}

void TraceReasons::note_reception(const TraceRecord& record) {
  Reception& reception = reception_[port_of(record)];
  if (is_attached_already(record)) return;
  if (record.kind == TraceKind::Receive) {
    reception.message_open = true;
    reception.ended.reset();
  }
  if (record.kind != TraceKind::Receive) reception.attached.reset();
  if (record.kind == TraceKind::Attach) reception.attached = record.routine;
  Frame& frame = reception.frame;
  std::erase_if(reception.earlier, [&](const Frame& one) { return is_left(one, record); });
  if (is_left(frame, record)) frame = {};
  if (!goes_on(frame, record)) frame.attached_anew = true;
  frame.passed_on |= record.kind != TraceKind::Detach && !serves_character();
  frame.cause = frame.characters > 0 ? decision() : std::nullopt;
  reception.attached_by.reset();
  if (record.kind == TraceKind::Attach && record.op != kNoRoutine) reception.attached_by = record.op;
}

void TraceReasons::decide(Flow& flow, const InstructionRecord& by) const {
  Decision& decision = flow.way.decision;
  flow.way.decided = true;
  decision.by = by;
  decision.contacts = flow.way.contacts;
  decision.in_interrupt = in_interrupt_;
  if (by.powered) flow.way.contacts.clear();
}

/// What decided on the call has led to all that follows in the subroutine; a call that is always executed decides nothing.
void TraceReasons::call(Flow& flow, const InstructionRecord& by) const {
  Way inside{.contacts = {}, .decided = flow.way.decided, .decision = flow.way.decision};
  if (has_own_contacts(flow.way)) {
    inside.decided = true;
    inside.decision = Decision{by, flow.way.contacts, in_interrupt_};
  }
  flow.way.called = by.at;
  flow.callers.push_back(std::exchange(flow.way, std::move(inside)));
}

/// Whatever happens in a subroutine, it returns: what was decided there counts for its caller only if it was taken, as a
/// jump over the rest of it.
void TraceReasons::return_to_caller(Flow& flow) {
  if (flow.callers.empty()) return;
  Way inside = std::exchange(flow.way, std::move(flow.callers.back()));
  flow.callers.pop_back();
  if (!inside.decided || !inside.decision.by.powered || inside.decision.by.at <= flow.way.called) return;
  flow.way.decided = true;
  flow.way.decision = std::move(inside.decision);
  flow.way.contacts.clear();
}

/// The program could have sent something after the last character, and has not.
void TraceReasons::note_transmit_passed(const Flow& flow, const InstructionRecord& by) {
  const bool leaves = role_[by.op] == Role::Jump || role_[by.op] == Role::ConditionalEnd;
  if (by.powered != leaves) return;
  for (std::size_t port = 0; port < kPorts.size(); ++port) {
    Frame& frame = reception_[port].frame;
    if (frame.characters == 0 || (passes_transmit_[by.op] >> port & 1) == 0) continue;
    const auto is_it = [&](const Decision& one) { return one.by.op == by.op; };
    if (std::ranges::none_of(frame.kept_by, is_it))
      frame.kept_by.push_back({.by = by, .contacts = flow.way.contacts, .in_interrupt = in_interrupt_});
  }
}

void TraceReasons::note(const InstructionRecord& record) {
  last_ = {.at = record.at, .end = record.end, .op = record.op};
  const bool failed = std::exchange(failed_, false);
  Flow& flow = in_interrupt_ ? interrupt_ : main_;
  if (passes_transmit_[record.op] != 0) note_transmit_passed(flow, record);
  switch (role_[record.op]) {
    case Role::Mark:
      flow.way.contacts.clear();
      break;
    case Role::FirstContact:
      flow.way.contacts.clear();
      [[fallthrough]];
    case Role::Contact:
      flow.way.contacts.push_back(record);
      break;
    case Role::Jump:
      decide(flow, record);
      break;
    case Role::ConditionalEnd:
      decide(flow, record);
      if (record.powered) return_to_caller(flow);
      break;
    case Role::Call:
      if (record.powered && !failed) call(flow, record);
      break;
    case Role::Return:
      return_to_caller(flow);
      break;
    case Role::Other:
      break;
  }
  if (std::exchange(interrupt_ends_, false)) in_interrupt_ = false;
}

void TraceReasons::note(const TraceRecord& record) {
  switch (record.kind) {
    case TraceKind::ScanBegin:
      main_.begin();
      return;
    case TraceKind::ModeChange:
      return forget({Disabled::By::NoEni});
    case TraceKind::Enable:
      return note_enable(record);
    case TraceKind::ServiceBegin:
      in_interrupt_ = true;
      interrupt_ends_ = false;
      serving_ = record.event;
      begun_ = record;
      interrupt_.begin();
      return;
    case TraceKind::ServiceEnd:
      interrupt_ends_ = true;
      note_end_of_service();
      services_.push_back({begun_, record.at, record.event, record.routine});
      if (services_.size() > kServices) services_.pop_front();
      return;
    case TraceKind::CharacterReceived:
      return note_character(record);
    case TraceKind::EventOccurred:
    case TraceKind::EventLost:
      return note_event(record);
    case TraceKind::Transmit:
      reception_[record.port].frame = {};
      reception_[record.port].earlier.clear();
      return;
    case TraceKind::Attach:
    case TraceKind::Detach:
    case TraceKind::Receive:
      if (is_about_reception(record)) return note_reception(record);
      if (record.kind == TraceKind::Attach && serves_character()) note_restart(record);
      return;
    case TraceKind::ReceiveEnd:
      reception_[record.port].message_open = false;
      reception_[record.port].ended = record;
      return;
    case TraceKind::RuntimeError:
      failed_ = true;
      return;
    default:
      return;
  }
}

void TraceReasons::note_enable(const TraceRecord& record) {
  const bool by_instruction = disabled_ && disabled_->by != Disabled::By::NoEni;
  const std::optional<bool> enabled = by_instruction ? std::optional(disabled_->by == Disabled::By::Nothing) : std::nullopt;
  const bool changes = changes_interrupts(record, enabled);
  if (record.code == 1) {
    if (changes) enabled_ = {record, disabled_};
    disabled_ = Disabled{};
  } else {
    if (changes) disabled_ = {Disabled::By::Disi, record.op};
    enabled_.reset();
  }
}

void TraceReasons::forget(const Disabled& interrupts) {
  disabled_ = interrupts;
  enabled_.reset();
  services_.clear();
  forget_instructions();
}

void TraceReasons::forget_instructions() {
  last_.reset();
  in_interrupt_ = interrupt_ends_ = failed_ = false;
  main_.begin();
  interrupt_.begin();
  reception_ = {};
}

}  // namespace s7200
