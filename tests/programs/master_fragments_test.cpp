// The fragments of a Modbus master that were published with its address rules: they parse, and the CRC loop runs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "serial_sim/modbus/crc.hpp"
#include "tests/support/plc.hpp"
#include "tests/support/source_path.hpp"

namespace s7200::test::master_fragments_test {
namespace {

/// Lines `first` to `last` of the document, counted from 1; empty without the document.
std::string fragment(int first, int last) {
  std::ifstream document(source_path("../shared/seeds/modbus_addresses_and_master_fragments_zh.txt"));
  std::string text, line;
  for (int number = 1; std::getline(document, line); ++number)
    if (number >= first && number <= last) text += line + "\n";
  return text;
}

TEST(MasterFragments, TheBroadcastRuleRefusesReadsAndMarksWrites) {
  const std::string rule = fragment(59, 65);
  if (rule.empty()) GTEST_SKIP() << "the document is not there";
  for (const auto& [slave, function, refused, marked] :
       {std::array{0, 3, 4, 0}, {0, 1, 4, 0}, {0, 6, 0, 1}, {0, 16, 0, 1}, {1, 3, 0, 0}, {1, 6, 0, 0}}) {
    Plc plc(fmt::format("LD SM0.0\nMOVB {}, LB1\nMOVB {}, VB255\nMOVB 0, AC0\n{}LBL 250\nLD SM0.0\nMOVB AC0, VB0\nMEND\n",
                        slave, function, rule),
            cpu224());
    plc.run_scans(1);
    EXPECT_EQ(plc.value("VB0"), refused) << slave << ' ' << function;
    EXPECT_EQ(plc.value("V250.1"), marked) << slave << ' ' << function;
  }
}

TEST(MasterFragments, TheCrcLoopAgreesWithModbus) {
  const std::string loop = fragment(66, 86);
  if (loop.empty()) GTEST_SKIP() << "the document is not there";
  std::mt19937 draw(7200);
  for (std::size_t length = 0; length < 40; ++length) {
    Bytes message(length);
    for (std::uint8_t& byte : message) byte = static_cast<std::uint8_t>(draw());
    Plc plc(loop + "MEND\n", cpu224());
    plc.set("VB0", static_cast<std::uint32_t>(length));
    for (std::size_t i = 0; i < length; ++i) plc.set(fmt::format("VB{}", i + 1), message[i]);
    plc.run_scans(1);
    const std::uint16_t crc = modbus::crc16(message);
    const auto low_byte_first = static_cast<std::uint16_t>(crc << 8 | crc >> 8);
    EXPECT_EQ(plc.value(fmt::format("VW{}", length + 1)) & 0xFFFF, low_byte_first) << length;
    EXPECT_EQ(plc.value("LW0") & 0xFFFF, low_byte_first) << length;
  }
}

}  // namespace
}  // namespace s7200::test::master_fragments_test
