// Port 1 of the CPUs that have two: SMB130, SM4.6, events 24 to 26, error 000B, SMB186 to SMB194. Port 0 knows nothing of
// it.
#include "interpreter/cpu/ports/ppi.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::port1_test {
namespace {

using enum TraceKind;

constexpr Time kCharacter = 1'041'667;

const CpuModel* const kWithTwo[] = {&cpu216(), &cpu226r1(), &cpu226xm(), &cpu224xp(), &cpu226()};

std::string verdict(const std::string& statement, const CpuModel& model) {
  const CheckResult result = check_text("LD SM0.0\n" + statement + "\nMEND\nINT 0\nRETI\n", "t", model, easy_times());
  for (const auto& diagnostic : result.diagnostics)
    if (diagnostic.severity == stl::Severity::Error)
      return diagnostic.message + (diagnostic.hint.empty() ? "" : " | " + diagnostic.hint);
  return "fine";
}

TEST(Port1, XmtSendsOnItAndEvent26ComesAtTheEnd) {
  for (const CpuModel* model : kWithTwo) {
    Plc plc(
        "LD SM0.1\nMOVB 9, SMB130\nATCH 0, 26\nENI\nMOVB 2, VB100\nMOVB 16#41, VB101\nMOVB 16#42, VB102\nXMT VB100, "
        "1\nMEND\n"
        "INT 0\nINCW VW0\nRETI\n",
        *model);
    plc.run_until(1 * ms);
    EXPECT_EQ(plc.value("SMB4") & 0x60, 0x20) << "SM4.6: port 1 is sending, port 0 is not";
    plc.run_until(5 * ms);
    EXPECT_EQ(plc.port1.sent, (std::vector<Port::Sent>{{0x41, 280 * us}, {0x42, 280 * us + kCharacter}}));
    EXPECT_TRUE(plc.port.sent.empty());
    EXPECT_EQ(plc.value("SMB4") & 0x60, 0x60);
    EXPECT_EQ(plc.records.events(EventOccurred), Ints{26});
    EXPECT_EQ(plc.value("VW0"), 1);
  }
}

TEST(Port1, BothPortsSendAtOnceWithTheirOwnRates) {
  Plc plc("LD SM0.1\nMOVB 9, SMB30\nMOVB 5, SMB130\nMOVB 1, VB100\nXMT VB100, 0\nXMT VB100, 1\nXMT VB100, 1\nMEND\n",
          cpu226());
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.port.sent.size(), 1u);
  EXPECT_EQ(plc.port1.sent.size(), 1u);
  EXPECT_EQ(plc.port.format.baud, 9'600u);
  EXPECT_EQ(plc.port1.format.baud, 19'200u);
  EXPECT_EQ(plc.records.errors(), Ints{0x0B});
}

TEST(Port1, ItsCharactersCauseEvent25AndShareSMB2) {
  Plc plc(
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 9, SMB130\nATCH 0, 8\nATCH 1, 25\nENI\nMEND\n"
      "INT 0\nMOVB SMB2, VB0\nRETI\nINT 1\nMOVB SMB2, VB1\nMOVB SMB3, VB2\nRETI\n",
      cpu226());
  plc.received_at({.byte = 7, .end = 2 * ms}, 0);
  plc.received_at({.byte = 8, .parity_error = true, .end = 2 * ms + 1}, 1);
  plc.run_until(4 * ms);
  EXPECT_EQ(plc.records.events(EventOccurred), (Ints{8, 25}));
  EXPECT_EQ(plc.value("VB0"), 7);
  EXPECT_EQ(plc.value("VB1"), 8);
  EXPECT_EQ(plc.value("VB2"), 1);
}

TEST(Port1, RcvTakesItsParametersFromSMB187OnAndCausesEvent24) {
  Plc plc(
      "LD SM0.1\nMOVB 9, SMB130\nMOVB 9, SMB30\nMOVB 16#90, SMB187\nMOVB 2, SMB194\nATCH 0, 24\nENI\nRCV VB100, 1\nMEND\n"
      "INT 0\nINCW VW0\nRETI\n",
      cpu226());
  plc.received_at({.byte = 9, .end = 2 * ms}, 0);
  plc.received_at({.byte = 1, .end = 3 * ms}, 1);
  plc.received_at({.byte = 2, .end = 4 * ms}, 1);
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.value("VB100"), 2);
  EXPECT_EQ(plc.value("VW101"), 0x0102);
  EXPECT_EQ(plc.value("SMB186"), 2);
  EXPECT_EQ(plc.value("SMB86"), 0);
  EXPECT_EQ(plc.value("VW0"), 1);
}

TEST(Port1, StopGivesItBackToPpi) {
  Plc plc("LD SM0.1\nMOVB 9, SMB130\nMOVB 5, VB100\nXMT VB100, 1\nLD I0.0\nSTOP\nMEND\n", cpu226());
  plc.input_at(2 * ms, "I0.0", true);
  plc.run_until(20 * ms);
  EXPECT_EQ(plc.port1.format, s7200::ppi::kFormat);
  EXPECT_EQ(plc.value("SM4.6"), 1);
  EXPECT_LT(plc.port1.sent.size(), 5u);
}

TEST(Port1, SwitchingItToFreeportInAnInterruptRoutineIs009A) {
  Plc plc("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nMOVB 9, SMB130\nRETI\n", cpu226());
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.records.errors(), Ints{0x9A});
  EXPECT_EQ(plc.value("SMB130"), 0);
}

