#include "tools/session/stops/asked_by_programs.hpp"

#include <algorithm>

#include "tools/session/past/line_times.hpp"

namespace s7200::tools {

void AskedByPrograms::begin(Time now, const std::vector<HeardFrames::Frame>&) {
  given_up_.assign(of_plcs().lines().size(), 0);
  judged_ = given_up_;
  for (std::size_t line = 0; line < given_up_.size(); ++line) {
    const std::optional<PlcRequests::Request>& last = of_plcs().last(line);
    if (last && now - last->end >= host_timeout()) given_up_[line] = last->end;
    if (hears(line) && end_of_answer(line) <= now) judged_[line] = last->end;
  }
}

/// A program that asks again while it hears its answer cannot take it. What another one asks is the last that it hears of
/// it.
void AskedByPrograms::note_record(std::size_t station, const TraceRecord& record) {
  const bool is_transmit = record.kind == TraceKind::Transmit, asks = of_plcs().ends_request(station, record);
  if (!is_transmit && !asks && !of_plcs().gives_up(station, record)) return;
  const std::size_t line = of_plcs().line_of(station, record.port);
  if (asks && hears(line) && of_plcs().last(line)->answer) judge(line);
  if (is_transmit && hears(line) && of_plcs().last(line)->station == station) {
    const PlcRequests::Request& last = *of_plcs().last(line);
    if (last.answer || of_plcs().is_sending(line)) {
      given_up_[line] = last.end;
      judge(line);
    }
  }
  if (of_plcs().gives_up(station, record)) give_up(line);
}

void AskedByPrograms::look(Time now) {
  for (std::size_t line = 0; line < given_up_.size(); ++line) {
    if (hears(line) && end_of_answer(line) <= now) judge(line);
    if (timeout_at(line) <= now) give_up(line);
  }
}

Time AskedByPrograms::next_timeout() const {
  Time next = kNever;
  for (std::size_t line = 0; line < given_up_.size(); ++line) {
    next = std::min(next, timeout_at(line));
    if (hears(line)) next = std::min(next, end_of_answer(line));
  }
  return next;
}

bool AskedByPrograms::has_patient_one() const {
  for (std::size_t line = 0; line < given_up_.size(); ++line)
    if (waits(line) || hears(line)) return true;
  return false;
}

/// A program has asked on that line, and nobody has answered yet.
bool AskedByPrograms::waits(std::size_t line) const {
  const std::optional<PlcRequests::Request>& last = of_plcs().last(line);
  return last && last->waits() && last->end != given_up_[line];
}

/// kNever if none waits, or if what may be its answer is being sent.
Time AskedByPrograms::timeout_at(std::size_t line) const {
  return waits(line) && !of_plcs().is_sending(line) ? of_plcs().last(line)->end + host_timeout() : kNever;
}

void AskedByPrograms::give_up(std::size_t line) {
  if (!waits(line)) return;
  const PlcRequests::Request& last = *of_plcs().last(line);
  given_up_[line] = judged_[line] = last.end;
  tell({.line = line, .frame = last.frame, .asker = {Asker::Kind::Plc, last.station}});
}

// --- its answer ---

/// Something of it that was not judged yet.
bool AskedByPrograms::hears(std::size_t line) const {
  const std::optional<PlcRequests::Request>& last = of_plcs().last(line);
  return last && !last->heard.bytes.empty() && last->end != judged_[line];
}

/// If nothing more comes. A bridge may have got only a part of it yet.
Time AskedByPrograms::end_of_answer(std::size_t line) const {
  const PlcRequests::Request& last = *of_plcs().last(line);
  const bool is_bridged = !history().hosts_on(of_plcs().lines()[line]->line()).empty();
  if (is_bridged && !wrong_at(line).empty()) return last.heard.to + kNextPiece;
  const std::uint8_t port = of_plcs().port_on(line, last.station).value();
  return last.heard.to + history().station(last.station).plc().port_format(port).silence();
}

std::string AskedByPrograms::wrong_at(std::size_t line) const {
  const auto& [bytes, to, parity_error, framing_error] = of_plcs().last(line)->heard;
  const std::string_view damage = parity_error    ? "characters with wrong parity"
                                  : framing_error ? "characters with framing errors"
                                                  : "";
  return wrong_with(of_plcs().last(line)->frame, bytes, damage);
}

void AskedByPrograms::judge(std::size_t line) {
  const PlcRequests::Request& last = *of_plcs().last(line);
  judged_[line] = last.end;
  if (std::string wrong = wrong_at(line); !wrong.empty())
    tell({line, last.frame, Asker{Asker::Kind::Plc, last.station}, std::move(wrong), last.heard.bytes});
}

}  // namespace s7200::tools
