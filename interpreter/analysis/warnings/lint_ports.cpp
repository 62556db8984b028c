// Warnings about the serial ports, and what is known of their PPI mode.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "interpreter/analysis/flow/first_scan.hpp"
#include "interpreter/analysis/warnings/lint.hpp"
#include "interpreter/analysis/warnings/lint_ops.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/program/checking/warnings.hpp"

namespace s7200 {

using namespace lint;

namespace {

/// Whether the next instruction follows, whatever happens.
bool goes_straight_on(const Instruction& instruction) {
  switch (instruction.structure) {
    case Structure::None:
    case Structure::Attach:
    case Structure::DefineCounter:
    case Structure::Compare:
      return instruction.effect != Effect::ConditionalEnd;
    default:
      return false;
  }
}

/// Whether a box or coil that follows has the same power flow.
bool keeps_power(const Instruction& instruction) {
  return instruction.rung.needs_power_flow || instruction.effect == Effect::Coil;
}

constexpr std::uint8_t kOnInFirstScan = sm::kAlwaysOn | sm::kFirstScan;

/// Whether an instruction may write the control byte of a port.
bool sets_up_port(const Facts& facts, std::uint32_t op, const PortInfo& port) {
  return may_write(facts, op, {port.control * 8u, 8});
}

/// Whether some instruction may write the control byte of a port. Without any, each XMT and RCV has its warning.
bool is_set_up(const Facts& facts, std::size_t number) {
  for (std::uint32_t op = 0; op < facts.program.ops.size(); ++op)
    if (sets_up_port(facts, op, kPorts[number])) return true;
  return false;
}

/// XMT and RCV.
bool uses_port(const Op& op) {
  return op.instruction->effect == Effect::Transmits || op.instruction->effect == Effect::Receives;
}

std::string control_text(const PortInfo& port) { return fmt::format("SMB{}", port.control - image::kSM); }

/// "XMT sends nothing"
std::string in_vain(const Op& op) {
  return fmt::format("{} {} nothing", op.instruction->mnemonic,
                     op.instruction->effect == Effect::Transmits ? "sends" : "receives");
}

/// What is surely executed with power flow, in order: from an op down to the first jump, call or end, in rungs that begin
/// with one of the bits of SMB0. `visit(op, on)` sees every op, and ends the walk by returning false.
template <class Visit>
void walk(const Program& program, std::uint32_t from, bool on, std::uint8_t sure_bits, const Visit& visit) {
  for (std::uint32_t i = from; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    const Instruction& instruction = *op.instruction;
    if (!visit(i, on) || !goes_straight_on(instruction)) return;
    if (instruction.effect == Effect::LoadsBit)
      on = op[0].at == sm::kScanStatus && (1u << op[0].bit & sure_bits) != 0;
    else
      on = on && keeps_power(instruction);
  }
}

/// XMT or RCV that the first scan surely executes before anything can have written the control byte of its port.
void find_early_use(const Facts& facts, std::size_t number, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  const PortInfo& port = kPorts[number];
  walk(program, 0, false, kOnInFirstScan, [&](std::uint32_t i, bool on) {
    const Op& op = program.ops[i];
    if (sets_up_port(facts, i, port)) return false;
    if (on && uses_port(op) && op[1].at == number)
      diagnostics.push_back(
          warn(Warning::NoFreeport, place(program, i),
               fmt::format("{} in the first scan: {}, which puts the port in Freeport mode, is written after it",
                           in_vain(op), control_text(port)),
               fmt::format("write {} first", control_text(port)), "no Freeport yet"));
    return true;
  });
}

bool is_event_of(const PortInfo& port, std::uint8_t event) {
  return event == port.received || event == port.sent || event == port.received_message;
}

void find_missing_freeport(const Facts& facts, std::size_t number, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  const PortInfo& port = kPorts[number];
  if (is_set_up(facts, number)) return find_early_use(facts, number, diagnostics);
  const auto add = [&](std::uint32_t op, const std::string& what) {
    diagnostics.push_back(
        warn(Warning::NoFreeport, place(program, op),
             fmt::format("{}: no instruction writes {} to put the port in Freeport mode", what, control_text(port)),
             fmt::format("MOVB 16#09, {} in the first scan selects Freeport mode with 9600 baud, 8 data bits and no parity",
                         control_text(port)),
             "no Freeport"));
  };
  for (const Effect effect : {Effect::Transmits, Effect::Receives})
    for (const std::uint32_t i : ops_with(program, effect))
      if (program.ops[i][1].at == number) add(i, in_vain(program.ops[i]));
  for (const std::uint32_t attach : attachments(program)) {
    const std::uint32_t event = program.ops[attach][1].at;
    if (is_event_of(port, static_cast<std::uint8_t>(event))) add(attach, fmt::format("event {} never occurs", event));
  }
}

/// The constant that a MOVB writes into the control byte of a port.
std::optional<std::uint8_t> written_to_control(const Program& program, const Op& op, const PortInfo& port) {
  const bool moves_into_it = op.instruction->effect == Effect::CopiesByte && op[1].at == port.control && !op[1].pointer;
  if (!moves_into_it || op[0].at < image::kConstants || op[0].pointer || op[0].unread()) return {};
  return program.constants[op[0].at - image::kConstants];
}

bool is_freeport(std::uint8_t control) { return (control & sm::kProtocol) == sm::kFreeport; }

/// Whether an instruction may put a port in another mode than PPI, of which a master answers too.
bool may_leave_ppi(const Facts& facts, std::uint32_t number, const PortInfo& port) {
  if (!sets_up_port(facts, number, port)) return false;
  const auto control = written_to_control(facts.program, facts.program.ops[number], port);
  return !control || is_freeport(*control);
}

}  // namespace

bool keeps_ppi_station(const Program& program, std::uint8_t port) {
  const Facts facts = facts_of(program);
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    const bool sets_station = op.instruction->effect == Effect::SetsStation && op[1].at == port;
    if (sets_station || may_leave_ppi(facts, i, kPorts[port])) return false;
  }
  return true;
}

