// A trace as JSON lines: an object for each record, with its members by the names that trace_rows() gives them, for programs
// to read. TRACE.md has the names.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/text/instruction_lines.hpp"
#include "interpreter/trace/text/trace_lines.hpp"
#include "interpreter/trace/trace_writer.hpp"

namespace s7200::tools {

/// The line of a note: what is done to a PLC or a line from outside, or what the records before it mean together. `station`:
/// empty where there is one PLC.
std::string json_note(Time at, std::string_view station, std::string_view what);

/// What a record says besides its instant and kind, by the names of trace_rows().
nlohmann::ordered_json members_of(const TraceRecord& record, const Program& program);

class JsonTrace final : public TraceWriter {
 public:
  JsonTrace(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail, std::string station);

  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;
  void note(Time at, std::string_view what) override;

 private:
  const TakeLine take_;
  const std::shared_ptr<const Program> program_;
  const std::string station_;
  TraceLines lines_;
  std::vector<std::vector<WatchedValue>> values_;  // by op
};

}  // namespace s7200::tools