TEST(Port1, ACpuWithOnePortHasNoneOfIt) {
  const std::string needs = " | it needs CPU 216, 224XP, 226, 226r1 or 226XM";
  EXPECT_EQ(verdict("XMT VB0, 1", cpu224()), "port 1 does not exist on CPU 224 | the only port is 0");
  EXPECT_EQ(verdict("RCV VB0, 1", cpu224()), "port 1 does not exist on CPU 224 | the only port is 0");
  for (const CpuModel* model : {&cpu215(), &cpu224(), &cpu222()}) {
    Plc plc("LD SM0.0\nMOVB 9, SMB130\nMOVB 7, SMB187\nMEND\n", *model);
    plc.run_scans(1);
    EXPECT_EQ(plc.value("SMB130"), 9) << "memory, and no more";
    EXPECT_EQ(plc.value("SMB187"), 7);
    EXPECT_FALSE(plc.port1.receiver) << model->name;
  }
  EXPECT_EQ(verdict("ATCH 0, 26", cpu224()), "CPU 224 has no event 26 (port 1: transmit complete)" + needs);
}

TEST(Port1, AProgramThatNeverWritesItsControlByteIsWarned) {
  const auto warnings = [](const std::string& statements) {
    const CheckResult result = check_text(
        "LD SM0.1\n" + statements + "MEND\n" + (statements.find("ATCH") == std::string::npos ? "" : "INT 0\nRETI\n"), "t",
        cpu226(), easy_times());
    std::vector<std::string> messages;
    for (const auto& diagnostic : result.diagnostics) messages.push_back(diagnostic.message);
    return messages;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(warnings("MOVB 9, SMB30\nXMT VB0, 1\nRCV VB0, 1\nENI\nATCH 0, 24\n"),
            (Texts{"XMT sends nothing: no instruction writes SMB130 to put the port in Freeport mode",
                   "RCV receives nothing: no instruction writes SMB130 to put the port in Freeport mode",
                   "event 24 never occurs: no instruction writes SMB130 to put the port in Freeport mode"}));
  EXPECT_EQ(
      warnings("RCV VB0, 1\nMOVB 9, SMB130\nLDB<> SMB186, 0\nRCV VB0, 1\n"),
      Texts{"RCV receives nothing in the first scan: SMB130, which puts the port in Freeport mode, is written after it"});
  EXPECT_TRUE(warnings("MOVB 9, SMB130\nXMT VB0, 1\n").empty());
}

TEST(Port1, ATraceNamesIt) {
  const auto program = program_of("MEND\n", cpu226());
  const auto told = [&](TraceRecord record) {
    record.port = 1;
    return describe(record, *program);
  };
  EXPECT_EQ(told({.kind = PortControl, .byte = 9}), "port 1: SMB130 = 16#09");
  EXPECT_EQ(told({.kind = Transmit, .count = 3}), "port 1: XMT: 3 characters");
  EXPECT_EQ(told({.kind = CharacterSent, .byte = 0xA5}), "port 1: sent     a5");
  EXPECT_EQ(told({.kind = CharacterIgnored, .byte = 2}), "port 1: ignored  02: event 25 is not attached");
}

}  // namespace
}  // namespace s7200::test::port1_test
