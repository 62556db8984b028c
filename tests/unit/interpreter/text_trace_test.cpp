// What a trace says, record by record.
#include "interpreter/trace/text/text_trace.hpp"

#include <sstream>

#include "tests/support/plc.hpp"

namespace s7200::test::text_trace_test {
namespace {

constexpr std::string_view kProgram = "LD SM0.0\nMOVW VW0, *VD2\nMEND\n";

std::string told(const TraceRecord& record) { return describe(record, *program_of(kProgram)); }

TEST(TextTrace, ReportsTheScanAndTheMode) {
  EXPECT_EQ(told({.kind = TraceKind::ScanBegin, .count = 7}), "scan 7 begins");
  EXPECT_EQ(told({.kind = TraceKind::ModeChange, .code = 1}), "RUN");
  EXPECT_EQ(told({.kind = TraceKind::ModeChange, .code = 0}), "STOP");
}

TEST(TextTrace, ReportsInterruptsFromTheirEventToTheirEnd) {
  EXPECT_EQ(told({.kind = TraceKind::Attach, .event = 10, .routine = 4, .interval = 5 * ms}),
            "ATCH: INT 4 to event 10 (timed interrupt 0, SMB34), every 5 ms");
  EXPECT_EQ(told({.kind = TraceKind::Attach, .event = 0, .routine = 4}), "ATCH: INT 4 to event 0 (rising edge of I0.0)");
  EXPECT_EQ(told({.kind = TraceKind::EventOccurred, .event = 0, .routine = 4}),
            "event 0 (rising edge of I0.0) occurred, for INT 4");
  EXPECT_EQ(told({.at = 30 * us, .kind = TraceKind::ServiceBegin, .event = 0, .routine = 4, .since = 10 * us}),
            "INT 4 begins: event 0 (rising edge of I0.0), waited 20 us");
  EXPECT_EQ(told({.at = 90 * us, .kind = TraceKind::ServiceEnd, .event = 0, .routine = 4, .since = 30 * us}),
            "INT 4 ends: took 60 us");
  EXPECT_EQ(told({.kind = TraceKind::Detach, .event = 0}), "DTCH: event 0 (rising edge of I0.0)");
  EXPECT_EQ(told({.kind = TraceKind::EventLost, .event = 0}), "event 0 (rising edge of I0.0) LOST: its queue is full");
  EXPECT_EQ(told({.kind = TraceKind::EventDropped, .event = 0, .since = 12'000'345}),
            "event 0 (rising edge of I0.0) of      12.000345 ms dropped: detached while it waited");
}

TEST(TextTrace, ReportsThePortCharacterByCharacter) {
  EXPECT_EQ(told({.kind = TraceKind::PortControl, .byte = 9}), "SMB30 = 16#09");
  EXPECT_EQ(told({.kind = TraceKind::Transmit, .count = 3}), "XMT: 3 characters");
  EXPECT_EQ(told({.kind = TraceKind::Transmit, .count = 0}), "XMT: break");
  EXPECT_EQ(told({.kind = TraceKind::TransmitEnd}), "transmit complete");
  EXPECT_EQ(told({.kind = TraceKind::CharacterSent, .byte = 0xA5}), "sent     a5");
  EXPECT_EQ(told({.kind = TraceKind::CharacterReceived, .byte = 0x0F}), "received 0f");
  EXPECT_EQ(told({.kind = TraceKind::CharacterReceived, .byte = 1, .parity_error = true, .framing_error = true}),
            "received 01 parity error framing error");
  EXPECT_EQ(told({.kind = TraceKind::CharacterIgnored, .byte = 2}), "ignored  02: event 8 is not attached");
  EXPECT_EQ(told({.kind = TraceKind::CharacterIgnored, .byte = 2, .code = static_cast<std::uint16_t>(Ignored::NoPower)}),
            "ignored  02: the PLC has no power");
  EXPECT_EQ(told({.kind = TraceKind::CharacterIgnored, .byte = 2, .code = static_cast<std::uint16_t>(Ignored::NoRcvWaits)}),
            "ignored  02: no RCV waits");
}

TEST(TextTrace, WhatPassesAPlcWithoutPowerIsNotWrittenAndWhatIsDoneToItIs) {
  for (const TraceDetail detail : {TraceDetail::Events, TraceDetail::Way}) {
    std::ostringstream out;
    TextTrace trace(out, program_of(kProgram), detail);
    trace.note(5 * ms, "power off");
    trace.record({.at = 6 * ms,
                  .kind = TraceKind::CharacterIgnored,
                  .byte = 2,
                  .code = static_cast<std::uint16_t>(Ignored::NoPower)});
    trace.record({.at = 7 * ms, .kind = TraceKind::CharacterIgnored, .byte = 2});
    EXPECT_EQ(out.str(),
              "# time in ms   what\n      5.000000  power off\n      7.000000  ignored  02: event 8 is not attached\n");
  }
}

TEST(TextTrace, AnInstantIsExactToTheNanosecondAndInItsColumnForAnHour) {
  constexpr std::pair<Time, std::string_view> kInstants[] = {{0, "      0.000000"},
                                                             {1, "      0.000001"},
                                                             {999'999, "      0.999999"},
                                                             {kMillisecond, "      1.000000"},
                                                             {15'193'020, "     15.193020"},
                                                             {3600 * kSecond, "3600000.000000"},
                                                             {12'345'678'901'234, "12345678.901234"},
                                                             {kNever, "9223372036854.775807"}};
  for (const auto& [at, text] : kInstants) EXPECT_EQ(clock_text(at), text);
}

TEST(TextTrace, ReportsWhatRcvDoes) {
  EXPECT_EQ(told({.kind = TraceKind::Receive, .count = 20}), "RCV: at most 20 characters");
  EXPECT_EQ(told({.kind = TraceKind::CharacterDropped, .byte = 2}), "dropped  02: RCV waits for the start of a message");
  EXPECT_EQ(told({.kind = TraceKind::ReceiveEnd, .byte = 0x20, .count = 5}),
            "RCV ends: 5 characters, status 16#20 (end character)");
  EXPECT_EQ(told({.kind = TraceKind::ReceiveEnd, .byte = 0x22, .count = 5}),
            "RCV ends: 5 characters, status 16#22 (end character, as many as can be)");
  EXPECT_EQ(told({.kind = TraceKind::ReceiveEnd, .byte = 0x04}),
            "RCV ends: 0 characters, status 16#04 (the time has passed)");
}

TEST(TextTrace, ReportsOutputsAndErrors) {
  EXPECT_EQ(told({.kind = TraceKind::OutputChanged, .byte = 0b101, .op = 1}), "QB1 = 2#00000101");
  EXPECT_EQ(told({.kind = TraceKind::AnalogChanged, .op = 4, .count = 0xFFFF}), "AQW4 = -1");
  EXPECT_EQ(
      told({.kind = TraceKind::RuntimeError, .code = 0x06, .op = 1}),
      "run-time error 0006 (indirect addressing error: the pointer points outside the memory that it may reach) in line 2: "
      "MOVW    VW0, *VD2");
  EXPECT_EQ(told({.kind = TraceKind::RuntimeError, .code = 0x94, .op = kNoRoutine}),
            "run-time error 0094 (the V address to save is outside the EEPROM) in between two scans");
  EXPECT_EQ(told({.kind = TraceKind::FatalError, .code = 0x03, .op = 0}),
            "FATAL error 0003 (scan watchdog: the scan took longer than 300 ms (CPU 22x of release 2: 500 ms) without WDR) in line 1: LD      SM0.0");
}

TEST(TextTrace, AnInstructionIsShownWithTheValuesOfItsOperands) {
  Plc plc(kProgram);
  std::ostringstream out;
  TextTrace trace(out, program_of(kProgram), TraceDetail::Instructions);
  plc.cpu.set_sink(&trace);
  plc.set("VW0", 0x1234);
  plc.set("VD2", 0x0300'0000);  // points nowhere
  plc.run_until(230 * us);
  const std::string text = out.str();
  EXPECT_NE(text.find("line 1     LD      SM0.0                S0=1 SM0.0=1  10 us\n"), std::string::npos) << text;
  EXPECT_NE(text.find("line 2     MOVW    VW0, *VD2            S0=1 VW0=16#1234 *VD2=?"), std::string::npos) << text;
  EXPECT_NE(text.find("run-time error 0006"), std::string::npos) << text;
}

TEST(TextTrace, ADoubleWordThatTheProgramUsesAsARealIsAlsoShownAsOne) {
  constexpr std::string_view kReals = "LD SM0.0\nMOVR 1.5, VD0\nMOVD VD0, VD4\nMOVR *VD8, AC1\n+R 0.5, AC1\nMEND\n";
  Plc plc(kReals);
  std::ostringstream out;
  TextTrace trace(out, program_of(kReals), TraceDetail::Instructions);
  plc.cpu.set_sink(&trace);
  plc.set("VD8", 0x0800'0000);  // &VB0
  plc.run_until(800 * us);
  const std::string text = out.str();
  for (const char* line : {"S0=1 VD0=16#3FC00000 (1.5)  ", "S0=1 VD0=16#3FC00000 (1.5) VD4=16#3FC00000  ",
                           "S0=1 *VD8=16#3FC00000 (1.5) AC1=16#3FC00000 (1.5)  ", "S0=1 AC1=16#40000000 (2.0)  "})
    EXPECT_NE(text.find(line), std::string::npos) << line << '\n' << text;
}

}  // namespace
}  // namespace s7200::test::text_trace_test
