#include "tools/scenario/transcripts/transcript.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/file_source.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"
#include "tools/views/escapes.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {

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
    result +=
        static_cast<unsigned char>(c) < 0x20 ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return with_escapes(result) + '"';
}

std::string assignments_text(const std::vector<Assignment>& assignments) {
  std::string text;
  std::set<std::string> written;
  for (auto assignment = assignments.rbegin(); assignment != assignments.rend(); ++assignment) {
    const std::string name = assignment->place.name_of(0);
    if (!written.insert(name).second) continue;
    text = fmt::format("{}: {}{}{}", name, hex_text(*assignment), text.empty() ? "" : ", ", text);
  }
  return "{" + text + "}";
}

std::string to_text(const std::vector<MemoryExpected>& expected) {
  std::string text;
  for (const MemoryExpected& e : expected)
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", in_quotes(e.address), in_quotes(e.written));
  return "{" + text + "}";
}

std::string unforce_text(const std::vector<MemoryRange>& places) {
  if (places.empty()) return "all";
  std::string text;
  for (const MemoryRange& place : places)
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", place.name_of(0),
                        place.count > 1 ? fmt::format(":{}", place.count) : "");
  return "[" + text + "]";
}

TranscriptWriter::TranscriptWriter(const Transcript& transcript)
    : transcript_(transcript), folder_(file_path(transcript.path).parent_path()) {}

void TranscriptWriter::begin(const Report& report) {
  report_ = &report;
  line(2, "- name: " + in_quotes(scenario().name));
  head(scenario());
  line(4, "steps:");
  last_end.reset();
}

void TranscriptWriter::write(const Report& report) {
  begin(report);
  const std::vector<Seen>& all = report.result.seen;
  auto seen = all.begin();
  bool any = false;
  for (step_ = 0; step_ < scenario().steps.size(); ++step_) {
    const auto came = [&] { return seen != all.end() && seen->step == step_; };
    do any |= write_step(came() ? &(seen++)->exchange : nullptr);
    while (came());
  }
  if (!any) step("wait: " + exact(Time{0}));
}

void TranscriptWriter::write(const Seen& seen) {
  step_ = seen.step;
  write_step(&seen.exchange);
}

/// Returns false if a replay has nothing to do for it.
bool TranscriptWriter::write_step(const serial::Exchange* seen) {
  seen_ = seen;
  const StepAction& action = *scenario().steps[step_].action;
  const bool reached_it = !live() || action.needs() == Needs::Line;
  if (!reached_it || !action.write(*this)) return false;
  if (const std::string& on = scenario().steps[step_].on; !on.empty()) beside("on: " + on);
  return true;
}

std::optional<Time> TranscriptWriter::waited_in_vain() const {
  for (const Finding& finding : report_->result.findings)
    if (finding.step == step_ && finding.waited) return finding.waited;
  return {};
}

void TranscriptWriter::line(int indent, const std::string& content) {
  text_ += fmt::format("{:{}}{}\n", "", indent, content);
}

std::string TranscriptWriter::near(const std::string& path) const {
  if (is_standard_input(path)) return in_quotes(path);
  const auto top = [](const std::filesystem::path& p) { return std::filesystem::absolute(p).lexically_normal(); };
  return in_quotes(top(file_path(path)).lexically_relative(top(folder_ / "x").parent_path()).generic_string());
}

void TranscriptWriter::head(const Scenario& scenario) {
  if (!scenario.program.empty()) line(4, "program: " + near(scenario.program));
  if (!scenario.system.empty()) line(4, "system: " + near(scenario.system));
  if (!scenario.on.empty()) line(4, "on: " + scenario.on);
  if (!scenario.with.empty()) {
    std::string files;
    for (const std::string& file : scenario.with) files += (files.empty() ? "" : ", ") + near(file);
    line(4, "with: [" + files + "]");
  }
  if (!scenario.repair.empty()) line(4, "repair: " + scenario.repair);
  if (!scenario.program.empty() && scenario.may_be_missing) line(4, "skip_without: " + near(scenario.program));
  if (scenario.cpu != "214") line(4, "cpu: " + scenario.cpu);
  if (!scenario.times.empty()) line(4, "times: " + (find_times(scenario.times) ? scenario.times : near(scenario.times)));
  if (scenario.robust)
    line(4, fmt::format("# without its 'robust: {:g}%': the times below are those of one table", *scenario.robust));
  plc_keys_of(scenario, PlcKey::Stage::Cpu);
  if (scenario.port != 0) line(4, fmt::format("port: {}", scenario.port));
  line_settings(scenario.line);
  if (transcript_.tolerance > 0) line(4, "tolerance: " + exact(transcript_.tolerance));
  if (transcript_.live) return;
  if (!scenario.plc.set.empty()) line(4, "set: " + assignments_text(scenario.plc.set));
  plc_keys_of(scenario, PlcKey::Stage::Program);
  if (scenario.after != kNever) line(4, "after: " + exact(scenario.after));
}

void TranscriptWriter::plc_keys_of(const Scenario& scenario, PlcKey::Stage stage) {
  for (const PlcKey& key : plc_keys()) {
    if (!key.of_scenario || key.stage != stage || !key.text) continue;
    const std::string text = key.text(scenario.plc);
    if (!text.empty()) line(4, fmt::format("{}: {}", key.name, key.shape == PlcKey::Shape::Read ? near(text) : text));
  }
}

void TranscriptWriter::line_settings(const serial::MasterSettings& settings) {
  std::string text;
  const auto add = [&](std::string_view name, const auto& value) {
    if (value) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", name, *value);
  };
  add("baud", settings.baud);
  add("parity", settings.parity ? std::optional(word_of(*settings.parity)) : std::nullopt);
  add("data_bits", settings.data_bits);
  add("stop_bits", settings.stop_bits);
  if (!text.empty()) line(4, "line: {" + text + "}");
  if (settings.timeout != serial::MasterSettings{}.timeout) line(4, "timeout: " + exact(settings.timeout));
}

std::string transcript_heading(const Transcript& transcript) {
  return fmt::format("{} {} by {}. Replayed by s7200 test.\nscenarios:\n", kTranscriptBeginning,
                     stl::printable(transcript.recorded_from), transcript.by);
}

std::string transcript_text(const std::vector<Report>& reports, const Transcript& transcript) {
  TranscriptWriter writer(transcript);
  for (const Report& report : reports)
    if (report.result.outcome != ScenarioResult::Outcome::Skipped) writer.write(report);
  return transcript_heading(transcript) + writer.take();
}

std::string why_not_replayed(std::size_t bytes) {
  if (bytes <= kLongestTranscript) return {};
  return fmt::format("the transcript has {} bytes; {} at most can be replayed: record fewer scenarios in one file", bytes,
                     kLongestTranscript);
}

std::string why_not_recorded(const std::vector<Report>& reports, std::size_t bytes) {
  if (count(reports, ScenarioResult::Outcome::Skipped) == reports.size()) return "no scenario went to its end";
  return why_not_replayed(bytes);
}

}  // namespace s7200::tools