std::optional<std::uint8_t> ppi_station_set(const Program& program, std::uint8_t port) {
  const Facts facts = facts_of(program);
  std::optional<std::uint8_t> station;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    if (may_leave_ppi(facts, i, kPorts[port])) return {};
    if (op.instruction->effect != Effect::SetsStation || op[1].at != port) continue;
    if (op[0].at < image::kConstants) return {};
    const std::uint8_t constant = program.constants[op[0].at - image::kConstants];
    if (station && *station != constant) return {};
    station = constant;
  }
  return station;
}

bool is_ppi_master(const Program& program, std::uint8_t port) {
  return std::ranges::any_of(program.ops, [&](const Op& op) {
    return (op.instruction->mnemonic == "NETR" || op.instruction->mnemonic == "NETW") && op[1].at == port;
  });
}

void find_missing_freeport(const Facts& facts, stl::Diagnostics& diagnostics) {
  for (std::size_t port = 0; port < facts.program.model->ports; ++port) find_missing_freeport(facts, port, diagnostics);
}

namespace {

/// Whether an op executes this instruction on a port; also if its port is unread.
bool uses(const Op& op, Effect effect, std::size_t number) {
  return op.instruction->effect == effect && (op[1].at == number || op[1].unread());
}

/// Whether some ATCH attaches an event, or may.
bool attaches(const Program& program, std::uint8_t event) {
  return std::ranges::any_of(program.ops, [&](const Op& op) {
    const bool attach = op.instruction->structure == Structure::Attach;
    return is_unread(op) || (attach && (op[1].at == event || op[1].unread()));
  });
}

/// `event 8`, `event 8 or 25`
std::string receive_events_text(const CpuModel& model) {
  std::string text = fmt::format("event {}", std::uint8_t{kPorts[0].received});
  for (std::size_t number = 1; number < model.ports; ++number)
    text += fmt::format(" or {}", std::uint8_t{kPorts[number].received});
  return text;
}

}  // namespace

void find_missing_receive_event(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  for (std::size_t number = 0; number < program.model->ports; ++number)
    if (attaches(program, kPorts[number].received)) return;
  const Bits received{sm::kReceivedCharacter * 8u, 8}, status{sm::kReceiveStatus * 8u, 8};
  const Bits both{received.first, received.count + status.count};
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    for (std::size_t k = 0; k < op.instruction->rules().size(); ++k) {
      const OperandRule& rule = op.instruction->operand[k];
      if (rule.kind != OperandKind::Memory || op[k].pointer || op[k].unread() || !both.contains(bits_of(program, op, k)))
        continue;
      diagnostics.push_back(warn(Warning::NoReceiveEvent, place(program, i),
                                 fmt::format("{} is always 0: no ATCH attaches {}, with which received characters get there",
                                             written(program, i, k), receive_events_text(*program.model)),
                                 "attach an interrupt routine to the event and read the character in it",
                                 "no receive event"));
    }
  }
}

