#include "tools/record/json_trace.hpp"

#include <bit>
#include <utility>

#include "interpreter/trace/text/statement_text.hpp"
#include "interpreter/trace/trace_rows.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

ordered_json statement_json(std::uint32_t op, const Program& program) {
  if (op == kNoRoutine) return nullptr;
  return {{"place", line_of(op, program)}, {"statement", short_text(program.statement(op))}};
}

/// Times have their unit in their name.
void add(ordered_json& line, const TraceField& field, const TraceRecord& record, const Program& program) {
  std::string name(field.name);
  switch (field.type) {
    case FieldType::Number:
      line[name] = field.number(record);
      return;
    case FieldType::Flag:
      line[name] = field.number(record) != 0;
      return;
    case FieldType::Instant:
    case FieldType::Interval:
      line[name + "_ns"] = field.number(record);
      return;
    case FieldType::Statement:
      line[name] = statement_json(static_cast<std::uint32_t>(field.number(record)), program);
      return;
    case FieldType::Words:
      line[name] = field.words(record);
      return;
  }
}

ordered_json begun(Time at, std::string_view station, std::string_view kind) {
  ordered_json line{{"at_ns", at}};
  if (!station.empty()) line["station"] = station;
  line["kind"] = kind;
  return line;
}

std::string ended(const ordered_json& line) { return tools::line_of(line) + "\n"; }

}  // namespace

std::string json_note(Time at, std::string_view station, std::string_view what) {
  ordered_json line = begun(at, station, "note");
  line["text"] = what;
  return ended(line);
}

ordered_json members_of(const TraceRecord& record, const Program& program) {
  const TraceRow& row = row_of(record.kind);
  ordered_json members = ordered_json::object();
  if (row.of_port) members["port"] = record.port;
  for (const TraceField& field : row.fields) add(members, field, record, program);
  return members;
}

JsonTrace::JsonTrace(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail, std::string station)
    : TraceWriter(detail),
      take_(std::move(take)),
      program_(std::move(program)),
      station_(std::move(station)),
      lines_(*program_) {
  if (!has_instructions()) return;
  for (std::uint32_t op = 0; op < program_->ops.size(); ++op) values_.push_back(watched_values(*program_, op));
}

void JsonTrace::record(const TraceRecord& record) {
  if (has(record)) {
    ordered_json line = begun(record.at, station_, row_of(record.kind).name);
    line.update(members_of(record, *program_));
    fmt::memory_buffer text;
    lines_.append_to(text, record);
    line["text"] = fmt::to_string(text);
    take_(record.at, ended(line));
  }
  for (const TraceLine& line : lines_.besides(record)) note(line.at, line.text);
}

void JsonTrace::instruction(const InstructionRecord& record) {
  if (has_instructions()) {
    ordered_json line = begun(record.at, station_, "instruction");
    line["end_ns"] = record.end;
    line.update(statement_json(record.op, *program_));
    line["power_flow"] = record.powered;
    line["top_of_stack"] = record.top;
    line["values"] = ordered_json::object();
    for (const WatchedValue& value : values_[record.op]) {
      const auto number = record.value[value.operand];
      ordered_json& written = line["values"][value.name];
      if (number) written = value.real ? real_json(std::bit_cast<float>(*number)) : ordered_json(*number);
    }
    take_(record.end, ended(line));
  }
  if (const auto line = lines_.of(record)) note(line->at, line->text);
}

void JsonTrace::note(Time at, std::string_view what) { take_(at, json_note(at, station_, what)); }

}  // namespace s7200::tools
