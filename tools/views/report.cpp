#include "tools/views/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "tools/views/broadcast.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

std::string place_text(const Program& program, std::uint32_t op) {
  if (op == kNoRoutine) return "between two scans";
  const stl::Statement& statement = program.statement(op);
  const stl::FileLine place = stl::in_file(program.source, statement.position.line);
  return fmt::format("{}:{}: {}", stl::printable(place.file), place.line, stl::to_text(statement));
}

nlohmann::ordered_json error_json(const Program& program, std::uint16_t code, std::string_view meaning, std::uint32_t op,
                                  bool fatal) {
  nlohmann::ordered_json json{{"code", fmt::format("{:04X}", code)}, {"fatal", fatal}, {"meaning", meaning}};
  json["line"] = nullptr;
  json["statement"] = "";
  if (op == kNoRoutine) return json;
  const stl::FileLine place = stl::in_file(program.source, program.statement(op).position.line);
  json["line"] = place.line;
  if (!program.source.further_files.empty()) json["file"] = place.file;
  json["statement"] = stl::to_text(program.statement(op));
  return json;
}

/// The contents of the answer, and what the master noticed on the line besides bytes.
std::string remarks_on(const serial::Exchange& exchange) {
  std::string text =
      exchange.of_another_master ? "" : answer_text(serial::bytes_of(exchange.request), exchange.response_bytes());
  const auto add = [&text](bool is_so, std::string_view remark) {
    if (is_so) text.append(text.empty() ? "" : ", ").append(remark);
  };
  add(exchange.parity_error(), "parity errors");
  add(exchange.framing_error(), "framing errors");
  add(exchange.too_long, "cut off");
  add(exchange.of_another_master, "the request of another master, and no answer");
  return text;
}

constexpr std::string_view kEarly =
    "another station began to send before the request's last stop bit ended: the master does not hear that";

std::string below(const std::string& text) { return text.empty() ? "" : fmt::format("         {}\n", text); }

}  // namespace

std::string errors_text(const Cpu& cpu) {
  std::string text;
  const State& state = cpu.state();
  for (const RuntimeError& error : state.errors) {
    if (error.count == 0) break;
    text += fmt::format("run-time error {:04X}, {}\n  {} ({}×, first at {})\n", error.code, meaning_of(RunError{error.code}),
                        place_text(cpu.program(), error.op), error.count, format_duration(error.first));
  }
  if (const std::uint64_t others = errors_not_listed(cpu))
    text += fmt::format("and {} at other places: the first {} places are kept, a trace shows all\n",
                        counted(others, "more run-time error"), state.errors.size());
  if (state.fatal_code)
    text += fmt::format("FATAL error {:04X}, {}\n  {}\n", state.fatal_code, meaning_of(FatalError{state.fatal_code}),
                        place_text(cpu.program(), state.fatal_op));
  return text;
}

std::string stop_text(const Cpu& cpu) {
  const State& state = cpu.state();
  if (state.mode != Mode::Stop) return "";
  if (!state.fatal_code) return "CPU in STOP";
  const std::string_view meaning = meaning_of(FatalError{state.fatal_code});
  return fmt::format("CPU in STOP, {} (fatal error {:04X})", meaning.substr(0, meaning.find(':')), state.fatal_code);
}

std::uint64_t errors_not_listed(const Cpu& cpu) {
  std::uint64_t others = cpu.state().error_count;
  for (const RuntimeError& error : cpu.state().errors) others -= error.count;
  return others;
}

nlohmann::ordered_json errors_json(const Cpu& cpu) {
  nlohmann::ordered_json errors = nlohmann::ordered_json::array();
  for (const RuntimeError& error : cpu.state().errors) {
    if (error.count == 0) break;
    auto json = error_json(cpu.program(), error.code, meaning_of(RunError{error.code}), error.op, false);
    json["count"] = error.count;
    json["first_ns"] = error.first;
    errors.push_back(json);
  }
  if (cpu.state().fatal_code)
    errors.push_back(error_json(cpu.program(), cpu.state().fatal_code, meaning_of(FatalError{cpu.state().fatal_code}),
                                cpu.state().fatal_op, true));
  return errors;
}

