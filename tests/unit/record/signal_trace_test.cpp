// Signals over time, as VCD, CSV and in the format of Chrome.
#include "tools/record/signal_trace.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/slave_bench.hpp"
#include "tools/record/chrome_trace.hpp"

namespace s7200::tools::signal_trace_test {
namespace {

constexpr const char* kProgram =
    "LD SM0.1\nMOVB 16#09, SMB30\nMOVR 1.5, VD20\nATCH 5, 8\nENI\nLD SM0.0\nINCW VW10\nLDW>= VW10, 3\n= Q0.0\nMEND\n"
    "INT 5\nMOVB SMB2, VB0\nCRETI\nRETI\n";

/// What a form makes of a run of 100 ms in which two characters arrive.
std::string trace_of_run(const std::string& path, const std::string& signals) {
  const auto program = test::compile(kProgram);
  const auto wanted = signals.empty() ? std::vector<Signal>{} : parse_signals(signals, *program).value();
  serial::Simulation simulation(program);
  const TraceFormat& format = trace_format_of(path);
  EXPECT_EQ(why_not_signals(format, wanted), "");
  std::string text(format.first_line);
  const auto trace = format.writer({.take = [&text](Time, std::string_view line) { text += line; },
                                    .program = program,
                                    .detail = TraceDetail::Events,
                                    .station = {},
                                    .signals = signals_of(wanted, *program),
                                    .state = [&] { return &simulation.cpu().state(); }});
  simulation.cpu().set_sink(trace.get());
  simulation.power_up();
  simulation.run_until(50 * kMillisecond);
  simulation.configure_master(simulation.freeport().format);
  simulation.master().start({.frame = serial::to_frame(Bytes{0x41, 0x42})}, simulation.time());
  simulation.run_until(100 * kMillisecond);
  trace->finish();
  return text;
}

std::size_t count(const std::string& text, std::string_view what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST(Signals, AreAddressesSymbolsAndInterruptRoutines) {
  const auto program = test::compile(kProgram);
  const auto signals = parse_signals("Q0.0, VW20,VD100:real,INT 5,INT", *program);
  ASSERT_TRUE(signals) << signals.why();
  EXPECT_EQ(signals->size(), 5U);
  EXPECT_EQ((*signals)[3].routine, 5);
  const std::vector<Signal> all = signals_of(*signals, *program);
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[4].name, "INT5");
}

TEST(Signals, AreLevelsOfThePortsThatTheCpuHas) {
  const auto program = test::compile(kProgram);
  const auto signals = parse_signals("PORT0.TXD,port0", *program);
  ASSERT_TRUE(signals) << signals.why();
  std::string names;
  for (const Signal& one : signals_of(*signals, *program)) names += one.name + " ";
  EXPECT_EQ(names, "PORT0.TXD PORT0.RXD PORT0.TXD PORT0.LINE ");
  EXPECT_EQ(parse_signals("PORT1", *program).why(), "PORT1: the CPU 214 has no port 1");
  EXPECT_EQ(parse_signals("PORT0.CTS", *program).why(), "PORT0.CTS: the levels of a port are RXD, TXD and LINE");
}

TEST(VcdTrace, LevelsAreInTheirPlaceAmongWhatTheCpuHasDoneMeanwhile) {
  const auto program = test::compile(kProgram);
  std::string text;
  const auto wanted = parse_signals("INT5,PORT0.TXD", *program).value();
  const auto trace = trace_format_of("a.vcd").writer(
      {.take = [&text](Time, std::string_view line) { text += line; }, .program = program, .signals = wanted});
  text.clear();
  trace->record({.at = 500, .kind = TraceKind::ServiceBegin, .routine = 5});
  trace->level(0, PortLevel::Txd, 300, false);
  trace->level(0, PortLevel::Rxd, 400, false);
  trace->level(0, PortLevel::Txd, 900, true);
  trace->settled(0, 900);
  EXPECT_EQ(text, "#0\n0!\n1\"\n#300\n0\"\n#500\n1!\n") << "0, 300, 500; 900 may still have more";
  trace->level(0, PortLevel::Txd, 200, true);
  trace->finish();
  EXPECT_TRUE(text.ends_with("#900\n1\"\n")) << "what was told before is not told again: " << text;
}

TEST(Signals, OfSeveralValuesOrNoneAreRefused) {
  const auto program = test::compile(kProgram);
  std::string why = parse_signals("VB0:4", *program).why();
  EXPECT_EQ(why, "VB0:4 is several values; name each");
  EXPECT_EQ(parse_signals("", *program).why(), "there is no signal; name some, for example Q0.0,VW20,INT");
  EXPECT_FALSE(parse_signals("VW99999", *program));
}

TEST(VcdTrace, HasAVariableForEachSignalAndEachChangeOnce) {
  const std::string text = trace_of_run("a.vcd", "Q0.0,VW10,VD20:real,INT");
  EXPECT_NE(text.find("$timescale 1 ns $end"), std::string::npos);
  EXPECT_NE(text.find("$var wire 1 ! Q0.0 $end"), std::string::npos) << text.substr(0, 400);
  EXPECT_NE(text.find("$var wire 16 \" VW10 $end"), std::string::npos);
  EXPECT_NE(text.find("$var real 64 # VD20:real $end"), std::string::npos);
  EXPECT_NE(text.find("$var wire 1 $ INT5 $end"), std::string::npos);
  EXPECT_EQ(count(text, "\n1!"), 1U) << "Q0.0 comes on once";
  EXPECT_EQ(count(text, "\nr1.5 #"), 1U);
  EXPECT_EQ(count(text, "\n1$"), 2U) << "two characters, two interrupts";
  EXPECT_EQ(count(text, "\n0$"), 3U) << "and 0 at first";
}

TEST(VcdTrace, TimesGoUp) {
  const std::string text = trace_of_run("a.vcd", "VW10,INT");
  Time last = -1;
  for (std::size_t at = text.find("\n#"); at != std::string::npos; at = text.find("\n#", at + 1)) {
    const Time time = std::stoll(text.substr(at + 2));
    EXPECT_GT(time, last);
    last = time;
  }
  EXPECT_GT(last, 90 * kMillisecond);
}

TEST(CsvTrace, HasARowForEachChangeWithTheValuesOfAll) {
  const std::string text = trace_of_run("a.csv", "VW10,Q0.0");
  EXPECT_TRUE(text.starts_with("time_ms,VW10,Q0.0\n")) << text.substr(0, 100);
  EXPECT_NE(text.find(",2,0\n"), std::string::npos);
  EXPECT_NE(text.find(",3,0\n"), std::string::npos) << "VW10 changes before Q0.0 follows";
  EXPECT_NE(text.find(",3,1\n"), std::string::npos);
}

TEST(ChromeTrace, IsAnArrayOfEventsThatItsFormatHas) {
  const auto events = nlohmann::json::parse(trace_of_run("a.json", "VW10"));
  std::size_t slices = 0, arrows = 0, counters = 0;
  for (const auto& event : events) {
    EXPECT_TRUE(event.contains("ph") && event.contains("pid") && event.contains("name")) << event;
    const std::string phase = event["ph"];
    EXPECT_NE(std::string("MXisfC").find(phase), std::string::npos) << event;
    EXPECT_TRUE(phase == "M" || event["ts"].is_number()) << event;
    EXPECT_TRUE(phase != "X" || event["dur"] > 0) << event;
    slices += phase == "X" && event["name"] == "INT 5";
    arrows += phase == "s";
    counters += phase == "C" && event["name"] == "VW10";
  }
  EXPECT_EQ(slices, 2U);
  EXPECT_EQ(arrows, 2U);
  EXPECT_GT(counters, 3U);
}

TEST(TraceFormats, SayWhatTheyMakeOfSignals) {
  const std::vector<Signal> some{{.kind = Signal::Kind::Interrupts, .name = "INT"}};
  EXPECT_EQ(why_not_signals(trace_format_of("a.vcd"), {}),
            "a trace as .vcd shows signals: name some, for example --signals Q0.0,VW20,INT");
  EXPECT_EQ(why_not_signals(trace_format_of("a.txt"), some),
            "--signals are shown by a trace as .vcd, .csv or .json, and this is none");
  EXPECT_EQ(why_not_signals(trace_format_of("a.json"), {}), "");
}

}  // namespace
}  // namespace s7200::tools::signal_trace_test
