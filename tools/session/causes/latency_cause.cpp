#include "tools/session/causes/latency_cause.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/model/ports.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "interpreter/trace/trace_reasons.hpp"
#include "tools/session/past/reader.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// What a PLC does from a request to its answer.
class AnswerReader final : public Reader {
 public:
  AnswerReader(const History& history, std::size_t station, std::uint8_t port, Time asked, StopToken stop)
      : Reader(station, stop), cpu_(history.station(station).cpu()), reasons_(cpu_.program()), port_(port), asked_(asked) {}

  struct Service {
    std::uint8_t event = 0, routine = 0;
    Time occurred = 0, begin = 0, end = 0;  ///< end: 0 while it runs
    Time interval = 0;                      ///< of a timed interrupt, from the ATCH before
    std::string held_up_by{};
  };

  struct Transmit {
    std::uint32_t op = 0;
    Time at = 0;
    bool in_interrupt = false;
    std::optional<Service> service{};  ///< in which it was executed, or the last one attached since the request
    std::string contacts{};
    Time scan_begin = 0;
  };

  void record(const TraceRecord& record) override {
    switch (record.kind) {
      case TraceKind::ServiceBegin:
        service_ = {.event = record.event,
                    .routine = record.routine,
                    .occurred = record.since,
                    .begin = record.at,
                    .interval = interval_of(record.event),
                    .held_up_by = held_up_by(record)};
        break;
      case TraceKind::ServiceEnd:
        service_.end = record.at;
        if (record.event == kPorts[port_].received)
          character_ = service_;
        else if (attached_at(record.event) >= asked_)
          attached_since_ = service_;
        break;
      case TraceKind::ReceiveEnd:
        if (record.port == port_) message_end_ = record.at;
        break;
      case TraceKind::Attach:
        if (record.event < attached_.size()) attached_[record.event] = {record.at, record.interval};
        break;
      case TraceKind::Transmit:
        if (record.port == port_ && record.at >= asked_ && !transmit) note_transmit(record);
        break;
      default:
        break;
    }
    reasons_.note(record);
  }
  void instruction(const InstructionRecord& record) override { reasons_.note(record); }

  std::optional<Transmit> transmit{};
  const std::optional<Service>& character() const { return character_at_transmit_; }
  std::optional<Time> message_end() const { return message_end_; }

 private:
  std::string held_up_by(const TraceRecord& begin) const {
    const std::string why = reasons_.held_up_by(begin);
    return why.empty() ? "" : ": " + why;
  }
  Time interval_of(std::uint8_t event) const { return event < attached_.size() ? attached_[event].interval : 0; }
  Time attached_at(std::uint8_t event) const { return event < attached_.size() ? attached_[event].at : 0; }

  void note_transmit(const TraceRecord& record) {
    const State& state = cpu_.state();
    transmit = {.op = record.op,
                .at = record.at,
                .in_interrupt = state.in_interrupt,
                .service = state.in_interrupt ? std::optional(service_) : attached_since_,
                .contacts = reasons_.contacts(),
                .scan_begin = state.scan_begin};
    const bool in_own = state.in_interrupt && service_.event == kPorts[port_].received;
    character_at_transmit_ = in_own ? std::optional(service_) : character_;
  }

  const Cpu& cpu_;
  TraceReasons reasons_;
  std::uint8_t port_;
  Time asked_;
  Service service_{};
  std::optional<Service> character_{}, character_at_transmit_{};
  std::optional<Time> message_end_{};
  struct Attached {
    Time at = 0, interval = 0;
  };
  std::array<Attached, 64> attached_{};  ///< by event
  std::optional<Service> attached_since_{};
};

std::string wait_text(Time from, Time to, const std::string& what) {
  return fmt::format("{}  {}: {}", moment_text(from), format_duration(to - std::min(from, to), 3), what);
}

/// How the program came to XMT after it had the last character.
std::string program_text(const AnswerReader::Transmit& transmit, const Program& program) {
  const std::string by = named_without_comment(transmit.op, program);
  const std::string comment = comment_of(program.statement(transmit.op));
  const std::string contacts = transmit.contacts.empty() ? "" : fmt::format(" ({})", transmit.contacts);
  if (!transmit.in_interrupt)
    return fmt::format("until the main program came to {}{}, in the scan that began at {}{}", by, contacts,
                       moment_text(transmit.scan_begin), comment);
  return fmt::format("until INT {} executed {}{}; it serves {}{}", transmit.service->routine, by, contacts,
                     event_text(transmit.service->event), comment);
}

std::vector<std::string> lines_of(const AnswerReader& reader, const Program& program, const serial::Exchange& exchange) {
  const AnswerReader::Transmit& transmit = *reader.transmit;
  std::vector<std::string> lines;
  Time from = exchange.request_end;
  const auto& character = reader.character();
  if (character && character->occurred >= from - kMillisecond && character->begin > character->occurred) {
    lines.push_back(wait_text(character->occurred, character->begin,
                              fmt::format("the last character waited in the interrupt queue for INT {}{}",
                                          character->routine, character->held_up_by)));
    from = std::max(from, character->begin);
  } else if (const auto end = reader.message_end(); end && *end >= from - kMillisecond && *end <= transmit.at) {
    lines.push_back(wait_text(from, *end, "until RCV took the message for complete"));
    from = std::max(from, *end);
  }
  if (const auto& service = transmit.service; service && service->occurred > from) {
    const std::string silence =
        service->interval == 0 ? "" : fmt::format(", a timed interrupt of {}", format_duration(service->interval));
    lines.push_back(wait_text(from, service->occurred, fmt::format("until {} came{}", event_text(service->event), silence)));
    if (service->begin > service->occurred)
      lines.push_back(
          wait_text(service->occurred, service->begin,
                    fmt::format("it waited in the interrupt queue for INT {}{}", service->routine, service->held_up_by)));
    from = service->begin;
  }
  lines.push_back(wait_text(from, transmit.at, program_text(transmit, program)));
  if (exchange.response_start > transmit.at)
    lines.push_back(wait_text(transmit.at, exchange.response_start, "from XMT to the first start bit"));
  return lines;
}

}  // namespace

std::optional<std::vector<std::string>> latency_cause(History& history, std::size_t station,
                                                      const serial::Exchange& exchange, StopToken stop_request) {
  constexpr Time kBefore = kSecond;  // who attached a timed interrupt, and with which interval, is mostly seen
  const Moment start = history.now();
  const std::size_t line = history.requests().line_of(station, history.station(station).port());
  std::vector<std::string> lines;
  bool interrupted = false;
  for (std::size_t plc = 0; plc < history.stations() && lines.empty() && !interrupted; ++plc) {
    const auto port = history.requests().port_on(line, plc);
    if (!port) continue;
    AnswerReader reader(history, plc, *port, exchange.request_start, stop_request);
    interrupted =
        !history.go_to(exchange.request_start - std::min(exchange.request_start, kBefore)) || !history.play(reader, start);
    if (reader.transmit && reader.transmit->at <= exchange.response_start)
      lines = lines_of(reader, history.station(plc).cpu().program(), exchange);
    if (history.stations() > 1)
      for (std::string& one : lines) one = fmt::format("{}: {}", history.name_of(plc), one);
  }
  history.go_to(start);
  if (interrupted) return {};
  return lines;
}

}  // namespace s7200::tools
