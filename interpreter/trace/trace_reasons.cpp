#include "interpreter/trace/trace_reasons.hpp"

#include <fmt/format.h>

#include "interpreter/base/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/line_parts.hpp"

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

}  // namespace

std::string TraceReasons::line_of(std::uint32_t op) const {
  return fmt::format("line {}", program_.statement(op).position.line);
}

/// Where the program did it.
const std::string& TraceReasons::place_of(std::uint32_t op) {
  const auto [known, added] = places_.try_emplace(op);
  if (!added) return known->second;
  const stl::Statement& statement = program_.statement(op);
  known->second = fmt::format("  {}: {}{}", line_of(op), stl::to_text(statement),
                              statement.comment.empty() ? "" : "  //" + stl::printable(statement.comment));
  return known->second;
}

void TraceReasons::append(fmt::memory_buffer& text, const TraceRecord& record) {
  if (has_place(record)) append_part(text, place_of(record.op));
  if (record.kind == TraceKind::ServiceBegin && record.at > record.since)
    if (const std::string why = cause_of(record); !why.empty()) s7200::append(text, ": ", why);
  note(record);
}

/// Of an interrupt that waited: or the instruction that was not over.
std::string TraceReasons::cause_of(const TraceRecord& begin) const {
  std::string why = held_up_by(begin);
  if (!why.empty() || begin.op == kNoRoutine) return why;
  return fmt::format("{} was being executed: {}", line_of(begin.op), stl::to_text(program_.statement(begin.op)));
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
  return why;
}

void TraceReasons::note(const TraceRecord& record) {
  switch (record.kind) {
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
    case TraceKind::ServiceEnd:
      services_.push_back({record.at, record.event, record.routine});
      if (services_.size() > kServices) services_.pop_front();
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
}

}  // namespace s7200
