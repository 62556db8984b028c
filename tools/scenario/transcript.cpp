#include "tools/scenario/transcript.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "interpreter/program/load.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

/// To the nanosecond.
std::string exact(Time time) { return format_duration(time, 9); }

std::string exact(const Span& span) {
  if (span.millicharacters == 0) return exact(span.fixed);
  const std::string characters = fmt::format("{} characters", static_cast<double>(span.millicharacters) / 1000);
  return span.fixed == 0 ? characters : fmt::format("{} + {}", characters, exact(span.fixed));
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + '"';
}

std::string assignments_text(const std::vector<Assignment>& assignments) {
  std::string text;
  for (const Assignment& assignment : assignments) {
    const std::uint32_t digits = assignment.place.width == Width::Bit ? 1 : 2 * bytes_of(assignment.place.width);
    const std::uint32_t value = digits == 8 ? assignment.value : assignment.value & ((1U << 4 * digits) - 1);
    text += fmt::format("{}{}: 16#{:0{}X}", text.empty() ? "" : ", ", assignment.place.name_of(0), value, digits);
  }
  return "{" + text + "}";
}

std::string memory_text(const std::vector<MemoryExpected>& all) {
  std::string text;
  for (const MemoryExpected& expected : all)
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", in_quotes(expected.address), in_quotes(expected.written));
  return text;
}

class Writer {
 public:
  explicit Writer(const Transcript& transcript)
      : transcript_(transcript), folder_(std::filesystem::path(transcript.path).parent_path()) {}

  void write(const Report& report) {
    const Scenario& scenario = *report.scenario;
    line(2, "- name: " + in_quotes(scenario.name));
    head(scenario);
    line(4, "steps:");
    std::size_t seen = 0;
    bool any = false;
    last_end_.reset();
    for (std::size_t i = 0; i < scenario.steps.size(); ++i) {
      const Step& step = scenario.steps[i];
      if (reception_of(step) != nullptr) {
        if (seen == report.result.seen.size() || report.result.seen[seen].step != i) continue;
        came(step, report.result.seen[seen++].exchange, scenario.line.timeout);
      } else if (const auto* wait = std::get_if<WaitUntilStep>(&step.action)) {
        waited(*wait, i, report);
      } else if ((transcript_.live && (looks_inside(step) || acts_inside(step))) || !driving(step)) {
        continue;
      }
      any = true;
    }
    if (!any) line(6, "- wait: " + exact(Time{0}));
  }

  std::string text{};

 private:
  void line(int indent, const std::string& content) { text += fmt::format("{:{}}{}\n", "", indent, content); }

  std::string near(const std::string& path) const {
    if (is_standard_input(path)) return in_quotes(path);
    const auto top = [](const std::filesystem::path& p) { return std::filesystem::absolute(p).lexically_normal(); };
    return in_quotes(top(path).lexically_relative(top(folder_ / "x").parent_path()).string());
  }

  void head(const Scenario& scenario) {
    if (!scenario.program.empty()) line(4, "program: " + near(scenario.program));
    if (!scenario.program.empty() && scenario.may_be_missing) line(4, "skip_without: " + near(scenario.program));
    if (scenario.cpu != "214") line(4, "cpu: " + scenario.cpu);
    if (!scenario.times_file.empty()) line(4, "times: " + near(scenario.times_file));
    line_settings(scenario.line);
    if (transcript_.tolerance > 0) line(4, "tolerance: " + exact(transcript_.tolerance));
    if (transcript_.live) return;
    if (!scenario.set.empty()) line(4, "set: " + assignments_text(scenario.set));
    if (!scenario.input_file.empty()) line(4, "input: " + near(scenario.input_file));
    if (scenario.clock) {
      const ClockTime& c = *scenario.clock;
      line(4,
           fmt::format("clock: 20{:02}-{:02}-{:02} {:02}:{:02}:{:02}", c.year, c.month, c.day, c.hour, c.minute, c.second));
    }
    if (scenario.after != kNever) line(4, "after: " + exact(scenario.after));
  }

  void line_settings(const serial::MasterSettings& options) {
    std::string settings;
    const auto add = [&](std::string_view name, const auto& value) {
      if (value) settings += fmt::format("{}{}: {}", settings.empty() ? "" : ", ", name, *value);
    };
    add("baud", options.baud);
    add("parity", options.parity ? std::optional(word_of(*options.parity)) : std::nullopt);
    add("data_bits", options.data_bits);
    add("stop_bits", options.stop_bits);
    if (!settings.empty()) line(4, "line: {" + settings + "}");
    if (options.timeout != serial::MasterSettings{}.timeout) line(4, "timeout: " + exact(options.timeout));
  }

