#include "interpreter/trace/trace_reasons.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text.hpp"
#include "interpreter/program/networks.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/instruction_lines.hpp"

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

constexpr std::size_t kContacts = 16;  // of a rung, that are kept

/// Attaches, detaches or replaces what gets the characters of a port.
bool is_about_reception(const TraceRecord& record) {
  const bool attachment = record.kind == TraceKind::Attach || record.kind == TraceKind::Detach;
  return record.kind == TraceKind::Receive || (attachment && is_receive_event(record.event));
}

std::size_t port_of(const TraceRecord& record) {
  if (record.kind == TraceKind::Receive) return record.port;
  return record.event == kPorts[1].received ? 1 : 0;
}

bool is_always_on(const InstructionRecord& contact, const Program& program) {
  const Op& op = program.ops[contact.op];
  return op[0].at == sm::kScanStatus && op[0].bit == 0 && op.instruction->mnemonic == "LD";
}

/// `LDW= AC0, 0`: in a sentence, not in a column.
std::string short_text(const stl::Statement& statement) {
  std::string text = stl::to_text(statement);
  text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; }), text.end());
  return text;
}

std::string comment_of(const stl::Statement& statement) {
  return statement.comment.empty() ? "" : "  //" + stl::printable(statement.comment);
}

}  // namespace

std::string ignored_because(const TraceRecord& record) {
  switch (record.code) {
    case 1:
      return "in PPI mode, and no PPI frame";
    case 2:
      return "the receiver is off while the port sends";
    default:
      return fmt::format("event {} is not attached", kPorts[record.port].received);
  }
}

TraceReasons::TraceReasons(const Program& program) : program_(program) {
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
    const Instruction& instruction = *program.ops[op].instruction;
    const bool decides = instruction.structure == Structure::Jump || instruction.effect == Effect::ConditionalEnd;
    const bool none = instruction.structure == Structure::None || instruction.structure == Structure::Compare;
    Role role = none ? Role::Contact : Role::Mark;
    if (begins_rung(program, op)) role = Role::FirstContact;
    if (is_box_or_coil(program.ops[op])) role = Role::Other;
    if (decides) role = Role::Decides;
    role_.push_back(role);
  }
}

std::string TraceReasons::line_of(std::uint32_t op) const {
  return fmt::format("line {}", program_.statement(op).position.line);
}

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
  if (record.kind == TraceKind::EventOccurred && disabled_ == true)
    return fmt::format("; it waits: {}",
                       disabled_by_ ? "interrupts are disabled by DISI in " + line_of(*disabled_by_) : "no ENI so far");
  const std::string why = record.kind == TraceKind::ServiceBegin ? cause_of(record) : "";
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