namespace {

/// The first instruction that puts a port in Freeport mode. Interrupt routines cannot enter it (error 009A).
std::optional<std::uint32_t> first_freeport(const Program& program, const PortInfo& port) {
  bool in_interrupt = false;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Structure structure = program.ops[i].instruction->structure;
    if (begins_routine(structure)) in_interrupt = structure == Structure::InterruptHead;
    const auto control = written_to_control(program, program.ops[i], port);
    if (control && is_freeport(*control) && !in_interrupt) return i;
  }
  return {};
}

}  // namespace

void find_unused_freeport(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  const auto names_what_is_missing = [](const stl::Diagnostic& diagnostic) {
    return diagnostic.name == "no-freeport" || diagnostic.name == "no-receive-event";
  };
  if (has_unread(program) || std::ranges::any_of(diagnostics, names_what_is_missing)) return;
  for (std::size_t number = 0; number < program.model->ports; ++number) {
    const PortInfo& port = kPorts[number];
    const auto uses_it = [&](const Op& op) { return uses_port(op) && op[1].at == number; };
    if (std::ranges::any_of(program.ops, uses_it) || attaches(program, port.received)) continue;
    const auto found = first_freeport(program, port);
    if (!found) continue;
    diagnostics.push_back(warn(
        Warning::UnusedFreeport, place(program, *found),
        fmt::format("port {} is in Freeport mode and the program neither listens nor speaks there: no ATCH attaches event "
                    "{}, and no RCV or XMT is for this port",
                    number, std::uint8_t{port.received}),
        fmt::format("in Freeport mode the program itself is the protocol: attach an interrupt routine to event {}, or "
                    "receive with RCV; without Freeport the port speaks PPI",
                    std::uint8_t{port.received}),
        "nobody listens"));
  }
}

namespace {

/// Which routines are executed again and again, and which at most in the first scan or once after it.
class Repetition {
 public:
  explicit Repetition(const Program& program) : program_(program), first_scan_only_(ops_of_first_scan(program)) {
    std::uint32_t head = 0;
    for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
      const Instruction& instruction = *program.ops[i].instruction;
      if (begins_routine(instruction.structure)) {
        head = i;
        heads_.push_back(head);
      }
      head_.push_back(head);
      const bool calls = instruction.structure == Structure::Call || instruction.structure == Structure::Attach;
      if (calls || uses_port(program.ops[i])) starts_.push_back(i);
    }
    while (forget_one()) {
    }
  }

  bool again(std::uint32_t op) const { return !once_.contains(head_[op]) && !first_scan_only_[op]; }
  /// Whether the first scan may execute it, and nothing after that.
  bool once(std::uint32_t op) const { return !again(op) && (head_[op] == 0 || is_started(head_[op])); }

 private:
  /// Whether some CALL, ATCH, XMT or RCV is so.
  template <class Condition>
  bool any(const Condition& condition) const {
    return std::ranges::any_of(starts_, condition);
  }

  /// Whether an op calls a routine or attaches it.
  bool starts(std::uint32_t op, std::uint32_t head) const {
    const Op &start = program_.ops[op], &routine = program_.ops[head];
    if (routine.instruction->structure == Structure::SubroutineHead)
      return start.instruction->structure == Structure::Call && start.target == head;
    return start.instruction->structure == Structure::Attach && (start[0].at == routine[0].at || start[0].unread());
  }
  bool is_started(std::uint32_t head) const {
    return any([&](std::uint32_t i) { return starts(i, head); });
  }

  /// Whether an event may occur again: that of a message or a transmission only if RCV or XMT is executed again.
  bool event_occurs_again(std::uint32_t event) const {
    for (std::size_t number = 0; number < program_.model->ports; ++number)
      for (const auto& wait :
           {std::pair{kPorts[number].received_message, Effect::Receives}, std::pair{kPorts[number].sent, Effect::Transmits}})
        if (wait.first == event)
          return any([&](std::uint32_t i) { return uses(program_.ops[i], wait.second, number) && again(i); });
    return true;
  }

  bool routine_again(std::uint32_t head) const {
    return any([&](std::uint32_t i) {
      const bool by_call = program_.ops[i].instruction->structure == Structure::Call;
      return starts(i, head) && (by_call ? again(i) : event_occurs_again(program_.ops[i][1].at));
    });
  }

