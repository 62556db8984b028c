#include "interpreter/cpu/network.hpp"

#include <algorithm>

#include "interpreter/cpu/ports/ppi.hpp"
#include "interpreter/cpu/units.hpp"
#include "interpreter/model/s7_pdu.hpp"

namespace s7200::network {
namespace {

using Phase = NetworkPort::Phase;
using Span = std::span<const std::uint8_t>;

constexpr Time kReplyTimeout = 150 * kMillisecond;  // and three tries: what clients give a CPU (facts 10.9)
constexpr int kTries = 3;

// Places in a table.
constexpr std::uint32_t kStation = 1, kPointer = 2, kLength = 6, kData = 7;

/// The job that a table asks for, as the table is when the instruction is executed: the program may write to it while the
/// job waits.
NetworkPort::Job job_of(const Core& core, std::uint32_t table, bool writes) {
  const std::uint8_t* const bytes = &core.s.image[table];
  return {.table = table,
          .pointer = load32(bytes + kPointer),
          .station = bytes[kStation],
          .length = bytes[kLength],
          .writes = writes};
}

/// The area that the top byte of a pointer means; null for an area that has no pointer, or that other stations do not show.
const s7::WireArea* area_of(std::uint32_t pointer) {
  constexpr std::array kShown{Area::I, Area::Q, Area::M, Area::V};
  const auto found = std::ranges::find_if(s7::kWireAreas, [&](const s7::WireArea& wire) {
    return std::ranges::count(kShown, wire.area) != 0 && info(wire.area).pointer_code == pointer >> 24;
  });
  return found == s7::kWireAreas.end() ? nullptr : &*found;
}

bool is_possible(const Core& core, std::uint8_t port, const NetworkPort::Job& job) {
  return job.station <= ppi::kLastStation && job.station != core.s.station[port] && area_of(job.pointer) != nullptr &&
         (job.pointer & 0xFF'FFFF) <= 0xFFFF && job.length >= 1 && job.length <= NetworkPort::kMostBytes &&
         core.in_area(job.table, kData + job.length);
}

void put_status(Core& core, std::uint8_t port, const NetworkPort::Job& job, std::uint8_t status) {
  core.s.image[job.table] = status;
  core.trace({.at = core.s.time,
              .kind = TraceKind::NetworkJob,
              .event = job.station,
              .routine = job.writes,
              .byte = status,
              .port = port,
              .op = job.table,
              .count = job.length});
}

constexpr std::uint8_t failed(NetworkError error) {
  return static_cast<std::uint8_t>(kJobDone | kJobError | static_cast<std::uint8_t>(error));
}

s7::Function function_of(const NetworkPort::Job& job) { return job.writes ? s7::kWrite : s7::kRead; }

Bytes request_of(const Core& core, const NetworkPort& port) {
  const NetworkPort::Job& job = port.jobs.front();
  Bytes parameters{function_of(job), 1};
  append(
      parameters,
      s7::Variable{
          .type = s7::kByte, .count = job.length, .area = area_of(job.pointer)->area, .first = (job.pointer & 0xFFFF) * 8});
  Bytes data;
  if (job.writes) {
    data = {0, s7::kInBitsOfBytes};
    s7::append16(data, std::size_t{job.length} * 8);
    const auto first = core.s.image.begin() + job.table + kData;
    data.insert(data.end(), first, first + job.length);
  }
  return s7::pdu(s7::kRequest, port.number, parameters, data);
}

std::uint8_t timer_of(std::uint8_t port) { return static_cast<std::uint8_t>(kNetworkTimer0 + port); }

void send(Core& core, std::uint8_t number, std::uint8_t function, const Bytes& data, Time at) {
  const Bytes frame = ppi::to_frame({core.s.network[number].jobs.front().station, core.s.station[number], function, data});
  ppi::send(core, number, frame, at);
  const Time end = at + static_cast<Time>(frame.size()) * ppi::format_of(core.program(), number).character_time();
  core.schedule(end + core.by_own_clock(kReplyTimeout), timer_of(number));
}

void ask(Core& core, std::uint8_t number, Time at) {
  NetworkPort& port = core.s.network[number];
  port.phase = Phase::Asked;
  send(core, number, ppi::kRequestFunction, request_of(core, port), at);
}

void poll(Core& core, std::uint8_t number, Time at) {
  NetworkPort& port = core.s.network[number];
  port.phase = Phase::Polled;
  const std::uint8_t count = port.frame_count ? ppi::kFrameCount : 0;
  send(core, number, static_cast<std::uint8_t>(ppi::kPollFunction ^ count), {}, at);
}

void end(Core& core, std::uint8_t number, std::uint8_t status) {
  core.cancel(timer_of(number));
  core.s.network[number].phase = Phase::Over;
  core.s.network[number].status = status;
}

/// The status with which the job ends after this answer. Its data go to the port.
std::uint8_t status_of(NetworkPort& port, Span pdu) {
  constexpr std::size_t kCode = s7::kAnswerHead + 2, kValue = kCode + 4;
  const NetworkPort::Job& job = port.jobs.front();
  const bool is_answer = pdu.size() > kCode && pdu[0] == s7::kProtocol && pdu[1] == s7::kAnswer &&
                         load16(&pdu[4]) == port.number && load16(&pdu[10]) == 0 &&
                         pdu[s7::kAnswerHead] == function_of(job) && pdu[s7::kAnswerHead + 1] == 1;
  if (!is_answer) return failed(NetworkError::Layer7);
  if (pdu[kCode] != s7::kDone) return failed(NetworkError::Message);
  if (job.writes) return kJobDone;
  if (pdu.size() < kValue + job.length || pdu[kCode + 1] != s7::kInBitsOfBytes || load16(&pdu[kCode + 2]) != job.length * 8)
    return failed(NetworkError::Layer7);
  std::copy_n(pdu.begin() + kValue, job.length, port.data.begin());
  return kJobDone;
}

void take_reply(Core& core, std::uint8_t number, const ppi::Body& body) {
  NetworkPort& port = core.s.network[number];
  if (body.source != port.jobs.front().station || body.destination != core.s.station[number]) return;
  switch (body.function) {
    case ppi::kNoResource:
      return end(core, number, failed(NetworkError::NoResource));
    case ppi::kNoService:
      return end(core, number, failed(NetworkError::Layer7));
    case ppi::kData:
      if (port.phase == Phase::Polled) return end(core, number, status_of(port, body.data));
      return;
    default:
      return;
  }
}

/// The instant at which the line has been silent for long enough to ask, if nothing more comes.
Time silent_from(const Core& core, std::uint8_t number) {
  return core.s.ppi[number].heard + ppi::format_of(core.program(), number).bit_times(ppi::kBitsOfSilence);
}

void take_up_next(Core& core, std::uint8_t number) {
  NetworkPort& port = core.s.network[number];
  ++port.number;
  port.tries = 1;
  port.damaged = port.frame_count = false;
  ask(core, number, std::max(core.s.time, silent_from(core, number)));
}

void strike_off_first(NetworkPort& port) {
  std::shift_left(port.jobs.begin(), port.jobs.begin() + port.count, 1);
  port.jobs[--port.count] = {};
  port.phase = Phase::Idle;
}

void hand_over(Core& core, std::uint8_t number) {
  NetworkPort& port = core.s.network[number];
  const NetworkPort::Job job = port.jobs.front();
  if (port.status == kJobDone && !job.writes)
    std::copy_n(port.data.begin(), job.length, core.s.image.begin() + job.table + kData);
  strike_off_first(port);
  put_status(core, number, job, port.status);
}

bool is_listed(const NetworkPort& port, std::uint32_t table) {
  const auto end = port.jobs.begin() + port.count;
  return std::find_if(port.jobs.begin(), end, [&](const auto& job) { return job.table == table; }) != end;
}

}  // namespace

bool is_master(const Core& core, std::uint8_t port) { return (core.s.port[port].control & sm::kProtocol) == sm::kPpiMaster; }

std::uint8_t length_of(const Core& core, std::uint32_t table) {
  return core.in_area(table, kData) ? core.s.image[table + kLength] : std::uint8_t{0};
}

void start(Core& core, std::uint8_t number, std::uint32_t table, bool writes) {
  NetworkPort& port = core.s.network[number];
  if (!core.in_area(table, kData)) return core.run_error(RunError::OperandRange);
  if (is_listed(port, table)) return;
  const NetworkPort::Job job = job_of(core, table, writes);
  if (!is_master(core, number)) return put_status(core, number, job, failed(NetworkError::NotMaster));
  if (!is_possible(core, number, job)) return put_status(core, number, job, failed(NetworkError::Parameter));
  if (port.count == NetworkPort::kMostJobs) return put_status(core, number, job, failed(NetworkError::Overflow));
  port.jobs[port.count++] = job;
  put_status(core, number, job, kJobActive);
}

void heard(Core& core, std::uint8_t number, Span frame, Time at) {
  NetworkPort& port = core.s.network[number];
  if (port.phase != Phase::Asked && port.phase != Phase::Polled) return;
  if (const auto body = ppi::body_of(frame)) return take_reply(core, number, *body);
  if (frame.size() != 1 || frame[0] != ppi::kAccepted) return;
  if (port.phase == Phase::Asked) port.accepted = at;
  if (at - port.accepted > s7::kLongestWork) return end(core, number, failed(NetworkError::TimeOut));
  port.frame_count = port.phase == Phase::Polled && !port.frame_count;
  port.tries = 1;
  poll(core, number, at);
}

void heard_damaged(Core& core, std::uint8_t number) {
  NetworkPort& port = core.s.network[number];
  if (port.phase != Phase::Idle) port.damaged = true;
}

void follow_control(Core& core, std::uint8_t number) {
  NetworkPort& port = core.s.network[number];
  if (is_master(core, number) || port.count == 0) return;
  core.cancel(timer_of(number));
  while (port.count != 0) {
    const NetworkPort::Job job = port.jobs.front();
    strike_off_first(port);
    put_status(core, number, job, failed(NetworkError::NotMaster));
  }
}

/// A port that the CPU does not have never has a job.
void communicate(Core& core) {
  for (std::uint8_t number = 0; number < kPorts.size(); ++number) {
    const NetworkPort& port = core.s.network[number];
    if (port.count == 0) continue;
    if (port.phase == Phase::Over) hand_over(core, number);
    const bool line_is_free = core.s.ppi[number].sending == 0 && core.s.port[number].on_wire == OnWire::Nothing;
    if (port.phase == Phase::Idle && port.count != 0 && line_is_free) take_up_next(core, number);
  }
}

void handle(Core& core, std::uint8_t what, Time at) {
  const auto number = static_cast<std::uint8_t>(what - kNetworkTimer0);
  NetworkPort& port = core.s.network[number];
  const Time silent = silent_from(core, number), character = ppi::format_of(core.program(), number).character_time();
  if (core.s.ppi[number].sending != 0 || at < silent) return core.schedule(std::max(silent, at + character), what);
  if (port.tries++ == kTries) return end(core, number, failed(port.damaged ? NetworkError::Damaged : NetworkError::TimeOut));
  return port.phase == Phase::Asked ? ask(core, number, at) : poll(core, number, at);
}

}  // namespace s7200::network
