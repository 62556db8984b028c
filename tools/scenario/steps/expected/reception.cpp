#include "tools/scenario/steps/expected/reception.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

/// What came in the end, or that nothing did.
std::string found_text(const Run& run, const Bytes& request, const Bytes& response, Time timeout) {
  if (!response.empty()) return answer_text(request, response);
  if (!request.empty()) return fmt::format("no answer within {}", format_duration(timeout));
  const std::string nothing = fmt::format("nothing within {}", format_duration(timeout));
  return run.before.remark.empty() ? nothing : fmt::format("{}; the last request {}", nothing, run.before.remark);
}

}  // namespace

void Reception::read_reception(const StepSource& source) {
  ValueReader& values = source.values;
  const Time tolerance = source.scenario.tolerance;
  latency = values.window(source.beside("latency"), tolerance);
  answer_gap = values.window(source.beside("answer_gap"), tolerance);
  disturbed = values.truth(source.beside("disturbed"));
  listen = values.span(source.beside("listen"));
  timeout = values.time(source.beside("timeout"));
}

void Reception::judge(Run& run, const serial::Exchange& exchange, const SerialFormat& line, Time waited) const {
  const Bytes request = serial::bytes_of(exchange.request), response = exchange.response_bytes();
  if (!expected.empty() || latency || (answer_gap && run.in_simulation())) run.count_check();
  const bool found_disturbed = exchange.parity_error() || exchange.framing_error();
  const bool as_expected = std::any_of(expected.begin(), expected.end(),
                                       [&](const Expected& e) { return fulfilled(e, has_crc, request, response); });
  const bool right = as_expected && found_disturbed == disturbed && !exchange.of_another_master;
  if (expected.empty() || right) return judge_times(run, exchange, line);
  Finding finding{.what = request.empty() ? "transmission" : "answer",
                  .expected = in_words(expected.front(), request),
                  .found = found_text(run, request, response, waited),
                  .expected_bytes = bytes_expected(expected.front(), has_crc, request),
                  .found_bytes = pattern_of(response),
                  .exchange = exchange};
  for (std::size_t i = 1; i < expected.size(); ++i) finding.expected += " or " + in_words(expected[i], request);
  if (disturbed) add_remark(finding.expected, "with parity or framing errors");
  if (found_disturbed) add_remark(finding.found, exchange.parity_error() ? "parity errors" : "framing errors");
  if (exchange.of_another_master) add_remark(finding.found, exchange.damage());
  if (exchange.early) add_remark(finding.found, "it began before the request's last stop bit ended");
  run.add_exchange(std::move(finding));
}

void Reception::judge_times(Run& run, const serial::Exchange& exchange, const SerialFormat& line) const {
  const bool exact_times = run.in_simulation();
  const bool asked = !exchange.request.empty();
  const auto took = latency_of(exchange);
  const auto fits = [&](Time time) { return exact_times ? latency->has(time, line) : time <= latency->to.in(line); };
  if (latency && (!took || !fits(*took)))
    run.add_exchange({.what = "latency",
                      .expected = in_words(*latency, line),
                      .found = took    ? format_duration(*took, 6)
                               : asked ? "no answer"
                                       : "nothing came",
                      .exchange = exchange});
  if (!exact_times && (answer_gap || (latency && latency->from.in(line) > 0))) run.leave_times_unjudged();
  if (!answer_gap || !exact_times) return;
  for (std::size_t i = 1; i < exchange.response.size(); ++i) {
    const Time gap = exchange.response[i].start - exchange.response[i - 1].start - line.character_time();
    if (answer_gap->has(gap, line)) continue;
    return run.add_exchange({.what = asked ? "pause inside the answer" : "pause inside the transmission",
                             .expected = in_words(*answer_gap, line),
                             .found = fmt::format("{} after character {}", format_duration(gap, 6), i),
                             .exchange = exchange});
  }
}

void Reception::write_how_to_listen(TranscriptWriter& writer) const {
  if (listen) writer.beside("listen: " + exact(*listen));
  if (timeout) writer.beside("timeout: " + exact(*timeout));
}

void Reception::write_how_it_came(TranscriptWriter& writer, const serial::Exchange& seen) {
  if (seen.parity_error() || seen.framing_error()) writer.beside("disturbed: true");
}

const Reception* reception_of(const Step& step) { return dynamic_cast<const Reception*>(step.action.get()); }

std::string in_a_map(const std::string& quoted) { return "{text: " + quoted + "}"; }

std::string what_came(const Bytes& request, const Bytes& response) {
  if (response.empty()) return "silence";
  return plain_text(request, response) ? in_a_map(quoted_text(response)) : serial::to_hex(response);
}

}  // namespace s7200::tools
