#include "tools/faces/page/engine/engine.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "interpreter/analysis/check.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/program/cpu_choice.hpp"
#include "interpreter/program/load.hpp"
#include "tools/json/json_text.hpp"
#include "tools/views/check_report.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools::page {
namespace {

constexpr Client kPage = 1;  // there is one

/// A text, or nothing if it is another value or left out.
const std::string* text_at(const Json& map, const char* key) {
  const auto found = map.is_object() ? map.find(key) : map.end();
  return found == map.end() ? nullptr : found->get_ptr<const std::string*>();
}

/// A text, or a list of them; others are left out.
std::vector<std::string> texts_at(const Json& map, const char* key) {
  std::vector<std::string> texts;
  if (const std::string* const one = text_at(map, key)) texts.push_back(*one);
  const auto found = map.is_object() ? map.find(key) : map.end();
  if (found != map.end() && found->is_array())
    for (const Json& one : *found)
      if (const auto* const text = one.get_ptr<const std::string*>()) texts.push_back(*text);
  return texts;
}

const Json& member_or_null(const Json& map, const char* key) {
  static const Json kNull;
  const auto found = map.is_object() ? map.find(key) : map.end();
  return found == map.end() ? kNull : *found;
}

/// The sources of a message as one program. Nothing, and `why`, if one of them cannot be read.
std::optional<SourceText> read_sources(const Json& sources, std::string& why) {
  std::vector<SourceText> files;
  for (const Json& source : sources) {
    const std::string *const name = text_at(source, "name"), *const text = text_at(source, "text");
    if (!name || !text) return why = "a source has a name and a text", std::nullopt;
    auto file = read_source(*text, *name, why);
    if (!file) return why = fmt::format("cannot read {}: {}", stl::printable(*name), why), std::nullopt;
    files.push_back(std::move(*file));
  }
  if (files.empty()) return why = "there are no sources: the text of a program first", std::nullopt;
  return join_files(std::move(files));
}

/// The CPU that is asked for, else that of the program's head, else the first one that can run it. Null if there is no such.
const CpuModel* model_for(const SourceText& text, const Json& options, std::string& why) {
  if (const std::string* const name = text_at(options, "cpu")) {
    const CpuModel* const model = find_cpu(*name);
    if (!model) why = fmt::format("there is no model of CPU '{}'", stl::shortened(*name));
    return model;
  }
  const CpuModel* const named = cpu_in_head(text.parsed.source);
  return named ? named : &first_cpu_for(text.parsed);
}

/// The options of a message. Nothing, and `why`, if one of them is not known here, or wrong.
std::optional<Surroundings> read_options(const Json& options, const Program& program, std::string& why) {
  Surroundings read;
  for (const auto& [key, value] : options.items()) {
    if (key != "cpu" && key != "port" && key != "set" && key != "input" && key != "fault")
      return why =
                 fmt::format("there is no option '{}' here; there are cpu, port, set, input and fault", stl::shortened(key)),
             std::nullopt;
    for (const std::string& text : texts_at(options, key.c_str())) {
      if (key == "port" && text != "0" && text != "1") why = "a port is 0 or 1";
      if (key == "port" && text == "1") read.port = 1;
      if (key == "port" && read.port >= program.model->ports)
        why = fmt::format("a CPU {} has one port", program.model->name);
      if (key == "set" || key == "input")
        if (const auto assignment = parse_assignment(text, program, why)) read.set.push_back(*assignment);
      if (key == "fault") {
        if (const serial::ParsedFault fault = serial::parse_fault(text); fault.error)
          why = fault.error->message;
        else
          read.faults.push_back(fault.fault);
      }
      if (!why.empty()) return why = fmt::format("{}: {}", key, why), std::nullopt;
    }
  }
  return read;
}

}  // namespace

void Engine::take(std::string_view text) {
  std::string why;
  const auto message = parse_json(text, why);
  if (!message || !message->is_object())
    return send_(line_of({{"id", nullptr}, {"error", message ? "not a JSON object" : why}}));
  if (message->contains("stop")) return;  // nothing goes on while a message is taken
  if (message->contains("open")) return open(*message);
  if (!talk_) return send_(line_of({{"id", member_or_null(*message, "id")}, {"error", "open a program first"}}));
  talk_->handle(kPage, *message);
  if (talk_->is_over()) talk_->end("quit");
}

void Engine::open(const Json& message) {
  const Json &wanted = member_or_null(message, "open"), &id = member_or_null(message, "id");
  std::string why;
  const auto text = read_sources(member_or_null(wanted, "sources"), why);
  const Json& options = member_or_null(wanted, "options");
  const CpuModel* const model = text ? model_for(*text, options, why) : nullptr;
  if (!model) return send_(line_of({{"id", id}, {"error", why}}));
  const CheckResult result = check(text->parsed, *model, default_times(*model));
  const std::vector<const CpuModel*> others = fine_for(*text, result, *model);
  Json report = check_json(text->parsed.source.name, *text, result, *model, others);
  report["text"] = stl::render(result.diagnostics, result.source, false) + check_summary(*text, result, *model, others);
  report["opened"] = result.program != nullptr;
  const auto around = result.program ? read_options(options, *result.program, why) : std::nullopt;
  if (!why.empty()) return send_(line_of({{"id", id}, {"error", why}}));
  if (around) begin(result.program, *around);
  send_(line_of({{"id", id}, {"text", report["text"]}, {"json", report}, {"moved", result.program != nullptr}}));
  if (talk_ && result.program) talk_->greet(kPage);
}

void Engine::begin(std::shared_ptr<const Program> program, const Surroundings& around) {
  talk_.reset();
  history_.reset();
  const std::string name = program->source.name;
  simulation_ = std::make_unique<serial::Simulation>(std::move(program), serial::FieldScript{}, around.port);
  simulation_->power_up();
  for (const Assignment& one : around.set) assign(simulation_->cpu(), one);
  for (const serial::Fault& fault : around.faults) simulation_->inject(fault);
  history_ = std::make_unique<History>(*simulation_, History::Settings{});
  talk_ = std::make_unique<Conversation>(*history_, PageSettings{.program = name},
                                         Post{[this](Client, std::string reply) { send_(std::move(reply)); }, send_});
}

}  // namespace s7200::tools::page