std::string torn_frame_note(const std::vector<std::string>& frames) {
  const auto is_byte = [](const std::string& text) { return text.size() <= 2; };
  if (frames.size() < 2 || std::none_of(frames.begin(), frames.end(), is_byte)) return {};
  return fmt::format("these were {} frames, one for each argument; to send one frame, put it in quotes: '{}'", frames.size(),
                     stl::shortened(fmt::format("{}", fmt::join(frames, " "))));
}

std::string missing_crc_note(const std::vector<serial::Frame>& frames) {
  for (const serial::Frame& frame : frames)
    if (modbus::lacks_crc(serial::bytes_of(frame)))
      return fmt::format("{} would be a Modbus request, but it lacks its CRC; --crc appends it",
                         serial::to_hex(serial::bytes_of(frame)));
  return {};
}

std::string modbus_tcp_note(const std::vector<serial::Frame>& frames) {
  constexpr std::size_t kHead = 6;  // transaction, protocol, length: the unit after them is the station on a line
  for (const serial::Frame& frame : frames) {
    const Bytes bytes = serial::bytes_of(frame);
    if (modbus::is_tcp_request(bytes))
      return fmt::format("{} is a message of Modbus TCP: a line has no head before the station, but a CRC; send --crc '{}'",
                         serial::to_hex(bytes), serial::to_hex(std::span(bytes).subspan(kHead)));
  }
  return {};
}

std::string exchange_text(const serial::Exchange& exchange, Time timeout) {
  const Bytes bytes = serial::bytes_of(exchange.request);
  std::string request = fmt::format("request  {}\n{}", serial::to_hex(exchange.request), below(request_text(bytes)));
  if (!exchange.echo.empty()) request += fmt::format("echo     {}\n", serial::to_hex(serial::bytes_of(exchange.echo)));
  const std::string early = below(exchange.early ? std::string(kEarly) : "");
  if (exchange.timed_out && is_broadcast(bytes)) return request + "answer   none expected: it is a broadcast\n" + early;
  if (exchange.timed_out) return fmt::format("{}answer   none within {}\n{}", request, format_duration(timeout), early);
  return fmt::format("{}answer   {}   after {}\n{}{}", request, serial::to_hex(exchange.response_bytes()),
                     format_duration(*exchange.latency()), below(remarks_on(exchange)), early);
}

void mark_request_of_another(serial::Exchange& exchange) {
  if (modbus::crc_ok(serial::bytes_of(exchange.request)) && modbus::is_request(exchange.response_bytes()))
    exchange.of_another_master = true;
}

bool is_damaged(const serial::Exchange& exchange) {
  if (exchange.timed_out || exchange.of_another_master) return false;
  return exchange.early || !exchange.damage().empty() ||
         (modbus::crc_ok(serial::bytes_of(exchange.request)) && !modbus::crc_ok(exchange.response_bytes()));
}

nlohmann::ordered_json exchange_json(const serial::Exchange& exchange, const Bytes& unasked) {
  nlohmann::ordered_json json{
      {"request", plain_hex(serial::bytes_of(exchange.request))}, {"response", nullptr}, {"latency_us", nullptr}};
  if (!unasked.empty()) json["unasked"] = plain_hex(unasked);
  if (const auto text = plain_text({}, unasked)) json["unasked_text"] = *text;
  if (!exchange.echo.empty()) json["echo"] = plain_hex(serial::bytes_of(exchange.echo));
  if (exchange.early) json["early"] = true;
  const Bytes request = serial::bytes_of(exchange.request);
  if (const auto text = plain_text(request, request)) json["request_text"] = *text;
  if (exchange.timed_out) return json;
  const auto answer = exchange.of_another_master ? std::nullopt : plain_text(request, exchange.response_bytes());
  if (answer) json["response_text"] = *answer;
  json["response"] = plain_hex(exchange.response_bytes());
  json["latency_us"] = static_cast<double>(*exchange.latency()) / kMicrosecond;
  if (exchange.parity_error()) json["parity_error"] = true;
  if (exchange.framing_error()) json["framing_error"] = true;
  if (is_damaged(exchange)) json["damaged"] = true;
  if (exchange.of_another_master) json["of_another_master"] = true;
  return json;
}

std::string unasked_text(const Bytes& bytes) {
  return bytes.empty() ? "" : fmt::format("unasked  {}\n{}", serial::to_hex(bytes), below(quoted_text(bytes)));
}

std::string plain_hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace s7200::tools