  void came(const Step& step, const serial::Exchange& seen, Time timeout) {
    if (const auto* exchange = std::get_if<ExchangeStep>(&step.action))
      asked(*exchange, seen, timeout);
    else
      received(std::get<ReceiveStep>(step.action), seen);
  }

  void asked(const ExchangeStep& step, const serial::Exchange& seen, Time timeout) {
    const Bytes request = serial::bytes_of(seen.request), response = seen.response_bytes();
    const std::string quoted = serial::has_wrong_parity(seen.request) ? "" : request_text(request);
    line(6, "- send: " + (quoted.empty() ? serial::to_hex(seen.request) : in_a_map(quoted)));
    if (!transcript_.live)
      line(8, "at: " + exact(seen.request_start));
    else if (last_end_)
      line(8, "pause: " + exact(std::max<Time>(0, seen.request_start - *last_end_)));
    last_end_ = seen.response.empty() ? seen.request_end + step.timeout.value_or(timeout) : seen.response_end;
    if (step.gap != Span{}) line(8, "gap: " + exact(step.gap));
    how_to_listen(step);
    line(8, "expect: " + what_came(request, response));
    if (response.empty()) return;
    how_it_came(seen);
    const Time latency = *seen.latency();
    if (latency >= 0) line(8, "latency: " + exact(latency));  // below 0 on a line with echo only, and no window says so
    const std::string says = plain_text(request, response) ? "" : answer_text(request, response);
    if (!says.empty()) line(8, "# " + says);
  }

  void received(const ReceiveStep& step, const serial::Exchange& seen) {
    line(6, "- receive: " + what_came({}, seen.response_bytes()));
    how_to_listen(step);
    if (seen.response.empty()) return;
    last_end_ = seen.response_end;
    how_it_came(seen);
    if (transcript_.live)
      line(8, "latency: " + exact(*latency_of(seen)));
    else
      line(8, "at: " + exact(seen.response_start));
  }

  void how_to_listen(const Reception& step) {
    if (step.listen) line(8, "listen: " + exact(*step.listen));
    if (step.timeout) line(8, "timeout: " + exact(*step.timeout));
  }
  void how_it_came(const serial::Exchange& seen) {
    if (seen.parity_error() || seen.framing_error()) line(8, "disturbed: true");
  }

  static std::string in_a_map(const std::string& quoted) { return "{text: " + quoted + "}"; }
  static std::string what_came(const Bytes& request, const Bytes& response) {
    if (response.empty()) return "silence";
    return plain_text(request, response) ? in_a_map(quoted_text(response)) : serial::to_hex(response);
  }

  /// A program that did not get there in time does not get there in a replay either: what is left is the time.
  void waited(const WaitUntilStep& step, std::size_t index, const Report& report) {
    const std::vector<Finding>& findings = report.result.findings;
    const bool in_vain =
        std::any_of(findings.begin(), findings.end(), [&](const Finding& f) { return f.step == index && f.of_run; });
    const Time timeout = step.timeout.value_or(report.scenario->line.timeout);
    if (in_vain) return line(6, "- wait: " + exact(timeout));
    line(6, "- wait_until: {" + memory_text(step.expected) + "}");
    if (step.timeout) line(8, "timeout: " + exact(*step.timeout));
  }

  /// What changes what comes after it. False for expectations, which are left out.
  bool driving(const Step& step) {
    if (const auto* wait = std::get_if<WaitStep>(&step.action)) {
      line(6, "- wait: " + (wait->scans ? fmt::format("{} scans", wait->scans) : exact(wait->time)));
    } else if (const auto* set = std::get_if<SetStep>(&step.action)) {
      line(6, "- set: " + assignments_text(set->assignments));
    } else if (const auto* power = std::get_if<PowerCycleStep>(&step.action)) {
      line(6, fmt::format("- power_cycle: memory {}", power->memory_lost ? "lost" : "kept"));
      if (power->power_off != 0) line(8, "power_off: " + exact(power->power_off));
    } else if (const auto* fault = std::get_if<FaultStep>(&step.action)) {
      line(6, "- fault: " + (fault->fault ? serial::to_text(*fault->fault) : "none"));
    } else {
      return false;
    }
    return true;
  }

  const Transcript& transcript_;
  std::filesystem::path folder_;
  std::optional<Time> last_end_;  ///< of the exchange before, on the slave's clock
};

}  // namespace

std::string transcript_text(const std::vector<Report>& reports, const Transcript& transcript) {
  Writer writer(transcript);
  for (const Report& report : reports)
    if (report.result.outcome != ScenarioResult::Outcome::Skipped) writer.write(report);
  return fmt::format("{} {} by s7200 test --record. Replayed by s7200 test.\nscenarios:\n{}", kTranscriptBeginning,
                     transcript.recorded_from, writer.text);
}

}  // namespace s7200::tools
