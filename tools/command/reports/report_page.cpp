#include "tools/command/reports/report_page.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "tools/faces/page/engine/engine.hpp"
#include "tools/json/base64.hpp"
#include "tools/json/json_text.hpp"
#include "tools/session/commands/answers/recording_json.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kPlace = "<script id=\"report\" type=\"text/plain\"></script>";
constexpr Time kWithPicture = 60 * kSecond;  ///< longer runs have one
constexpr int kElements = 400;               ///< of a track of the picture
constexpr std::size_t kCheckpoints = 144;    ///< of a long run at most: one each ten minutes of a day
constexpr Time kBetweenCheckpoints = 10 * kSecond;

Bytes compressed(const std::string& text) {
  uLongf size = compressBound(static_cast<uLong>(text.size()));
  Bytes bytes(size);
  if (compress2(bytes.data(), &size, reinterpret_cast<const Bytef*>(text.data()), static_cast<uLong>(text.size()),
                Z_BEST_COMPRESSION) != Z_OK)
    throw std::runtime_error("a report needs more memory than there is");
  bytes.resize(size);
  return bytes;
}

/// The files of a program as they were read; its stand-ins come by themselves.
Json sources_json(const stl::Source& source) {
  Json sources = Json::array();
  std::vector<stl::FurtherFile> files{{1, source.name}};
  files.insert(files.end(), source.further_files.begin(), source.further_files.end());
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (is_stand_in(files[i].name)) continue;
    const std::size_t end = i + 1 < files.size() ? files[i + 1].first_line - 1 : source.text.size();
    std::string text;
    for (std::size_t line = files[i].first_line - 1; line < end; ++line) text += source.text[line] + "\n";
    sources.push_back({{"name", files[i].name}, {"text", std::move(text)}});
  }
  return sources;
}

/// What the page has of a long run before it has computed it: what the timeline of all of it shows, as the engine says it,
/// and checkpoints. Without them if the engine does not open it. `opened`: how it is opened, but for the recording.
void add_shortcuts(Json& recorded, Time end, Json opened) {
  Json last;
  page::Engine engine([&last](const std::string& message) {
    if (auto json = parse_json(message); json && json->contains("id")) last = std::move(*json);
  });
  opened["recording"] = recorded;
  engine.take(line_of({{"id", 1}, {"open", opened}}));
  if (!engine.history()) return;
  engine.take(line_of({{"id", 2}, {"command", fmt::format("spans start end {}", kElements)}}));
  recorded["picture"] = last.value("json", Json());
  recorded["checkpoints"] = checkpoints_json(
      engine.history()->packed_checkpoints(std::min(kCheckpoints, static_cast<std::size_t>(end / kBetweenCheckpoints))));
}

Json finding_json(const ReportedFinding& finding) {
  Json json{{"text", finding.text}};
  if (!finding.why.empty()) json["why"] = finding.why;
  if (finding.line != 0) json["line"] = finding.line;
  if (finding.power_up) json["recording"] = *finding.power_up;
  if (finding.power_up) json["at_ns"] = finding.at;
  return json;
}

/// The runs, with each program once.
class RunsJson {
 public:
  void add(const ReportedRun& run) {
    Json json{{"file", run.file}, {"name", run.name}, {"outcome", run.outcome}, {"findings", Json::array()}};
    if (!run.reason.empty()) json["reason"] = run.reason;
    for (const ReportedFinding& finding : run.findings) json["findings"].push_back(finding_json(finding));
    if (run.program && !run.recordings.empty()) add_program(json, run);
    if (run.system && !run.recordings.empty()) add_system(json, run);
    runs_.push_back(std::move(json));
  }

  Json taken(std::string_view verb) && {
    Json report{{"version", version()}, {"verb", verb}, {"programs", std::move(programs_)}, {"runs", std::move(runs_)}};
    if (!systems_.empty()) report["systems"] = std::move(systems_);
    return report;
  }

 private:
  void add_program(Json& json, const ReportedRun& run) {
    const auto [known, is_new] = numbers_.emplace(run.program->source.text, programs_.size());
    if (is_new) programs_.push_back(sources_json(run.program->source));
    json["program"] = known->second;
    json["options"] = page::options_of(*run.program, run.around, run.repairs);
    add_recordings(json, run, std::array{run.program->model},
                   {{"sources", programs_[known->second]}, {"options", json["options"]}});
  }

  void add_system(Json& json, const ReportedRun& run) {
    json["system"] = systems_.size();
    systems_.push_back(page::system_json(*run.system));
    add_recordings(json, run, run.system->models, {{"system", systems_.back()}});
  }

  static void add_recordings(Json& json, const ReportedRun& run, Models models, const Json& opened) {
    for (const Recording& recording : run.recordings) {
      Json one = json_of(recording, models);
      if (recording.end.time > kWithPicture) add_shortcuts(one, recording.end.time, opened);
      json["recordings"].push_back(std::move(one));
    }
  }

  Json programs_ = Json::array(), systems_ = Json::array(), runs_ = Json::array();
  std::map<std::vector<std::string>, std::size_t> numbers_{};  ///< of the programs, by their text
};

std::string with_report(std::string_view page, const Json& report) {
  const std::size_t place = page.find(kPlace), content = kPlace.find("</");
  if (place == std::string_view::npos) throw std::runtime_error("the page has no place for a report");
  std::string text(page.substr(0, place + content));
  text += to_base64(compressed(line_of(report)));
  return text.append(page.substr(place + content));
}

}  // namespace

page::Surroundings surroundings_of(const SystemPlan& plan) {
  const PlcPlan& plc = plan.plcs.front();
  page::Surroundings around{.port = plan.lines.front().stations.front().port,
                            .plc = plc.settings,
                            .field = plc.field,
                            .faults = {},
                            .kept = plc.kept};
  for (const FaultPlan& fault : plan.lines.front().faults) around.faults.push_back(fault.fault);
  return around;
}

std::string with_runs(std::string_view page, std::string_view verb, const std::vector<ReportedRun>& runs) {
  RunsJson json;
  for (const ReportedRun& run : runs) json.add(run);
  return with_report(page, std::move(json).taken(verb));
}

std::string with_conversation(std::string_view page, const Json& decoded) {
  Json report = RunsJson().taken("decode");
  report["conversation"] = decoded;
  return with_report(page, report);
}

std::string link_to_run(const std::string& report, std::size_t number) {
  return fmt::format("{}#run={}", report, number + 1);
}

}  // namespace s7200::tools