std::string TraceReasons::held_up_by(const TraceRecord& begin) const {
  if (begin.at <= begin.since) return {};
  std::string why;
  if (enabled_ && enabled_->at > begin.since)
    why = fmt::format("{} until ENI in {}", disabled_by_ ? "DISI in " + line_of(*disabled_by_) : "no ENI",
                      line_of(enabled_->op));
  std::size_t others = 0;
  for (const Service& service : services_) others += service.end > begin.since ? 1 : 0;
  if (others > 0) {
    const Service& last = services_.back();
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
  for (const InstructionRecord& contact : contacts) {
    const std::string values = values_text(contact, program_);
    text += fmt::format("{}{}{}{}", text.empty() ? "" : "; ", short_text(program_.statement(contact.op)),
                        values.empty() ? "" : ":", values);
  }
  return text;
}

std::string TraceReasons::text_of(const Decision& decision) const {
  const stl::Statement& statement = program_.statement(decision.by.op);
  return fmt::format(
      "{} in {}{}{}{}", short_text(statement), line_of(decision.by.op), decision.by.powered ? "" : ", not taken",
      decision.contacts.empty() ? "" : fmt::format(" ({})", contacts_text(decision.contacts)), comment_of(statement));
}

std::optional<TraceReasons::Cause> TraceReasons::cause() const {
  const Flow& flow = in_interrupt_ ? interrupt_ : main_;
  const bool own = std::ranges::any_of(flow.contacts, [&](const auto& one) { return !is_always_on(one, program_); });
  if (own)
    return Cause{
        fmt::format("the contacts from {} on ({})", line_of(flow.contacts.front().op), contacts_text(flow.contacts)),
        flow.contacts.back(), flow.contacts.front(), true, in_interrupt_};
  if (!flow.decided) return {};
  return Cause{text_of(flow.decision), flow.decision.by, flow.decision.by, false, in_interrupt_};
}

std::string TraceReasons::cause_text() const {
  const auto found = cause();
  return found ? found->text : "";
}

bool TraceReasons::begins_again(const TraceRecord& record) const {
  if (record.kind == TraceKind::Receive) return true;
  return record.kind == TraceKind::Attach && kPorts[port_of(record)].received == record.event &&
         record.routine == frame_[port_of(record)].routine && !(in_interrupt_ && is_receive_event(serving_));
}

std::optional<TraceReasons::Unanswered> TraceReasons::unanswered(const TraceRecord& record) const {
  if (!last_ || !is_about_reception(record)) return {};
  const Frame& frame = frame_[port_of(record)];
  if (frame.characters == 0 || !begins_again(record)) return {};
  const std::string own = cause_text();
  return Unanswered{frame.characters, frame.since, own.empty() ? frame.decided_by : own};
}

// --- what has come ---

/// A frame begins after a pause of three characters, if the program has attached a routine to its characters since.
void TraceReasons::note_character(const TraceRecord& record) {
  Frame& frame = frame_[record.port];
  const bool pause = record.since - frame.last > 3 * (record.at - record.since);
  if (frame.characters == 0 || (frame.attached_anew && pause)) frame = {.since = record.since};
  ++frame.characters;
  frame.last = record.at;
  frame.attached_anew = false;
}

void TraceReasons::note_reception(const TraceRecord& record) {
  Frame& frame = frame_[port_of(record)];
  if (unanswered(record)) frame = {};
  frame.attached_anew = true;
  frame.decided_by = frame.characters > 0 ? cause_text() : "";
}

void TraceReasons::note(const InstructionRecord& record) {
  last_ = record;
  Flow& flow = in_interrupt_ ? interrupt_ : main_;
  switch (role_[record.op]) {
    case Role::Mark:
      flow.contacts.clear();
      break;
    case Role::FirstContact:
      flow.contacts.clear();
      [[fallthrough]];
    case Role::Contact:
      if (flow.contacts.size() < kContacts) flow.contacts.push_back(record);
      break;
    case Role::Decides:
      flow.decision.by = record;
      flow.decision.contacts = flow.contacts;
      flow.decided = true;
      if (record.powered) flow.contacts.clear();
      break;
    case Role::Other:
      break;
  }
  if (std::exchange(interrupt_ends_, false)) in_interrupt_ = false;
}

void TraceReasons::note(const TraceRecord& record) {
  switch (record.kind) {
    case TraceKind::ScanBegin:
      main_.clear();
      return;
    case TraceKind::ModeChange:
      forget();
      disabled_ = true;
      return;
    case TraceKind::Enable:
      if (record.code == 1) {
        if (disabled_ == true) enabled_ = record;
        disabled_ = false;
      } else {
        if (disabled_ != true) disabled_by_ = record.op;
        disabled_ = true;
        enabled_.reset();
      }
      return;
    case TraceKind::ServiceBegin:
      in_interrupt_ = true;
      interrupt_ends_ = false;
      serving_ = record.event;
      interrupt_.clear();
      return;
    case TraceKind::ServiceEnd:
      interrupt_ends_ = true;
      services_.push_back({record.at, record.event, record.routine});
      if (services_.size() > kServices) services_.pop_front();
      return;
    case TraceKind::CharacterReceived:
      return note_character(record);
    case TraceKind::EventOccurred:
    case TraceKind::EventLost:
      for (std::size_t port = 0; port < kPorts.size(); ++port)
        if (record.event == kPorts[port].received && frame_[port].characters == 1) frame_[port].routine = record.routine;
      return;
    case TraceKind::Transmit:
      frame_[record.port] = {};
      return;
    case TraceKind::Attach:
    case TraceKind::Detach:
    case TraceKind::Receive:
      if (is_about_reception(record)) note_reception(record);
      return;
    default:
      return;
  }
}

void TraceReasons::forget() {
  disabled_.reset();
  disabled_by_.reset();
  enabled_.reset();
  services_.clear();
  forget_instructions();
}

void TraceReasons::forget_instructions() {
  last_.reset();
  in_interrupt_ = interrupt_ends_ = false;
  main_.clear();
  interrupt_.clear();
  frame_ = {};
}

}  // namespace s7200
