#include "tools/debugger/line_account.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "serial_sim/line/frame.hpp"
#include "tools/views/faults.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

/// `8 characters from 2012.100000 ms to 2020.400000 ms`
std::string span_text(std::size_t characters, Time from, Time to) {
  return fmt::format("{} from {} to {}", characters_text(characters), moment_text(from), moment_text(to));
}

/// `none of them`, `01 83 instead of 01 03`; nothing if the master has heard what was sent.
std::string heard_text(const serial::Exchange& exchange, const std::vector<std::uint8_t>& sent) {
  const Bytes heard = exchange.response_bytes();
  if (heard.empty()) return sent.size() == 1 ? "nothing of it" : "none of them";
  if (heard != sent) return fmt::format("{} instead of {}", serial::to_hex(heard), serial::to_hex(sent));
  if (exchange.parity_error()) return "them with wrong parity";
  return exchange.framing_error() ? "them without a stop bit" : "";
}

}  // namespace

LineAccount::LineAccount(History& history, std::size_t station) : history_(history), station_(station) {}

bool LineAccount::is_on_line(std::size_t station, const TraceRecord& record) const {
  const serial::Simulation& its = history_.station(station);
  return record.port == its.port() && &its.line() == &here().line();
}

void LineAccount::note(std::size_t station, const TraceRecord& record) {
  if (!is_on_line(station, record)) return;
  switch (record.kind) {
    case TraceKind::Transmit:
      sent_.push_back({.station = station, .from = record.at, .to = record.at});
      if (station == station_) untaken_.clear();
      return;
    case TraceKind::CharacterSent: {
      const auto own = std::find_if(sent_.rbegin(), sent_.rend(), [&](const auto& one) { return one.station == station; });
      if (own == sent_.rend()) return;  // of a transmission that began before
      own->bytes.push_back(record.byte);
      own->to = record.at;
      return;
    }
    case TraceKind::CharacterIgnored:
    case TraceKind::CharacterDropped:
      if (station == station_) note_untaken(record);
      return;
    case TraceKind::CharacterReceived:
      if (station == station_) heard_ = record.since;
      return;
    default:
      return;
  }
}

/// A frame begins after a pause of three characters.
void LineAccount::note_untaken(const TraceRecord& record) {
  heard_ = record.since;
  const auto goes_on = [&](const Untaken& last) {
    const bool same = last.first.kind == record.kind && last.first.code == record.code;
    return same && record.since - last.end <= 3 * (record.at - record.since);
  };
  if (untaken_.empty() || !goes_on(untaken_.back())) untaken_.push_back({.first = record});
  ++untaken_.back().characters;
  untaken_.back().end = record.at;
}

bool LineAccount::is_over(const serial::Exchange& exchange) const {
  const serial::Requester& master = here().master();
  if (exchange.request_end == 0 || here().freeport().transmitting) return false;
  return !master.asks() || master.state().phase == serial::Requester::Phase::Waiting;
}

/// All that the PLC sent from the begin of the request until the master had its answer; no bytes if there is none.
LineAccount::Transmission LineAccount::answer_to(const serial::Exchange& exchange) const {
  Transmission answer;
  for (const Transmission& sent : sent_) {
    const bool too_late = !exchange.response.empty() && sent.from > exchange.response_end;
    if (sent.station != station_ || sent.to <= exchange.request_start || too_late || sent.bytes.empty()) continue;
    if (answer.bytes.empty()) answer.from = sent.from;
    answer.to = sent.to;
    answer.bytes.insert(answer.bytes.end(), sent.bytes.begin(), sent.bytes.end());
  }
  return answer;
}

std::optional<TraceLine> LineAccount::lost(const serial::Exchange& exchange) const {
  if (!is_over(exchange)) return {};
  const Transmission answer = answer_to(exchange);
  if (answer.bytes.empty()) return lost_request(exchange);
  const std::string heard = heard_text(exchange, answer.bytes);
  if (heard.empty()) return {};
  return TraceLine{answer.to,
                   fmt::format("the PLC sent {}, and the master heard {}{}",
                               span_text(answer.bytes.size(), answer.from, answer.to), heard, reasons(exchange, answer))};
}

/// In PPI mode the characters of its own frames are in no record.
std::optional<TraceLine> LineAccount::lost_request(const serial::Exchange& exchange) const {
  if (!exchange.response.empty() || has_heard_since(exchange.request_start) || !here().freeport().active) return {};
  return TraceLine{
      exchange.request_end,
      fmt::format("the master sent {}, and the PLC heard nothing{}",
                  span_text(exchange.request.size(), exchange.request_start, exchange.request_end), reasons(exchange, {}))};
}

/// What is known to have disturbed it.
std::string LineAccount::reasons(const serial::Exchange& exchange, const Transmission& answer) const {
  std::vector<std::string> all = fault_notes(here().faults(), faults_before_, here().time());
  const bool answered = !answer.bytes.empty();
  if (answered && answer.from < exchange.request_end)
    all.push_back("the master was still sending, up to " + moment_text(exchange.request_end));
  if (const Time given_up = exchange.request_end + here().master().state().request.timeout;
      answered && exchange.timed_out && answer.from >= given_up)
    all.push_back("the master had given up at " + moment_text(given_up));
  for (const Transmission& other : sent_)
    if (answered && other.station != station_ && other.from < answer.to && other.to > answer.from)
      all.push_back(fmt::format("another PLC sent {}", span_text(other.bytes.size(), other.from, other.to)));
  const SerialFormat master = here().master_uart().state().format, port = here().port_format();
  if (master != port) all.push_back(fmt::format("the master has {}, the port {}", format_text(master), format_text(port)));
  return all.empty() ? "" : fmt::format(": {}", fmt::join(all, "; "));
}

}  // namespace s7200::tools
