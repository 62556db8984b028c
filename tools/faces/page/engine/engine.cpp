#include "tools/faces/page/engine/engine.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/cpu_choice.hpp"
#include "interpreter/program/loading/slips.hpp"
#include "interpreter/stl/text/encoding.hpp"
#include "tools/faces/page/engine/carried_system.hpp"
#include "tools/faces/page/engine/surroundings.hpp"
#include "tools/json/hex_bytes.hpp"
#include "tools/json/json_text.hpp"
#include "tools/session/commands/answers/recording_json.hpp"
#include "tools/views/program/check_report.hpp"
#include "tools/views/results_json.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools::page {
namespace {

constexpr Client kPage = 1;                            // there is one
constexpr std::size_t kBytesOfCheckpoints = 64 << 20;  // a page has less memory than a computer

/// A text, or nothing if it is another value or left out.
const std::string* text_at(const Json& map, const char* key) {
  const auto found = map.is_object() ? map.find(key) : map.end();
  return found == map.end() ? nullptr : found->get_ptr<const std::string*>();
}

const Json& member_or_null(const Json& map, const char* key) {
  static const Json kNull;
  const auto found = map.is_object() ? map.find(key) : map.end();
  return found == map.end() ? kNull : *found;
}

/// The bytes of a source: its `text`, or its `hex` if it is not UTF-8.
Result<std::string> bytes_of(const Json& source) {
  if (const std::string* const text = text_at(source, "text")) return *text;
  const std::string* const hex = text_at(source, "hex");
  auto bytes = hex ? bytes_of_hex(*hex) : std::nullopt;
  if (!bytes) return Trouble{"a source has a name, and text or hex"};
  return std::move(*bytes);
}

/// The sources that were in hex, as texts: in which encoding they are is found out here.
Json decoded_sources(const Json& sources) {
  Json decoded = Json::array();
  for (const Json& source : sources) {
    if (!text_at(source, "hex")) continue;
    const auto text = bytes_of(source).and_then(stl::decode);
    if (text) decoded.push_back({{"name", *text_at(source, "name")}, {"text", text->text}, {"encoding", text->encoding}});
  }
  return decoded;
}

/// The sources of a message as one program. Trouble if one of them cannot be read.
Result<SourceText> read_sources(const Json& sources) {
  std::vector<SourceText> files;
  for (const Json& source : sources) {
    const std::string* const name = text_at(source, "name");
    if (!name) return Trouble{"a source has a name, and text or hex"};
    const auto bytes = bytes_of(source);
    if (!bytes) return bytes.trouble();
    auto file = read_source(*bytes, *name);
    if (!file) return trouble("cannot read {}: {}", stl::printable(*name), file.why());
    files.push_back(std::move(*file));
  }
  if (files.empty()) return Trouble{"there are no sources: the text of a program first"};
  return join_files(std::move(files));
}

/// The CPU that is asked for, else that of the program's head, else the first one that can run it. Null if there is no such.
Result<const CpuModel&> model_for(const SourceText& text, const Json& options) {
  const auto asked = cpu_of_options(options);
  if (!asked) return asked.trouble();
  if (*asked) return **asked;
  const CpuModel* const named = cpu_in_head(text.parsed.source);
  return named ? *named : first_cpu_for(text.parsed);
}

/// Repairs the slips that the options name. Trouble if the listing does not have one of them.
Result<> repair_slips(SourceText& text, const Json& options) {
  const auto repairs = repairs_of_options(options);
  std::vector<std::string> unknown;
  if (!repairs) return repairs.trouble();
  repair(text.parsed.source, *repairs, unknown);
  if (!unknown.empty()) return trouble("repair: there is no slip {} in it", stl::shortened(unknown.front()));
  return {};
}

/// As a rig powers up the PLC of a program.
void power_up(serial::Simulation& simulation, const Surroundings& around) {
  simulation.cpu().set_clock_error(around.plc.clock_error);
  simulation.power_up(around.kept ? &*around.kept : nullptr);
  if (around.plc.clock) simulation.cpu().set_clock(*around.plc.clock);
  for (const Assignment& one : around.plc.set) assign(simulation.cpu(), one);
  for (const serial::Fault& fault : around.faults) simulation.inject(fault);
}

/// The recording of a message; nothing to say if it has none, trouble if it is none of those CPUs.
Result<Recording> recording_of(const Json& wanted, Models models) {
  const Json& recorded = member_or_null(wanted, "recording");
  if (recorded.is_null()) return std::nullopt;
  auto recording = recording_from(recorded, models);
  if (!recording) return trouble("recording: {}", recording.why());
  return recording;
}

/// By PLC, with how masters talk on its line.
std::vector<DebuggedStation> stations_of(const SystemPlan& plan) {
  std::vector<DebuggedStation> stations;
  for (const Spot& spot : spots_of_plcs(plan))
    stations.push_back({plan.plcs[spot.plc].name, on_line(serial::MasterSettings{}, plan.lines[spot.line])});
  return stations;
}

}  // namespace

