#include "tools/session/causes/witness.hpp"

#include <string_view>

#include "interpreter/model/ports.hpp"

namespace s7200::tools {

Witness::Witness(History& history, std::size_t station, std::uint8_t port, StopToken stop_request)
    : Reader(stop_request),
      reasons(history.station(station).cpu().program()),
      line(history, station, port),
      history_(history),
      station_(station),
      port_(port) {}

bool Witness::before_action() {
  line.note_action();
  return true;
}

/// In STOP what has led there stays known.
void Witness::record(const TraceRecord& record) {
  line.note(history_.told_of(), record);
  if (history_.told_of() != station_) return;
  if (record.kind == TraceKind::Transmit) left_.clear();
  for (const auto& frame : reasons.unanswered(record)) left_.push_back({record.at, record.at, frame});
  if (record.kind == TraceKind::ModeChange) stopped_ = record.code == 0;
  note_for_interrupts(record);
  if (record.kind == TraceKind::ServiceEnd) services_.push_back({record.routine, record.since, record.at});
  if (!stopped_) note_scan(record);
  if (!stopped_) reasons.note(record);
}

void Witness::instruction(const InstructionRecord& record) {
  if (history_.told_of() != station_) return;
  note_passed_over(record);
  note_scan(record);
  reasons.note(record);
}

void Witness::note_scan(const TraceRecord& record) {
  if (record.kind == TraceKind::ScanBegin) {
    repeated_.clear();
    served_.clear();
  } else if (record.kind == TraceKind::ServiceBegin) {
    ++served_[record.routine];
  } else if (record.kind == TraceKind::RuntimeError && record.op != kNoRoutine) {
    const Op& op = history_.station(station_).cpu().program().ops[record.op];
    const bool is_own = op.instruction->mnemonic == "XMT" && op[1].at == port_;
    if (is_own) refused_.push_back({record.at, record.op, record.code});
  }
}

/// To be told before the reasons are.
void Witness::note_scan(const InstructionRecord& record) {
  const std::string_view mnemonic = history_.station(station_).cpu().program().ops[record.op].instruction->mnemonic;
  if (mnemonic == "STOP" && record.powered) stop_executed_ = {record.op, reasons.contacts()};
  if (mnemonic == "NEXT" || (mnemonic == "JMP" && record.powered)) ++repeated_[record.op];
}

Witness::Most Witness::most_of(const std::unordered_map<std::uint32_t, std::size_t>& counts) {
  Most most;
  for (const auto& [what, times] : counts)
    if (times > most.times || (times == most.times && what < most.what)) most = {what, times};
  return most;
}

/// To be told before the reasons are: what they know is in front of it.
void Witness::note_passed_over(const InstructionRecord& record) {
  const Program& program = history_.station(station_).cpu().program();
  if (record.powered || program.ops[record.op].instruction->mnemonic != "RCV") return;
  passed_over_[record.op] = {record.at, reasons.contacts()};
}

const Witness::PassedOver* Witness::passed_over(std::uint32_t op) const {
  const auto found = passed_over_.find(op);
  return found == passed_over_.end() ? nullptr : &found->second;
}

/// The event of a character is recorded right after it.
void Witness::note_for_interrupts(const TraceRecord& record) {
  if (record.kind == TraceKind::CharacterReceived) character_ = record.since;
  if (record.kind != TraceKind::EventOccurred && record.kind != TraceKind::EventLost) return;
  for (std::uint8_t port = 0; port < kPorts.size(); ++port)
    if (kPorts[port].received == record.event)
      for_interrupts_.push_back(
          {.since = character_, .at = record.at, .port = port, .lost = record.kind == TraceKind::EventLost});
}

std::vector<Witness::Left> Witness::left_since(Time since, Time now) const {
  std::vector<Left> all = left_;
  for (const auto& frame : reasons.unread()) all.push_back({frame.since, now, frame});
  std::erase_if(all, [&](const Left& one) { return one.known < since; });
  return all;
}

std::vector<Witness::ForInterrupt> Witness::for_interrupts_since(std::uint8_t port, Time since) const {
  std::vector<ForInterrupt> all = for_interrupts_;
  std::erase_if(all, [&](const ForInterrupt& one) { return one.port != port || one.since < since; });
  return all;
}

std::vector<Witness::Service> Witness::services_since(Time since) const {
  std::vector<Service> all = services_;
  std::erase_if(all, [&](const Service& one) { return one.at < since; });
  return all;
}

}  // namespace s7200::tools
