// The two formats of captures, byte by byte.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "serial_sim/record/pcap_capture.hpp"
#include "serial_sim/record/vcd_capture.hpp"

namespace s7200::serial::capture_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};

constexpr std::string_view kVcdHeader =
    "$comment s7200: rx is what the others drive, with what disturbs the line; tx is what the PLC drives; line is the level "
    "at its port, in a collision too; 1 is mark, the idle level $end\n"
    "$timescale 1 ns $end\n"
    "$scope module line $end\n"
    "$var wire 1 r rx $end\n"
    "$var wire 1 t tx $end\n"
    "$var wire 1 l line $end\n"
    "$upscope $end\n"
    "$enddefinitions $end\n"
    "#0\n"
    "$dumpvars\n"
    "1r\n"
    "1t\n"
    "1l\n"
    "$end\n";

TEST(VcdCapture, EdgesOfOneInstantShareATime) {
  std::ostringstream out;
  VcdCapture capture(out);
  capture.edge(Wire::Rx, 50, false, 1);
  capture.edge(Wire::Tx, 50, false, 0);
  capture.edge(Wire::Line, 50, false, 0);
  capture.settled(60, k8E1);
  capture.edge(Wire::Rx, 104167, true, Line::kNobody);
  capture.settled(200000, k8E1);
  capture.finish();
  EXPECT_EQ(out.str(), std::string(kVcdHeader) + "#50\n0r\n0t\n0l\n#104167\n1r\n#200000\n");
}

TEST(VcdCapture, AQuietLineIsACaptureToo) {
  std::ostringstream out;
  VcdCapture capture(out);
  capture.settled(kSecond, k8E1);
  capture.finish();
  EXPECT_EQ(out.str(), std::string(kVcdHeader) + "#1000000000\n");
}

TEST(VcdCapture, AnEdgeAtTheVeryFirstInstantNeedsNoTimeOfItsOwn) {
  std::ostringstream out;
  VcdCapture capture(out);
  capture.edge(Wire::Rx, 0, false, 1);
  EXPECT_EQ(out.str(), std::string(kVcdHeader) + "0r\n");
}

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) text += "0123456789abcdef"[byte >> 4 & 15], text += "0123456789abcdef"[byte & 15];
  return text;
}

constexpr std::string_view kPcapHeader =
    "4d3cb2a1"
    "02000400"
    "00000000"
    "00000000"
    "201c0000"
    "93000000";

TEST(PcapWriter, ARecordIsTimeLengthsAndBytes) {
  std::ostringstream out;
  PcapWriter writer(out);
  writer.packet(2 * kSecond + 15'967'000, std::array<std::uint8_t, 3>{0x01, 0x83, 0x02});
  EXPECT_EQ(hex(out.str()), std::string(kPcapHeader) +
                                "02000000"
                                "18a3f300"
                                "03000000"
                                "03000000"
                                "018302");
}

TEST(PcapWriter, OfALongPacketTheBeginningIsKept) {
  std::ostringstream out;
  PcapWriter writer(out);
  const std::vector<std::uint8_t> bytes(PcapWriter::kLongestPacket + 1, 0x55);
  writer.packet(0, bytes);
  EXPECT_EQ(out.str().size(), 24 + 16 + PcapWriter::kLongestPacket);
  EXPECT_EQ(hex(out.str().substr(32, 8)),
            "201c0000"
            "211c0000");
}

TEST(PcapCapture, AQuietLineIsACaptureToo) {
  std::ostringstream out;
  PcapCapture capture(out);
  capture.settled(kSecond, k8E1);
  capture.finish();
  EXPECT_EQ(hex(out.str()), kPcapHeader);
}

}  // namespace
}  // namespace s7200::serial::capture_test
