#include "tools/faces/page/engine/surroundings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "tools/json/json_taker.hpp"
#include "tools/plan/plc_keys.hpp"
#include "tools/rig/memory_json.hpp"

namespace s7200::tools::page {
namespace {

/// A text, or a list of them; others are left out.
std::vector<std::string> texts_of(const Json& value) {
  std::vector<std::string> texts;
  const auto add = [&texts](const Json& one) {
    if (const auto* const text = one.get_ptr<const std::string*>()) texts.push_back(*text);
  };
  if (value.is_array())
    for (const Json& one : value) add(one);
  else
    add(value);
  return texts;
}

/// The last text of an option; nothing without it.
std::optional<std::string> text_of(const Json& options, const char* name) {
  if (!JsonTaker::has(options, name)) return {};
  const std::vector<std::string> texts = texts_of(options.at(name));
  return texts.empty() ? std::nullopt : std::optional(texts.back());
}

/// Whether a key of a PLC is an option here: what it powers up with, without files and what is shown at the end.
bool is_option(const PlcKey& key) { return key.take && key.text && key.shape == PlcKey::Shape::Value; }

const PlcKey* key_named(std::string_view name) {
  const auto found = std::ranges::find_if(plc_keys(), [&](const PlcKey& key) { return is_option(key) && key.name == name; });
  return found == plc_keys().end() ? nullptr : &*found;
}

// --- inputs over time, by their places in the image of this program ---

Json field_json(const serial::FieldScript& field) {
  Json json{{"changes", Json::array()}, {"pulses", Json::array()}};
  for (const serial::FieldChange& one : field.changes) json["changes"].push_back({one.at, one.place, one.mask, one.value});
  for (const serial::FieldPulses& one : field.pulses)
    json["pulses"].push_back({one.at, one.place, one.mask, one.pulses, one.millihertz});
  return json;
}

serial::FieldScript take_field(JsonTaker& taker, const Json& json) {
  const auto number = [&taker]<class Number>(const Json& row, std::size_t i, Between<Number> range) {
    return taker.number<Number>(taker.element(row, i), range);
  };
  constexpr Between<Time> kInstant{0, kNever};
  constexpr Between<std::uint32_t> kPlace{0, image::kSize - 1};
  constexpr Between<std::uint8_t> kByte{0, 255};
  constexpr Between<std::uint64_t> kMany{0, 1'000'000'000'000'000};
  serial::FieldScript field;
  for (const Json& row : taker.list_at(json, "changes"))
    field.changes.push_back(
        {number(row, 0, kInstant), number(row, 1, kPlace), number(row, 2, kByte), number(row, 3, kByte)});
  for (const Json& row : taker.list_at(json, "pulses"))
    field.pulses.push_back({number(row, 0, kInstant), number(row, 1, kPlace), number(row, 2, kByte), number(row, 3, kMany),
                            number(row, 4, Between<std::uint64_t>{1, kMany.most})});
  return field;
}

// --- one option ---

using Read = Result<> (*)(Surroundings& around, const Json& value, const Program& program);

Result<> read_port(Surroundings& around, const Json& value, const Program& program) {
  const std::vector<std::string> texts = texts_of(value);
  if (texts.size() != 1 || (texts[0] != "0" && texts[0] != "1")) return Trouble{"a port is 0 or 1"};
  around.port = texts[0] == "1" ? 1 : 0;
  if (around.port >= program.model->ports) return trouble("a CPU {} has one port", program.model->name);
  return {};
}

Result<> read_assignments(Surroundings& around, const Json& value, const Program& program) {
  Result<> done;
  for (const std::string& text : texts_of(value))
    if (const auto assignment = parse_assignment(text, program))
      around.plc.set.push_back(*assignment);
    else
      done = assignment.trouble();
  return done;
}

Result<> read_faults(Surroundings& around, const Json& value, const Program& /*program*/) {
  for (const std::string& text : texts_of(value)) {
    const serial::ParsedFault fault = serial::parse_fault(text);
    if (fault.error) return Trouble{fault.error->message};
    around.faults.push_back(fault.fault);
  }
  return {};
}

Result<> taken(const JsonTaker& taker) { return taker.fine() ? Result<>() : Trouble{taker.why()}; }

Result<> read_kept(Surroundings& around, const Json& value, const Program& program) {
  JsonTaker taker;
  around.kept = take_kept_memory(taker, value, *program.model);
  return taken(taker);
}

Result<> read_field(Surroundings& around, const Json& value, const Program& /*program*/) {
  JsonTaker taker;
  around.field = take_field(taker, value);
  return taken(taker);
}

/// What has been read before there is a program.
Result<> read_before(Surroundings& /*around*/, const Json& /*value*/, const Program& /*program*/) { return {}; }

struct Row {
  std::string_view name;
  Read read;
};
constexpr std::array kRows{Row{"cpu", read_before},   Row{"times", read_before},    Row{"repair", read_before},
                           Row{"port", read_port},    Row{"set", read_assignments}, Row{"input", read_assignments},
                           Row{"fault", read_faults}, Row{"field", read_field},     Row{"kept", read_kept}};

std::string names_of_options() {
  std::vector<std::string_view> names;
  for (const Row& row : kRows) names.push_back(row.name);
  for (const PlcKey& key : plc_keys())
    if (is_option(key)) names.push_back(key.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

Result<> read_option(Surroundings& around, const std::string& name, const Json& value, const Program& program) {
  if (const auto row = std::ranges::find(kRows, name, &Row::name); row != kRows.end())
    return row->read(around, value, program);
  const PlcKey* const key = key_named(name);
  if (!key) return trouble("there is no option '{}' here; there are {}", stl::shortened(name), names_of_options());
  const AddressSpace space = program;
  for (const std::string& text : texts_of(value))
    if (std::string why = key->take(around.plc, text, &space).message; !why.empty()) return Trouble{std::move(why)};
  return {};
}

/// What a key says in a file may stand in quotes there.
std::string without_quotes(std::string text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return text.substr(1, text.size() - 2);
  return text;
}

std::string text_of_repairs(const Repairs& repairs) {
  return repairs.all ? "all" : fmt::format("{}", fmt::join(repairs.ids, ","));
}

}  // namespace

Json options_of(const Program& program, const Surroundings& around, const Repairs& repairs) {
  Json options{{"cpu", program.model->name}};
  if (repairs != Repairs{}) options["repair"] = text_of_repairs(repairs);
  if (const std::string times = to_csv(program.times); times != to_csv(default_times(*program.model)))
    options["times"] = times;
  PlcSettings plc = around.plc;
  plc.system_block = program.system_block;  // the CPU has it, whoever asked for it
  for (const PlcKey& key : plc_keys())
    if (const std::string text = is_option(key) ? key.text(plc) : ""; !text.empty())
      options[key.name] = without_quotes(text);
  if (around.port != 0) options["port"] = fmt::format("{}", around.port);
  for (const Assignment& one : around.plc.set)
    options["set"].push_back(fmt::format("{}={}", one.place.name_of(0), one.value));
  for (const serial::Fault& fault : around.faults) options["fault"].push_back(serial::to_text(fault));
  if (around.field != serial::FieldScript{}) options["field"] = field_json(around.field);
  if (around.kept) {
    options["kept"] = Json::object();
    add_kept_memory(options["kept"], *around.kept, *program.model);
  }
  return options;
}

Result<const CpuModel*> cpu_of_options(const Json& options) {
  const auto name = text_of(options, "cpu");
  const CpuModel* const model = name ? find_cpu(*name) : nullptr;
  if (!name || model) return model;
  return trouble("there is no model of CPU '{}'", stl::shortened(*name));
}

Result<Repairs> repairs_of_options(const Json& options) {
  const auto text = text_of(options, "repair");
  return text ? parse_repairs(*text) : Repairs{};
}

Result<TimeTable> times_of_options(const Json& options, const CpuModel& model) {
  const auto text = text_of(options, "times");
  if (!text) return default_times(model);
  TimeTable times;
  const std::vector<std::string> errors = times.add(*text, "times");
  if (errors.empty()) return times;
  return Trouble{errors.front()};
}

Result<Surroundings> surroundings_of_options(const Json& options, const Program& program) {
  Surroundings around;
  for (const auto& [name, value] : options.items()) {
    if (const auto done = read_option(around, name, value, program); !done) return trouble("{}: {}", name, done.why());
  }
  return around;
}

}  // namespace s7200::tools::page
