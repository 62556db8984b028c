// Each kind of record by its names; and TRACE.md, the page of them.
#include "tools/record/json_trace.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "interpreter/trace/text/text_trace.hpp"
#include "interpreter/trace/trace_rows.hpp"
#include "tests/support/slave_bench.hpp"
#include "tools/record/trace_formats.hpp"

namespace s7200::tools::json_trace_test {
namespace {

using nlohmann::json;

constexpr const char* kProgram =
    "// CPU 214\nLD SM0.1\nMOVB 16#09, SMB30\nMOVW 3, VW10\nATCH 5, 8\nENI\nLD SM0.0\n+I 1, VW10\nMEND\nINT 5\nMOVB SMB2, "
    "VB0\nCRETI\nRETI\n";

/// The lines of a run of 100 ms in which two characters arrive.
std::vector<json> lines_of_run(TraceDetail detail, const std::string& station = {}) {
  const auto program = test::compile(kProgram);
  std::vector<json> lines;
  const auto take = [&](Time, std::string_view line) { lines.push_back(json::parse(line)); };
  JsonTrace trace(take, program, detail, station);
  serial::Simulation simulation(program);
  simulation.cpu().set_sink(&trace);
  simulation.power_up();
  simulation.run_until(50 * kMillisecond);
  simulation.configure_master(simulation.freeport().format);
  simulation.master().start({.frame = serial::to_frame(Bytes{0x41, 0x42})}, simulation.time());
  simulation.run_until(100 * kMillisecond);
  return lines;
}

std::vector<json> of_kind(const std::vector<json>& lines, std::string_view kind) {
  std::vector<json> those;
  std::ranges::copy_if(lines, std::back_inserter(those), [&](const json& line) { return line["kind"] == kind; });
  return those;
}

TEST(JsonTrace, AnInterruptHasItsEventRoutineAndTimes) {
  const auto begun = of_kind(lines_of_run(TraceDetail::Events), "service_begin");
  ASSERT_EQ(begun.size(), 2U);
  EXPECT_EQ(begun[0]["event"], 8);
  EXPECT_EQ(begun[0]["routine"], 5);
  EXPECT_LE(begun[0]["occurred_ns"], begun[0]["at_ns"]);
  EXPECT_TRUE(begun[0].contains("after"));
}

TEST(JsonTrace, AStatementHasItsLineAndItsText) {
  const auto attached = of_kind(lines_of_run(TraceDetail::Events), "attach");
  ASSERT_EQ(attached.size(), 1U);
  EXPECT_EQ(attached[0]["by"], (json{{"place", "line 5"}, {"statement", "ATCH 5, 8"}}));
}

TEST(JsonTrace, ACharacterHasItsPortByteAndErrors) {
  const auto received = of_kind(lines_of_run(TraceDetail::Events), "received");
  ASSERT_EQ(received.size(), 2U);
  EXPECT_EQ(received[1]["port"], 0);
  EXPECT_EQ(received[1]["byte"], 0x42);
  EXPECT_EQ(received[1]["parity_error"], false);
  EXPECT_LT(received[1]["start_edge_ns"], received[1]["at_ns"]);
}

TEST(JsonTrace, AnInstructionHasTheValuesOfItsOperands) {
  const auto executed = of_kind(lines_of_run(TraceDetail::Instructions), "instruction");
  const auto added = std::ranges::find_if(executed, [](const json& line) { return line["statement"] == "+I 1, VW10"; });
  ASSERT_NE(added, executed.end());
  EXPECT_EQ((*added)["values"], (json{{"VW10", 4}}));
  EXPECT_EQ((*added)["power_flow"], true);
  EXPECT_LT((*added)["at_ns"], (*added)["end_ns"]);
}

TEST(JsonTrace, TextsAreThoseOfTheTextTrace) {
  const auto program = test::compile(kProgram);
  std::ostringstream text;
  TextTrace trace(text, program, TraceDetail::Way);
  serial::Simulation simulation(program);
  simulation.cpu().set_sink(&trace);
  simulation.power_up();
  simulation.run_until(50 * kMillisecond);
  std::size_t compared = 0;
  for (const json& line : lines_of_run(TraceDetail::Way)) {
    if (line["at_ns"] >= 50 * kMillisecond) continue;
    EXPECT_NE(text.str().find(" " + line["text"].get<std::string>() + "\n"), std::string::npos) << line;
    ++compared;
  }
  EXPECT_GT(compared, 5U);
}

TEST(JsonTrace, LinesOfASystemNameTheirStation) {
  for (const json& line : lines_of_run(TraceDetail::Events, "pump")) EXPECT_EQ(line["station"], "pump");
  EXPECT_EQ(json::parse(json_note(5, "pump", "power off")),
            (json{{"at_ns", 5}, {"station", "pump"}, {"kind", "note"}, {"text", "power off"}}));
}

TEST(TraceFormats, TheExtensionChooses) {
  EXPECT_EQ(trace_format_of("a.JSONL").extension, ".jsonl");
  EXPECT_EQ(trace_format_of("a.txt").extension, "");
  EXPECT_EQ(trace_format_of("-").extension, "");
}

TEST(TraceRows, EachKindHasItsNameAndItsFields) {
  std::set<std::string_view> names;
  for (const TraceRow& row : trace_rows()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    std::set<std::string_view> fields{"at", "station", "kind", "port", "text"};
    for (const TraceField& field : row.fields)
      EXPECT_TRUE(fields.insert(field.name).second) << row.name << ' ' << field.name;
  }
}

std::string shown(const TraceField& field) {
  const bool time = field.type == FieldType::Instant || field.type == FieldType::Interval;
  return fmt::format("`{}{}`", field.name, time ? "_ns" : "");
}

/// The table of TRACE.md, as the rows have it.
std::string page_of_rows() {
  std::string page = "| `kind` | keys |\n|---|---|\n";
  for (const TraceRow& row : trace_rows()) {
    std::vector<std::string> keys;
    if (row.of_port) keys.push_back("`port`");
    for (const TraceField& field : row.fields) keys.push_back(shown(field));
    page += fmt::format("| `{}` | {} |\n", row.name, fmt::join(keys, ", "));
  }
  return page;
}

TEST(TraceRows, AreThoseOfThePage) {
  std::ifstream file(test::source_path("tools/record/TRACE.md"));
  const std::string page{std::istreambuf_iterator(file), {}};
  EXPECT_NE(page.find(page_of_rows()), std::string::npos) << "the table is to be:\n" << page_of_rows();
}

}  // namespace
}  // namespace s7200::tools::json_trace_test
