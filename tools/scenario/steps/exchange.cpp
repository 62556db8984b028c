#include "tools/scenario/steps/exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "interpreter/base/text/text.hpp"
#include "tools/scenario/reading/answer_reader.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {

void ExchangeStep::read_beside(const StepSource& source) {
  ValueReader& values = source.values;
  expected = read_expectations(values, source.node);
  read_reception(source);
  at = values.time(source.beside("at"));
  pause = values.span(source.beside("pause"));
  gap = values.span(source.beside("gap")).value_or(Span{});
  if (at && pause) values.wrong(*source.beside("at"), "both 'at' and 'pause'", "one of them says when the request begins");
}

/// Returns false after a finding if it is too late for that.
bool ExchangeStep::wait_for_begin(Run& run) const {
  Time begin = run.slave().now();
  if (at)
    begin = run.begin() + *at;
  else if (run.before.end)
    begin = *run.before.end + pause.value_or(run.scenario().pause).in(run.format());
  const Time now = run.slave().now();
  if (at && begin + run.allowed_delay() < now && run.in_simulation()) {
    run.add({.what = "begin",
             .expected = fmt::format("a request at {}", format_duration(begin, 6)),
             .found = fmt::format("it is {} already", format_duration(now, 6)),
             .of_run = true});
    return false;
  }
  if (begin > now) run.slave().wait(begin - now);
  return true;
}

void ExchangeStep::act(Run& run) const {
  if (!wait_for_begin(run)) return;
  const SerialFormat line = run.format();
  serial::Request asked{.frame = request, .timeout = timeout.value_or(run.scenario().line.timeout), .gap = gap.in(line)};
  asked.sync = run.in_simulation();  // where the line has the signal and the master drives it: `sync: master`
  if (listen) asked.silence = listen->in(line);
  if (run.plant()) run.plant()->begin_exchange();
  serial::Exchange exchange;
  try {
    exchange = run.slave().exchange(asked);
  } catch (const std::invalid_argument& error) {
    if (!run.in_simulation()) return run.skip_step();  // a way that such a frame cannot go
    return run.add({.what = "request", .expected = "a request that can be sent", .found = error.what(), .of_run = true});
  } catch (const SlaveLost& error) {
    return run.lose_slave(error.what());
  }
  if (run.plant()) run.plant()->end_exchange();
  if (!run.in_simulation() && asked.gap != 0) run.leave_times_unjudged();
  run.before = {.end = exchange.response.empty() ? run.slave().now() : exchange.response_end,
                .remark = run.slave().remark()};
  run.keep(exchange);
  run.allow_delay();
  judge(run, exchange, line, asked.timeout);
}

bool ExchangeStep::write(TranscriptWriter& writer) const {
  if (!writer.seen()) return false;
  const serial::Exchange& seen = *writer.seen();
  const Bytes sent = serial::bytes_of(seen.request), response = seen.response_bytes();
  const std::string quoted = serial::has_wrong_parity(seen.request) ? "" : request_text(sent);
  writer.step("send: " + (quoted.empty() ? serial::to_hex(seen.request) : in_a_map(quoted)));
  if (!writer.live())
    writer.beside("at: " + exact(seen.request_start));
  else if (writer.last_end)
    writer.beside("pause: " + exact(std::max<Time>(0, seen.request_start - *writer.last_end)));
  const Time waited = timeout.value_or(writer.scenario().line.timeout);
  writer.last_end = seen.response.empty() ? seen.request_end + waited : seen.response_end;
  if (gap != Span{}) writer.beside("gap: " + exact(gap));
  write_how_to_listen(writer);
  writer.beside("expect: " + what_came(sent, response));
  if (response.empty()) return true;
  write_how_it_came(writer, seen);
  const Time took = *seen.latency();
  if (took >= 0) writer.beside("latency: " + exact(took));  // below 0 on a line with echo only, and no window says so
  const std::string says = plain_text(sent, response) ? "" : answer_text(sent, response);
  if (!says.empty()) writer.beside("# " + says);
  return true;
}

serial::Frame hex_frame(ValueReader& values, const YamlNode& node) {
  const auto written = values.text(node);
  if (!written) return {};
  serial::ParsedFrame parsed = serial::parse_hex_frame(*written);
  if (parsed.ok()) return std::move(parsed.frame);
  const bool crc = stl::lower_case(*written).find("crc") != std::string::npos;
  values.wrong(node, parsed.errors[0].message,
               crc ? "crc: true beside it appends the CRC" : "write a frame in hex, such as 01 03 00 0a");
  return {};
}

void wrong_expectation(const StepSource& source, std::string message, std::string hint) {
  const YamlNode* one = source.beside("expect");
  source.values.wrong(one ? *one : *source.beside("expect_one_of"), std::move(message), std::move(hint));
}

}  // namespace s7200::tools
