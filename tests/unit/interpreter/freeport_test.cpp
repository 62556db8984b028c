// Port 0 in Freeport mode: SMB30, event 8 with SMB2 and SM3.0, XMT with event 9 and SM4.5. Times: plc.hpp; at 9600 baud a
// character of ten bits takes 1'041'667 ns.
#include "interpreter/cpu/ports/ppi.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::freeport_test {
namespace {

using enum TraceKind;

constexpr Time kCharacter = 1'041'667;

// LD –210, MOVB –220, ATCH –230, ENI –240, MOVB –250 …, XMT ends at 280.
constexpr std::string_view kSend =
    "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 9\nENI\nMOVB 2, VB100\nMOVB 16#41, VB101\nMOVB 16#42, VB102\nXMT VB100, 0\nMEND\n"
    "INT 0\nINCW VW0\nRETI\n";

TEST(Freeport, XmtSendsFromItsEndAndEvent9ComesAtTheEndOfTheLastStopBit) {
  Plc plc(kSend);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.port.sent, (std::vector<Port::Sent>{{0x41, 280 * us}, {0x42, 280 * us + kCharacter}}));
  EXPECT_EQ(plc.records.times(TransmitEnd), Times{280 * us + 2 * kCharacter});
  EXPECT_EQ(plc.records.times(EventOccurred), Times{280 * us + 2 * kCharacter});
  EXPECT_EQ(plc.value("VW0"), 1);
}

TEST(Freeport, TransmitterIdleIsZeroWhileSendingAndTheReceiverIsOff) {
  Plc plc(kSend);
  plc.run_until(270 * us);
  EXPECT_EQ(plc.value("SM4.5"), 1);
  EXPECT_TRUE(plc.port.receiver);
  plc.run_until(1 * ms);
  EXPECT_EQ(plc.value("SM4.5"), 0);
  EXPECT_FALSE(plc.port.receiver);
  EXPECT_EQ(plc.port.switched_at, 280 * us);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.value("SM4.5"), 1);
  EXPECT_TRUE(plc.port.receiver);
  EXPECT_EQ(plc.port.switched_at, 280 * us + 2 * kCharacter);
}

TEST(Freeport, XmtWhileTransmittingIs0009AndChangesNothing) {
  Plc plc("LD SM0.1\nMOVB 9, SMB30\nMOVB 1, VB100\nXMT VB100, 0\nXMT VB100, 0\nMEND\n");
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.records.errors(), Ints{9});
  EXPECT_EQ(plc.port.sent.size(), 1u);
  EXPECT_EQ(plc.records.of(TransmitEnd).size(), 1u);
}

TEST(Freeport, XmtWithoutFreeportModeIs0009) {
  Plc plc("LD SM0.1\nMOVB 1, VB100\nXMT VB100, 0\nMEND\n");
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.records.errors(), Ints{9});
  EXPECT_TRUE(plc.port.sent.empty());
}

// LD –210, MOVB –220, ATCH –230, ENI –240, XMT –250. 16 bits at 9600 baud: 1'666'667 ns.
TEST(Freeport, XmtOfNoCharactersIsABreakOf16BitsWithEvent9) {
  Plc plc("LD SM0.1\nMOVB 9, SMB30\nATCH 0, 9\nENI\nXMT VB100, 0\nMEND\nINT 0\nINCW VW0\nRETI\n");
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.port.break_bits, 16);
  EXPECT_TRUE(plc.port.sent.empty());
  EXPECT_EQ(plc.records.times(EventOccurred), Times{250 * us + 1'666'667});
  EXPECT_TRUE(plc.records.of(CharacterSent).empty());
}

TEST(Freeport, XmtOf255Characters) {
  Plc plc("LD SM0.1\nMOVB 9, SMB30\nMOVB 255, VB100\nXMT VB100, 0\nMEND\n");
  for (std::uint32_t i = 0; i < 255; ++i) plc.set(fmt::format("VB{}", 101 + i), i);
  plc.run_until(300 * ms);
  ASSERT_EQ(plc.port.sent.size(), 255u);
  for (std::uint32_t i = 0; i < 255; ++i) EXPECT_EQ(plc.port.sent[i].byte, i);
  EXPECT_EQ(plc.records.times(TransmitEnd), Times{240 * us + 255 * kCharacter});
}

TEST(Freeport, ABufferThatRunsPastItsMemoryIs0091) {
  Plc plc("LD SM0.1\nMOVB 9, SMB30\nMOVB 3, VB4093\nXMT VB4093, 0\nMEND\n");
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.records.errors(), Ints{0x91});
  EXPECT_TRUE(plc.port.sent.empty());
}

TEST(Freeport, TheBufferIsReadWhileSending) {
  Plc plc(kSend);
  plc.run_until(1 * ms);
  plc.set("VB101", 0x58);
  plc.set("VB102", 0x59);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.port.sent[0].byte, 0x41);
  EXPECT_EQ(plc.port.sent[1].byte, 0x59);
}

