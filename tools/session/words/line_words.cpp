#include "tools/session/words/line_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/broadcast.hpp"
#include "tools/views/state/faults.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

/// That a master leaves the stations after a broadcast (MODBUS over Serial Line V1.02, 2.4.1: 100 to 200 ms).
constexpr Time kTurnaround = 200 * kMillisecond;

}  // namespace

Result<SendFrame> send_of(const serial::Frame& frame, serial::Simulation& simulation, const serial::MasterSettings& master) {
  if (!simulation.has_master()) return Trouble{std::string(kNoRoomForMaster)};
  const SerialFormat format = master.over(simulation.port_format());
  if (serial::has_wrong_parity(frame) && format.parity == Parity::None)
    return Trouble{"a byte with wrong parity (p) needs a format with parity"};
  if (simulation.master().busy())
    return Trouble{
        "the last frame is still under way or waiting for its answer; 'continue' runs to its end, 'send cancel' gives it "
        "up"};
  SendFrame send{format, master.request(frame)};
  if (is_broadcast(serial::bytes_of(frame))) send.request.timeout = std::min(send.request.timeout, kTurnaround);
  return send;
}

std::string sent_text(const SendFrame& send, const serial::Simulation& simulation) {
  const std::string request = request_text(serial::bytes_of(send.request.frame));
  std::string text = fmt::format("on the line from now on: {}{} ({})\n", serial::to_hex(send.request.frame),
                                 request.empty() ? "" : "  " + request, format_text(send.format));
  if (simulation.plc().powered() && !simulation.freeport().active)
    text += fmt::format("port {} is not in Freeport mode: the program will not hear it\n", simulation.port());
  return text;
}

Result<CancelRequest> cancel_of(serial::Simulation& simulation) {
  if (!simulation.has_master() || !simulation.master().asks())
    return Trouble{"no request of the simulated master is under way on this line"};
  const serial::Requester::State& master = simulation.master().state();
  const Time end = master.exchange.request_end;
  const bool coming_in = end != 0 && simulation.master_uart().state().start_edge < simulation.time();
  return CancelRequest{.sent = master.sent,
                       .waited = end == 0 ? 0 : simulation.time() - end,
                       .sent_until = end == 0 && master.sent > 0 ? simulation.master_uart().state().send_end : 0,
                       .answering = coming_in || master.phase == serial::Requester::Phase::Receiving};
}

std::string cancelled_text(const CancelRequest& cancel, const serial::Simulation& simulation) {
  const serial::Exchange& exchange = simulation.master().exchange();
  const std::string frame = serial::to_hex(exchange.request);
  if (cancel.answering)
    return fmt::format("given up within its answer, after {} of it: {}\n", counted(exchange.response.size(), "character"),
                       frame);
  if (exchange.request_end != 0)
    return fmt::format("given up while it waited for the answer, {} after its end: {}\n", format_duration(cancel.waited),
                       frame);
  if (cancel.sent == 0) return fmt::format("given up before its first character: {}\n", frame);
  return fmt::format("given up on the line: character {} of {} is its last, and ends at {}: {}\n", cancel.sent,
                     exchange.request.size(), moment_text(cancel.sent_until), frame);
}

Result<InjectFault> inject_of(const std::string& text) {
  if (stl::lower_case(text) == "none") return InjectFault{};
  const serial::ParsedFault parsed = serial::parse_fault(text);
  if (parsed.ok()) return InjectFault{parsed.fault};
  return trouble("fault, column {}: {}", parsed.error->column, parsed.error->message);
}

std::string injected_text(const InjectFault& inject) {
  if (!inject.fault) return "the line has no fault any more\n";
  return fmt::format("on the line from now on: {}\n  {}\n", serial::to_text(*inject.fault), described(*inject.fault));
}

}  // namespace s7200::tools