  /// A routine that nothing executes again, though it was thought so until now; false if there is none.
  bool forget_one() {
    const auto head = std::ranges::find_if(
        heads_, [&](std::uint32_t routine) { return !once_.contains(routine) && !routine_again(routine); });
    return head != heads_.end() && once_.insert(*head).second;
  }

  const Program& program_;
  std::vector<bool> first_scan_only_;
  std::vector<std::uint32_t> head_;    // of each op's routine; 0 for the main program
  std::vector<std::uint32_t> heads_;   // of the routines
  std::vector<std::uint32_t> starts_;  // CALL, ATCH, XMT and RCV
  std::set<std::uint32_t> once_;       // heads of the routines that nothing executes again
};

}  // namespace

void find_receive_once(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (ops_with(program, Effect::Receives).empty() || has_unread(program)) return;
  const Repetition repetition(program);
  for (std::size_t number = 0; number < program.model->ports; ++number) {
    if (!is_set_up(facts, number)) continue;
    std::optional<std::uint32_t> once;
    bool again = false;
    for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
      if (!uses(program.ops[i], Effect::Receives, number)) continue;
      again |= repetition.again(i);
      if (!once && repetition.once(i)) once = i;
    }
    if (again || !once) continue;
    const PortInfo& port = kPorts[number];
    diagnostics.push_back(warn(Warning::ReceiveOnce, place(program, *once),
                               "RCV is executed in the first scan only: after one message nothing receives the next",
                               fmt::format("execute RCV again when SMB{} is not 0, or in the routine of event {}",
                                           port.message - image::kSM, std::uint8_t{port.received_message})));
  }
}

namespace {

/// Whether RCV, when it is executed, surely begins to wait for a message: the program sets SM87.7 and never resets it.
bool receives_whenever_executed(const Facts& facts, const PortInfo& port) {
  const Program& program = facts.program;
  const std::uint32_t control = port.message + sm::message::kControl;
  bool set = false;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    if (!may_write(facts, i, {control * 8u, 8})) continue;
    const Op& op = program.ops[i];
    const bool constant = op.instruction->effect == Effect::CopiesByte && op[1].at == control &&
                          op[0].at >= image::kConstants && !op[0].unread() && !op[0].pointer;
    if (!constant || !(program.constants[op[0].at - image::kConstants] & sm::message::kEnable)) return false;
    set = true;
  }
  return set;
}

std::string_view instead_of(Effect first, Effect second) {
  if (first == Effect::Receives) return "execute XMT when the message has come, or end RCV before with SM87.7 = 0";
  return second == Effect::Receives ? "execute RCV in the routine of the event that all characters are sent"
                                    : "execute the next XMT when all characters are sent";
}

/// `when` is empty for what is always refused.
void warn_of_busy_port(const Program& program, std::size_t number, std::uint32_t first, std::uint32_t second,
                       std::string_view how, stl::Diagnostics& diagnostics, std::string_view when = {}) {
  const Instruction &earlier = *program.ops[first].instruction, &refused = *program.ops[second].instruction;
  diagnostics.push_back(
      warn(Warning::PortBusy, place(program, second),
           fmt::format("{} is refused with error {:04X}{}: {} of line {} {}", refused.mnemonic,
                       static_cast<std::uint16_t>(kPorts[number].busy), when, earlier.mnemonic, line(program, first), how),
           std::string(instead_of(earlier.effect, refused.effect)), fmt::format("port {} busy", number)));
}

/// XMT or RCV after another one in the same pass: with the same power flow, or both surely in the first scan.
void find_refused_in_one_pass(const Program& program, std::size_t number, bool rcv_waits, stl::Diagnostics& diagnostics) {
  std::vector<bool> sure(program.ops.size());
  walk(program, 0, false, kOnInFirstScan, [&](std::uint32_t i, bool on) {
    sure[i] = on;
    return true;
  });
  std::optional<std::uint32_t> begun;
  bool same_power = false;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    const Instruction& instruction = *op.instruction;
    const bool here = uses_port(op) && op[1].at == number;
    if (here && begun && (same_power || (sure[*begun] && sure[i]))) {
      warn_of_busy_port(program, number, *begun, i, "has just begun", diagnostics);
    } else if (here && (instruction.effect == Effect::Transmits || rcv_waits)) {
      begun = i;
      same_power = true;
    }
    same_power = same_power && goes_straight_on(instruction) && keeps_power(instruction);
    if (!goes_straight_on(instruction)) begun.reset();
  }
}