void Engine::take(std::string_view text) {
  const auto message = parse_json(text);
  if (!message || !message->is_object())
    return send_(line_of({{"id", nullptr}, {"error", message ? "not a JSON object" : message.why()}}));
  const bool ends_run = talk_ && message->contains("run");
  if (message->contains("stop") && !ends_run) return;  // no command goes on while a message is taken
  if (message->contains("open")) return open(*message);
  if (!talk_) return send_(line_of({{"id", member_or_null(*message, "id")}, {"error", "open a program first"}}));
  talk_->handle(kPage, *message);
  if (talk_->is_over()) talk_->end("quit");
}

void Engine::open(const Json& message) {
  const Json &wanted = member_or_null(message, "open"), &id = member_or_null(message, "id");
  if (member_or_null(wanted, "system").is_null()) return open_program(wanted, id);
  open_system(wanted, id);
}

void Engine::open_program(const Json& wanted, const Json& id) {
  const auto refuse = [&](const std::string& why) { send_(line_of({{"id", id}, {"error", why}})); };
  auto text = read_sources(member_or_null(wanted, "sources"));
  const Json& options = member_or_null(wanted, "options");
  if (!text) return refuse(text.why());
  if (const auto done = repair_slips(*text, options); !done) return refuse(done.why());
  const auto model = model_for(*text, options);
  if (!model) return refuse(model.why());
  const auto times = times_of_options(options, *model);
  if (!times) return refuse(times.why());
  CheckResult result = check(text->parsed, *model, *times);
  const std::vector<const CpuModel*> others = fine_for(*text, result, *model);
  Json report = check_json(text->parsed.source.name, *text, result, *model, others);
  report["text"] = stl::render(result.diagnostics, result.source, false) + check_summary(*text, result, *model, others);
  report["opened"] = result.program != nullptr;
  report["sources"] = decoded_sources(member_or_null(wanted, "sources"));
  if (result.program)
    if (const auto done = begin(std::move(result.program), wanted); !done) return refuse(done.why());
  send_(line_of({{"id", id}, {"text", report["text"]}, {"json", report}, {"moved", report["opened"]}}));
  if (talk_ && report["opened"] == true) talk_->greet(kPage);
}

void Engine::open_system(const Json& wanted, const Json& id) {
  if (const auto done = begin_system(wanted); !done) return send_(line_of({{"id", id}, {"error", done.why()}}));
  send_(line_of({{"id", id}, {"text", ""}, {"json", {{"opened", true}}}, {"moved", true}}));
  talk_->greet(kPage);
}

Result<> Engine::begin(std::shared_ptr<const Program> program, const Json& wanted) {
  const auto around = surroundings_of_options(member_or_null(wanted, "options"), *program);
  if (!around) return around.trouble();
  auto recording = recording_of(wanted, std::array{program->model});
  if (!recording.why().empty()) return recording.trouble();
  forget();
  const std::string name = program->source.name;
  if (around->plc.system_block != SystemBlock{}) program = with_system_block(*program, around->plc.system_block);
  simulation_ = std::make_unique<serial::Simulation>(std::move(program), around->field, around->port);
  power_up(*simulation_, *around);
  return look_at(std::make_unique<History>(*simulation_, History::Settings{.bound = kBytesOfCheckpoints}),
                 std::move(recording).if_any(), PageSettings{.program = name});
}

Result<> Engine::begin_system(const Json& wanted) {
  const Json& carried = member_or_null(wanted, "system");
  auto system = system_from(carried);
  if (!system) return trouble("system: {}", system.why());
  std::vector<const CpuModel*> models;
  for (const PlcPlan& plc : system->plan.plcs) models.push_back(plc.program->model);
  if (models.empty()) return Trouble{"system: it has no S7-200"};
  auto recording = recording_of(wanted, models);
  if (!recording.why().empty()) return recording.trouble();
  forget();
  rig_ = std::make_unique<Rig>(std::move(system->plan), RigSpots{.spots = system->spots, .lines = {}});
  rig_->power_up();
  seen_ = std::make_unique<SeenRig>(*rig_, system->spots);
  History::Settings settings = history_settings(*rig_);
  settings.hosts = hosts_of(*rig_);
  settings.bound = kBytesOfCheckpoints;
  PageSettings page{.program = *text_at(carried, "name")};
  page.session.stations = stations_of(rig_->plan());
  return look_at(std::make_unique<History>(seen_->stations(), std::move(settings)), std::move(recording).if_any(),
                 std::move(page));
}

/// What was open, in the order in which it hangs together.
void Engine::forget() {
  talk_.reset();
  history_.reset();
  simulation_.reset();
  seen_.reset();
  rig_.reset();
}

Result<> Engine::look_at(std::unique_ptr<History> history, std::optional<Recording> recording, PageSettings page) {
  history_ = std::move(history);
  if (recording && !history_->has_hosts_of(*recording)) return Trouble{"recording: it has a bridge that is not here"};
  if (recording && !history_->adopt(std::move(*recording)))
    return Trouble{"recording: a checkpoint in it is damaged, or is one of another program"};
  talk_ = std::make_unique<Conversation>(*history_, std::move(page),
                                         Post{[this](Client, std::string reply) { send_(std::move(reply)); }, send_});
  return {};
}

}  // namespace s7200::tools::page
