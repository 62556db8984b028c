// The field: scripts of inputs over time, how they are read and how they are played; the record of outputs; several sinks.
#include "serial_sim/field/field.hpp"

#include <sstream>

#include "interpreter/trace/fan_out.hpp"
#include "interpreter/trace/output_record.hpp"
#include "interpreter/trace/output_waves.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::field_test {
namespace {

using serial::FieldChange, serial::FieldPulses, serial::FieldScript;

FieldScript script_of(std::string_view csv) {
  std::vector<std::string> errors;
  FieldScript script = serial::parse_field_script(csv, "in.csv", cpu214(), errors);
  for (const std::string& error : errors) ADD_FAILURE() << error;
  return script;
}

std::vector<std::string> errors_of(std::string_view csv) {
  std::vector<std::string> errors;
  serial::parse_field_script(csv, "in.csv", cpu214(), errors);
  return errors;
}

TEST(FieldScript, RowsBecomeChangesOfBytes) {
  const FieldScript script = script_of(
      "time,address,value\n# nothing yet\n\n10ms, I0.3, 1\r\n10ms,IB1,16#FF # lamp test\n1.5s,AIW2,-2\n"
      "2s,IW6,16#1234\n2s,SMB29,200\n3s,SM0.7,0\n4s,SM0.7,1");
  const std::vector<FieldChange> expected{
      {10 * ms, image::kInputs, 0x08, 0x08},         {10 * ms, image::kInputs + 1, 0xFF, 0xFF},
      {1500 * ms, image::kAI + 2, 0xFF, 0xFF},       {1500 * ms, image::kAI + 3, 0xFF, 0xFE},
      {2 * kSecond, image::kInputs + 6, 0xFF, 0x12}, {2 * kSecond, image::kInputs + 7, 0xFF, 0x34},
      {2 * kSecond, image::kSM + 29, 0xFF, 200},     {3 * kSecond, sm::kScanStatus, 0x80, 0},
      {4 * kSecond, sm::kScanStatus, 0x80, 0x80}};
  EXPECT_EQ(script.changes, expected);
  EXPECT_TRUE(script.pulses.empty());
}

TEST(FieldScript, SpreadsheetsMayWriteSemicolonsOrTabsAndDecimalCommas) {
  const FieldScript usual = script_of("1.5s,I0.3,1\n2s,AIW0,7\n3s,I0.6,pulses,0.5 Hz,7.5s\n");
  EXPECT_EQ(script_of("time;address;value;;\r\n1,5s;I0.3;1;;\r\n;;;;\r\n2s;AIW0;7;;\r\n3s;I0.6;pulses;0,5 Hz;7,5s\r\n"),
            usual);
  EXPECT_EQ(script_of("time\taddress\tvalue\n1,5s\tI0.3\t1\n2s\tAIW0\t7\n3s\tI0.6\tpulses\t0,5 Hz\t7,5s\n"), usual);
  EXPECT_EQ(errors_of("1s,\"I0.3,1\n").at(0), "in.csv:1: a double quote is not closed");
}

TEST(FieldScript, RowsMayNameSymbolsOfTheProgram) {
  const auto symbol = [](const std::string& name, std::uint32_t number, std::uint8_t bit) {
    stl::Symbol one;
    one.name = name;
    one.value = stl::Address{.area = "I", .size = stl::Size::Bit, .number = number, .bit = bit};
    return one;
  };
  const std::vector<stl::Symbol> symbols{symbol("Start", 0, 3), symbol("Pump #1", 0, 4)};
  std::vector<std::string> errors;
  const std::string csv = "10ms,Start,1\n20ms,\"Pump #1\",1 # it runs\n30ms,Stop,1\n";
  const FieldScript script = serial::parse_field_script(csv, "in.csv", {cpu214(), symbols}, errors);
  const std::vector<FieldChange> expected{{10 * ms, image::kInputs, 0x08, 0x08}, {20 * ms, image::kInputs, 0x10, 0x10}};
  EXPECT_EQ(script.changes, expected);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_TRUE(errors[0].starts_with("in.csv:3: 'Stop' is not an address or a symbol; ")) << errors[0];
}

TEST(FieldScript, TheCpus221And222HaveOnePotentiometer) {
  for (const CpuModel* model : {&cpu221(), &cpu222(), &cpu224()}) {
    std::vector<std::string> errors;
    serial::parse_field_script("1ms,SMB28,5\n", "in.csv", *model, errors);
    EXPECT_TRUE(errors.empty());
    serial::parse_field_script("1ms,SMB29,5\n", "in.csv", *model, errors);
    EXPECT_EQ(errors.size(), model == &cpu224() ? 0u : 1u) << model->name;
  }
}

TEST(FieldScript, PulseTrainsAreWholePulses) {
  const FieldScript script = script_of("0ms,I0.6,pulses,5kHz,200ms\n1s,I1.2,pulses,0.5 Hz,7s\n1s,I1.3,pulses,1.5kHz,1ms\n");
  ASSERT_EQ(script.pulses.size(), 3u);
  EXPECT_EQ(script.pulses[0], (FieldPulses{0, image::kInputs, 0x40, 1000, 5'000'000}));
  EXPECT_EQ(script.pulses[1], (FieldPulses{kSecond, image::kInputs + 1, 0x04, 3, 500}));
  EXPECT_EQ(script.pulses[2], (FieldPulses{kSecond, image::kInputs + 1, 0x08, 1, 1'500'000}));
}

// 3 kHz: edges every 166666.67 ns, the 6th a millisecond after the first, the 6'000'000th exactly 1000 s.
TEST(FieldScript, EdgesAreNotAccumulated) {
  const FieldPulses train{7, image::kInputs, 1, 3'000'000, 3'000'000};
  EXPECT_EQ(train.edge(0), 7);
  EXPECT_EQ(train.edge(1), 7 + 166'666);
  EXPECT_EQ(train.edge(6), 7 + ms);
  EXPECT_EQ(train.edge(6'000'000), 7 + 1000 * kSecond);
}

TEST(FieldScript, EveryWrongRowIsNamedWithItsLineAndWhatToDo) {
  const std::pair<std::string_view, std::string_view> kCases[] = {
      {"10ms,I0.0", "in.csv:1: write time,address,value or"},
      {"10ms,I0.0,1,2", "in.csv:1: write time,address,value or"},
      {"10,I0.0,1", "in.csv:1: '10' is not a time; write for example 10ms"},
      {"\n# x\n2s,I0.0,1\n1s,I0.0,0", "in.csv:4: 1s lies before the row above; put"},
      {"1s,Q0.0,1", "'Q0.0' is not an input; rows set I"},
      {"1s,VB0,1", "'VB0' is not an input"},
      {"1s,SMB30,1", "'SMB30' is not an input"},
      {"1s,SM0.5,1", "'SM0.5' is not an input"},
      {"1s,SMB0,1", "'SMB0' is not an input"},
      {"1s,SMW28,1", "'SMW28' is not an input"},
      {"1s,AIW1,1", "AIW1 is an odd address; analog values are at even ones: AIW0"},
      {"1s,I8.0,1", "does not exist on CPU 214"},
      {"1s,IB0:2,1", "without a count"},
      {"1s,lamp,1", "'lamp' is not an address"},
      {"1s,I0.0,2", "'2' is not a value for I0.0; write"},
      {"1s,IB0,256", "'256' is not a value for IB0"},
      {"1s,IB0,", "'' is not a value for IB0"},
      {"1s,IB0,16#1FF", "'16#1FF' is not a value for IB0"},
      {"1s,IB0,pulses,1kHz,1s", "pulses need one input point"},
      {"1s,AIW0,pulses,1kHz,1s", "pulses need one input point"},
      {"1s,I0.0,pulses,1,1s", "'1' is not a frequency; write for example 50Hz or 5kHz"},
      {"1s,I0.0,pulses,0Hz,1s", "'0Hz' is out of range (0.001Hz to 1MHz)"},
      {"1s,I0.0,pulses,2000kHz,1s", "'2000kHz' is out of range (0.001Hz to 1MHz)"},
      {"1s,I0.0,pulses,1.1MHz,1s", "'1.1MHz' is out of range (0.001Hz to 1MHz)"},
      {"1s,I0.0,pulses,99999999999999999999kHz,1s", "'99999999999999999999kHz' is out of range (0.001Hz to 1MHz)"},
      {"1s,I0.0,pulses,1kHz,9999999999h", "'9999999999h' ends beyond 292 years"},
      {"1s,I0.0,pulses,1kHz,1", "'1' is not a duration"},
      {"1s,I0.0,pulses,1kHz,999us", "no whole pulse of 1kHz fits in 999us; make it longer"},
      {"1h,I0.0,pulses,1kHz,2562047h", "ends beyond 292 years"},
      {"1s,I0.0,pulses,1kHz,1s\n1999ms,I0.0,1", "in.csv:2: I0.0 has the pulses of line 1 until 2 s; let them end first"},
      {"1s,I0.0,pulses,1kHz,1s\n1999ms,IB0,1", "in.csv:2: IB0 has the pulses of line 1"},
      {"1s,I0.0,pulses,1kHz,1s\n1999ms,I0.0,pulses,1kHz,1s", "in.csv:2: I0.0 has the pulses of line 1"},
  };
  for (const auto& [csv, expected] : kCases) {
    const auto errors = errors_of(csv);
    ASSERT_EQ(errors.size(), 1u) << csv;
    EXPECT_NE(errors[0].find(expected), std::string::npos) << errors[0] << " / " << expected;
  }
  EXPECT_EQ(errors_of("x\ny\n1s,Q0.0,1\n").size(), 3u) << "all of them at once";
  EXPECT_TRUE(errors_of("1s,I0.0,pulses,1kHz,1s\n2s,I0.0,1\n1s,I0.1,0").size() == 1)
      << "time order holds across kinds of rows";
  EXPECT_TRUE(errors_of("1s,I0.0,pulses,1kHz,1s\n1500ms,I0.1,1\n2s,I0.0,1").empty());
  EXPECT_TRUE(errors_of("").empty());
}

/// A Simulation with records.
struct Plant {
  serial::Simulation simulation;
  Records records;
  Plant(std::string_view stl, std::string_view csv) : simulation(program_of(stl), script_of(csv)) {
    simulation.cpu().set_sink(&records);
    simulation.power_up();
  }
};

TEST(Field, ChangesComeAtTheirInstantAndThoseOfTime0BeforeTheFirstScan) {
  Plant plant("LD SM0.1\nATCH 0, 0\nATCH 0, 3\nENI\nLD SM0.1\nMOVW AIW0, VW0\nMEND\nINT 0\nRETI\n",
              "0ms,I0.1,1\n0ms,AIW0,-5\n2ms,I0.0,1\n3ms,I0.1,0\n");
  plant.simulation.run_until(5 * ms);
  EXPECT_EQ(plant.records.times(TraceKind::EventOccurred), (Times{2 * ms, 3 * ms}));
  EXPECT_EQ(plant.records.events(TraceKind::EventOccurred), (Ints{0, 3}));
  EXPECT_EQ(static_cast<std::int16_t>(load16(&plant.simulation.cpu().state().image[image::kV])), -5);
}

TEST(Field, ABitLeavesItsNeighboursAlone) {
  Plant plant("LD SM0.0\nMEND\n", "1ms,IB0,16#F0\n2ms,I0.0,1\n3ms,I0.7,0\n");
  plant.simulation.run_until(4 * ms);
  EXPECT_EQ(plant.simulation.cpu().state().image[image::kInputs], 0x71);
}

TEST(Field, PulsesArriveAtTheHighSpeedCounterAndEndAtZero) {
  Plant plant("LD SM0.1\nMOVB 16#F8, SMB47\nMOVD 1000, SMD52\nHDEF 1, 0\nHSC 1\nATCH 0, 13\nENI\nMEND\nINT 0\nRETI\n",
              "10ms,I0.6,pulses,20kHz,1s\n");
  plant.simulation.run_until(2 * kSecond);
  EXPECT_EQ(load32(&plant.simulation.cpu().state().image[image::kHC + 4]), 20'000u);
  EXPECT_EQ(plant.records.times(TraceKind::EventOccurred), Times{10 * ms + 999 * 50 * us})
      << "rising edge of the 1000th pulse";
  EXPECT_EQ(plant.simulation.cpu().state().image[image::kInputs], 0);
}

TEST(Field, TrainsOnSeveralPointsRunSideBySide) {
  Plant plant("LD SM0.1\nATCH 0, 0\nATCH 0, 2\nENI\nMEND\nINT 0\nRETI\n",
              "1ms,I0.0,pulses,1kHz,3ms\n1500us,I0.1,pulses,500Hz,4ms\n");
  plant.simulation.run_until(10 * ms);
  EXPECT_EQ(plant.records.times(TraceKind::EventOccurred), (Times{1 * ms, 1500 * us, 2 * ms, 3 * ms, 3500 * us}));
}

TEST(Field, ASnapshotHoldsThePlaceInTheScript) {
  const std::string_view program = "LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nINCW VW0\nRETI\n";
  Plant plant(program, "1ms,I0.1,1\n2ms,I0.0,pulses,333Hz,100ms\n50ms,I0.1,0\n");
  plant.simulation.run_until(40 * ms);
  const auto snapshot = plant.simulation.snapshot();
  plant.simulation.run_until(200 * ms);
  const auto end = plant.simulation.snapshot();
  plant.simulation.restore(snapshot);
  EXPECT_TRUE(plant.simulation.snapshot() == snapshot);
  plant.simulation.run_until(200 * ms);
  EXPECT_TRUE(plant.simulation.snapshot() == end);
  EXPECT_EQ(load16(&end.plcs[0].cpu.image[image::kV]), 33);
}

TEST(OutputRecordTest, OneRowForEachPointAndAnalogWordThatChanges) {
  std::ostringstream out;
  OutputRecord record(out);
  record.record({.at = 2 * ms, .kind = TraceKind::OutputChanged, .byte = 0x09, .op = 0});
  record.record({.at = 2 * ms + 5, .kind = TraceKind::OutputChanged, .byte = 0x08, .op = 0});
  record.record({.at = 3 * ms, .kind = TraceKind::AnalogChanged, .op = 4, .count = 0xFFFB});
  record.record({.at = 3 * ms, .kind = TraceKind::ScanBegin});
  EXPECT_EQ(out.str(), "time_ms,address,value\n2.000000,Q0.0,1\n2.000000,Q0.3,1\n2.000005,Q0.0,0\n3.000000,AQW4,-5\n");
}

TEST(OutputWavesTest, AWireForEachPointAndAVectorForEachAnalogWord) {
  std::ostringstream out;
  OutputWaves waves(out, cpu214());
  const std::size_t head = out.str().size();
  for (const char* part : {"$comment s7200: outputs of CPU 214 $end\n", "$timescale 1 ns $end\n", "$var wire 1 q7.7 Q7.7 $end\n",
                           "$var wire 16 a30 AQW30 $end\n", "#0\n$dumpvars\n0q0.0\n"})
    EXPECT_NE(out.str().find(part), std::string::npos) << part;
  EXPECT_EQ(out.str().find("Q8.0"), std::string::npos) << "the CPU has no QB8";
  waves.record({.at = 2 * ms, .kind = TraceKind::OutputChanged, .byte = 0x09, .op = 0});
  waves.record({.at = 2 * ms, .kind = TraceKind::AnalogChanged, .op = 4, .count = 0xFFFB});
  waves.record({.at = 3 * ms, .kind = TraceKind::OutputChanged, .byte = 0x09, .op = 0});
  waves.record({.at = 4 * ms, .kind = TraceKind::OutputChanged, .byte = 0x08, .op = 0});
  EXPECT_EQ(out.str().substr(head), "#2000000\n1q0.0\n1q0.3\nb1111111111111011 a4\n#4000000\n0q0.0\n");
}

struct Watcher final : TraceSink {
  bool instructions = false, stop = false;
  int records = 0, executed = 0;
  void record(const TraceRecord&) override { ++records; }
  bool before(std::uint32_t) override { return !stop; }
  void instruction(const InstructionRecord&) override { ++executed; }
  bool wants_instructions() const override { return instructions; }
};

TEST(FanOutTest, EverySinkHearsWhatItWantsAndOneIsEnoughToStop) {
  Watcher plain, curious;
  curious.instructions = true;
  FanOut all;
  EXPECT_TRUE(all.empty());
  all.add(nullptr);
  EXPECT_TRUE(all.empty());
  all.add(&plain);
  EXPECT_FALSE(all.wants_instructions());
  all.add(&curious);
  EXPECT_TRUE(all.wants_instructions());
  Plc plc("LD SM0.0\nINCW VW0\nMEND\n");
  plc.cpu.set_sink(&all);
  plc.run_scans(2);
  EXPECT_EQ(plain.records, curious.records);
  EXPECT_GT(plain.records, 0);
  EXPECT_EQ(plain.executed, 0);
  EXPECT_EQ(curious.executed, 6);
  curious.stop = true;
  plc.cpu.run(kNever);
  EXPECT_TRUE(plc.cpu.paused());
  EXPECT_EQ(curious.executed, 6);
  all.remove(&curious);
  EXPECT_FALSE(all.wants_instructions());
}

}  // namespace
}  // namespace s7200::test::field_test