/// The RCV that the first scan surely executes, if it then waits until a message has come: the program leaves the port as
/// the first scan sets it.
std::optional<std::uint32_t> waiting_rcv(const Facts& facts, std::size_t number) {
  const Program& program = facts.program;
  const std::vector<bool> first_scan_only = ops_of_first_scan(program);
  for (std::uint32_t i = 0; i < program.ops.size(); ++i)
    if (sets_up_port(facts, i, kPorts[number]) && !first_scan_only[i]) return {};
  std::optional<std::uint32_t> rcv;
  walk(program, 0, false, kOnInFirstScan, [&](std::uint32_t i, bool on) {
    if (on && uses(program.ops[i], Effect::Receives, number)) rcv = i;
    return !rcv;
  });
  return rcv;
}

/// Whether the routine of an RCV's event surely executes RCV again, before anything is sent.
bool is_received_again_at_once(const Program& program, std::size_t number) {
  std::set<std::uint32_t> routines;
  for (const std::uint32_t attach : attachments(program))
    if (program.ops[attach][1].at == kPorts[number].received_message) routines.insert(program.ops[attach][0].at);
  if (routines.size() != 1 || *routines.begin() >= program.interrupt.size()) return false;
  const std::uint32_t head = program.interrupt[*routines.begin()];
  if (head == kNoRoutine || ops_with(program, Effect::EnablesInterrupts).empty()) return false;
  bool again = false;
  walk(program, head + 1, true, sm::kAlwaysOn, [&](std::uint32_t i, bool on) {
    again = on && uses(program.ops[i], Effect::Receives, number);
    return !again && !uses(program.ops[i], Effect::Transmits, number);
  });
  return again;
}

/// A contact whose value does not depend on what has been received: of an input or of SMB0.
bool depends_on_inputs_only(const Op& op) {
  const Instruction& instruction = *op.instruction;
  if (instruction.rules().empty()) return true;  // NOT, EU, ALD …
  const bool is_input = op[0].at < image::kQ || (op[0].at >= image::kInputs && op[0].at < image::kOutputs);
  return instruction.operand[0].width == Width::Bit && (is_input || op[0].at == sm::kScanStatus);
}

/// Whether inputs alone decide in each scan whether an op of the main program is executed.
bool is_executed_by_inputs_only(const Program& program, std::uint32_t op) {
  const auto leads_on = [&](std::uint32_t i) {
    return goes_straight_on(*program.ops[i].instruction) || program.ops[i].instruction->structure == Structure::Call;
  };
  for (std::uint32_t i = 0; i < op; ++i)
    if (!leads_on(i)) return false;
  std::uint32_t i = op;
  while (i > 0 && keeps_power(*program.ops[i - 1].instruction)) --i;
  for (; i > 0 && !program.ops[i - 1].instruction->rung.writes_output; --i)
    if (!depends_on_inputs_only(program.ops[i - 1])) return false;
  const StackUse first = program.ops[i].instruction->rung.stack;
  return first.needs == 0 && first.change == 1;  // it begins a rung
}

/// XMT that the program executes although an RCV waits.
void find_xmt_while_rcv_waits(const Facts& facts, std::size_t number, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  const auto rcv = waiting_rcv(facts, number);
  if (!rcv) return;
  const std::vector<bool> first_scan_only = ops_of_first_scan(program);
  const bool always = is_received_again_at_once(program, number);
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    if (!uses(program.ops[i], Effect::Transmits, number) || program.ops[i][1].unread() || first_scan_only[i]) continue;
    if (always)
      warn_of_busy_port(program, number, *rcv, i, "is executed again after each message, so that one always waits",
                        diagnostics);
    else if (is_executed_by_inputs_only(program, i))
      warn_of_busy_port(program, number, *rcv, i, "waits for one", diagnostics, " while no message has come");
  }
}

}  // namespace

void find_busy_port(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (has_unread(program)) return;
  for (std::size_t number = 0; number < program.model->ports; ++number) {
    if (!is_set_up(facts, number)) continue;
    const bool rcv_waits = receives_whenever_executed(facts, kPorts[number]);
    find_refused_in_one_pass(program, number, rcv_waits, diagnostics);
    if (rcv_waits) find_xmt_while_rcv_waits(facts, number, diagnostics);
  }
}

}  // namespace s7200