TEST(Freeport, EveryCodeOfTheControlByte) {
  constexpr Parity kParity[] = {Parity::None, Parity::Even, Parity::None, Parity::Odd};
  constexpr std::uint32_t kBaud[] = {38'400, 19'200, 9'600, 4'800, 2'400, 1'200, 600, 300};
  Plc plc("LD SM0.0\nMEND\n");
  plc.run_scans(1);
  plc.set("SMB30", 0xFF);  // so that 0 is a change
  for (std::uint32_t parity = 0; parity < 4; ++parity)
    for (std::uint32_t seven = 0; seven < 2; ++seven)
      for (std::uint32_t baud = 0; baud < 8; ++baud)
        for (std::uint32_t protocol = 0; protocol < 4; ++protocol) {
          plc.set("SMB30", parity << 6 | seven << 5 | baud << 2 | protocol);
          EXPECT_EQ(plc.cpu.state().port[0].active, protocol == 1);
          if (protocol != 1) {
            EXPECT_EQ(plc.port.format, ppi::kFormat);
            continue;
          }
          EXPECT_TRUE(plc.port.receiver);
          EXPECT_EQ(plc.port.format.parity, kParity[parity]);
          EXPECT_EQ(plc.port.format.data_bits, seven ? 7 : 8);
          EXPECT_EQ(plc.port.format.baud, kBaud[baud]);
          EXPECT_EQ(plc.port.format.stop_bits, 1);
        }
}

// At 38400 baud, 8N1: 260'417 ns, with even parity 286'458 ns.
TEST(Freeport, AnInstructionThatWritesTheControlByteSetsThePort) {
  Plc plc("LD SM0.1\nMOVB 16#41, SMB30\nMEND\n");
  plc.run_until(205 * us);
  EXPECT_EQ(plc.port.format, ppi::kFormat);
  plc.run_until(215 * us);
  EXPECT_TRUE(plc.port.receiver);
  EXPECT_EQ(plc.port.format.character_time(), 286'458);
}

TEST(Freeport, SwitchingToFreeportInAnInterruptRoutineIs009A) {
  Plc plc("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nMOVB 9, SMB30\nINCW VW0\nRETI\n");
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.records.errors(), Ints{0x9A});
  EXPECT_EQ(plc.value("SMB30"), 0);
  EXPECT_EQ(plc.port.format, ppi::kFormat);
  EXPECT_EQ(plc.value("VW0"), 1) << "the routine goes on";
}

TEST(Freeport, LeavingFreeportOrChangingTheRateInAnInterruptRoutineIsAllowed) {
  Plc plc(
      "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 0\nATCH 1, 1\nENI\nMEND\nINT 0\nMOVB 5, SMB30\nRETI\nINT 1\nMOVB 0, SMB30\nRETI\n");
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_until(2 * ms);
  EXPECT_EQ(plc.port.format.baud, 19'200u);
  plc.input_at(3 * ms, "I0.0", false);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.port.format, ppi::kFormat);
  EXPECT_TRUE(plc.records.errors().empty());
}

TEST(Freeport, StopEndsTheTransmissionAndGivesThePortBackToPpi) {
  Plc plc("LD SM0.1\nMOVB 9, SMB30\nMOVB 5, VB100\nXMT VB100, 0\nLD I0.0\nSTOP\nMEND\n");
  plc.input_at(2 * ms, "I0.0", true);
  plc.run_until(20 * ms);
  EXPECT_TRUE(plc.stopped());
  EXPECT_FALSE(plc.cpu.state().port[0].active);
  EXPECT_EQ(plc.port.format, ppi::kFormat);
  EXPECT_TRUE(plc.port.receiver);
  EXPECT_EQ(plc.value("SM4.5"), 1);
  EXPECT_LT(plc.port.sent.size(), 5u);
  EXPECT_TRUE(plc.records.of(TransmitEnd).empty());
}

// Both characters arrive during the SQRT, each with its own parity; VB2 and VB4 hold the first, VB1 and VB3 the last.
TEST(Freeport, SMB2AndSM30BelongToTheEntryOfTheirRoutine) {
  Plc plc(
      "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nSQRT VD200, VD204\nENI\nMEND\n"
      "INT 0\nMOVB VB1, VB2\nMOVB SMB2, VB1\nMOVB VB3, VB4\nMOVB SMB3, VB3\nRETI\n");
  plc.character_at(1 * ms, 0x41, true);
  plc.character_at(2 * ms, 0x42, false);
  plc.run_until(4 * ms);
  plc.run_until(7 * ms);
  EXPECT_EQ(plc.value("VB2"), 0x41);
  EXPECT_EQ(plc.value("VB1"), 0x42);
  EXPECT_EQ(plc.value("VB4") & 1, 1);
  EXPECT_EQ(plc.value("VB3") & 1, 0);
}

TEST(Freeport, ACharacterThatNoRoutineWaitsForLeavesSMB2Alone) {
  Plc plc("LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nDTCH 8\nRETI\n");
  plc.character_at(1 * ms, 0x41);
  plc.character_at(3 * ms, 0x42);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.value("SMB2"), 0x41);
  EXPECT_EQ(plc.records.times(CharacterIgnored), Times{3 * ms});
}

TEST(Freeport, WithoutFreeportModeCharactersAreIgnored) {
  Plc plc("LD SM0.1\nATCH 0, 8\nENI\nMEND\nINT 0\nINCW VW0\nRETI\n");
  plc.character_at(1 * ms, 0x41);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.records.times(CharacterIgnored), Times{1 * ms});
}

}  // namespace
}  // namespace s7200::test::freeport_test
