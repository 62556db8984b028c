// stl_programs/modbus_slave.stl against the specification: Modbus Application Protocol V1.1b3, Modbus over Serial Line
// V1.02.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "interpreter/stl/printer.hpp"
#include "tests/support/slave_bench.hpp"
#include "tests/support/tip41.hpp"

namespace s7200::test::modbus_slave_test {
namespace {

class ModbusSlave : public ::testing::Test {
 protected:
  void SetUp() override { bench.start(); }
  void TearDown() override {
    EXPECT_EQ(bench.state().error_count, 0U) << "run-time errors";
    EXPECT_EQ(bench.state().mode, Mode::Run);
  }
  void set_inputs() {
    for (std::uint32_t i = 0; i < 8; ++i) bench.set_input(i, static_cast<std::uint8_t>(0x11 * (i + 1)));
    bench.run_for(5 * kMillisecond);
  }

  SlaveBench bench{slave_text()};
};

// --- the functions ---

TEST_F(ModbusSlave, ReadsCoilsFromAnyBitOn) {
  bench.set_qb(0, 0b1010'0000);
  bench.set_qb(1, 0b0000'0110);
  EXPECT_EQ(bench.ask("010100000008"), "01 01 01 a0");
  EXPECT_EQ(bench.ask("010100050006"), "01 01 01 35");
  bench.set_qb(7, 0x80);
  EXPECT_EQ(bench.ask("0101003f0001"), "01 01 01 01");
  EXPECT_EQ(bench.ask("010100000040"), "01 01 08 a0 06 00 00 00 00 00 80");
}

TEST_F(ModbusSlave, ReadsInputsFromAnyBitOn) {
  set_inputs();
  EXPECT_EQ(bench.ask("010200000040"), "01 02 08 11 22 33 44 55 66 77 88");
  EXPECT_EQ(bench.ask("010200040010"), "01 02 02 21 32");
}

TEST_F(ModbusSlave, FillsUpTheLastByteOfBitsWithZeros) {
  for (std::uint32_t i = 0; i < 8; ++i) bench.set_qb(i, 0xFF);
  for (unsigned count = 1; count <= 64; ++count)
    for (const unsigned first : {0U, 3U, 64U - count}) {
      if (first + count > 64) continue;
      const Bytes answer =
          bench.ask(modbus::read_coils(static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(count)));
      ASSERT_EQ(answer.size(), 3 + (count + 7) / 8);
      for (unsigned bit = 0; bit < 8 * answer[2]; ++bit)
        ASSERT_EQ(answer[3 + bit / 8] >> bit % 8 & 1, bit < count ? 1 : 0) << count << " from " << first << ", bit " << bit;
    }
}

TEST_F(ModbusSlave, ReadsHoldingRegistersUpTo125AtATime) {
  for (unsigned i = 0; i < 1000; ++i) bench.set_vw(2 * i, static_cast<std::uint16_t>(i * 7));
  for (const auto& [first, count] : {std::pair{0, 125}, {875, 125}, {999, 1}, {0, 1}, {500, 2}}) {
    const Bytes answer =
        bench.ask(modbus::read_holding_registers(static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(count)));
    ASSERT_EQ(answer.size(), 3U + 2U * static_cast<unsigned>(count));
    EXPECT_EQ(answer[2], 2 * count);
    for (int i = 0; i < count; ++i)
      ASSERT_EQ(load16(&answer[static_cast<std::size_t>(3 + 2 * i)]), static_cast<std::uint16_t>((first + i) * 7));
  }
}

TEST_F(ModbusSlave, ReadsInputRegistersWhereThePointerLeads) {
  bench.set_vw(2000, 0x1234);
  bench.set_vw(2030, 0x5678);
  EXPECT_EQ(bench.ask("010400000001"), "01 04 02 12 34");
  EXPECT_EQ(bench.ask("0104000f0001"), "01 04 02 56 78");
  EXPECT_EQ(bench.ask("010400100001"), "01 84 02");
  bench.set_vw(3298, 2030);
  EXPECT_EQ(bench.ask("010400000001"), "01 04 02 56 78");
}

TEST_F(ModbusSlave, WritesOneCoil) {
  bench.set_qb(1, 0b0000'1111);
  EXPECT_EQ(bench.ask("0105000cff00"), "01 05 00 0c ff 00");
  EXPECT_EQ(bench.qb(1), 0b0001'1111);
  EXPECT_EQ(bench.ask("010500080000"), "01 05 00 08 00 00");
  EXPECT_EQ(bench.qb(1), 0b0001'1110);
  EXPECT_EQ(bench.ask("0105003fff00"), "01 05 00 3f ff 00");
  EXPECT_EQ(bench.qb(7), 0x80);
}

TEST_F(ModbusSlave, WritesOneRegister) {
  EXPECT_EQ(bench.ask("010603e7beef"), "01 06 03 e7 be ef");
  EXPECT_EQ(bench.vw(1998), 0xBEEF);
}

TEST_F(ModbusSlave, WritesCoilsFromAnyBitOnAndLeavesTheOthers) {
  for (unsigned first = 0; first < 64; first += 3)
    for (unsigned count = 1; first + count <= 64; count += 5)
      for (const bool on : {true, false}) {
        for (std::uint32_t i = 0; i < 8; ++i) bench.set_qb(i, on ? 0 : 0xFF);
        ASSERT_FALSE(
            bench.ask(modbus::write_coils(static_cast<std::uint16_t>(first), std::vector<bool>(count, on))).empty());
        for (unsigned coil = 0; coil < 64; ++coil) {
          const bool inside = coil >= first && coil < first + count;
          ASSERT_EQ((bench.qb(coil / 8) >> coil % 8 & 1) != 0, inside == on)
              << count << " from " << first << ", coil " << coil;
        }
      }
}

TEST_F(ModbusSlave, WritesUpTo123Registers) {
  std::vector<std::uint16_t> values(123);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(0xA000 + i);
  EXPECT_EQ(serial::to_hex(bench.ask(modbus::write_registers(877, values))), "01 10 03 6d 00 7b");
  for (std::uint32_t i = 0; i < 123; ++i) ASSERT_EQ(bench.vw(2 * (877 + i)), 0xA000 + i);
  EXPECT_EQ(bench.vw(2 * 876), 0);
  EXPECT_EQ(bench.vw(2000), 0);
}

// --- exceptions, in the order of the specification's state diagrams ---

TEST_F(ModbusSlave, AnswersOtherFunctionsWithException1WhateverTheirLength) {
  for (const char* function : {"00", "07", "08", "0b", "0c", "0e", "11", "14", "15", "16", "17", "18", "2b", "7f"}) {
    const Bytes code = serial::bytes_of(serial::parse_hex_frame(function).frame);
    const Bytes refused{1, static_cast<std::uint8_t>(code[0] | 0x80), 1};
    EXPECT_EQ(bench.ask(std::string("01") + function), serial::to_hex(refused));
    EXPECT_EQ(bench.ask(std::string("01") + function + "00000001"), serial::to_hex(refused));
  }
}

TEST_F(ModbusSlave, AnIllegalQuantityIsException3AndComesBeforeTheAddress) {
  for (const char* quantity : {"0000", "07d1", "8000", "ffff"}) {
    EXPECT_EQ(bench.ask(std::string("01010000") + quantity), "01 81 03");
    EXPECT_EQ(bench.ask(std::string("0102ffff") + quantity), "01 82 03");
  }
  for (const char* quantity : {"0000", "007e", "8000", "8001", "ffff"}) {
    EXPECT_EQ(bench.ask(std::string("01030000") + quantity), "01 83 03");
    EXPECT_EQ(bench.ask(std::string("0104ffff") + quantity), "01 84 03");
  }
  EXPECT_EQ(bench.ask("010f0000000000"), "01 8f 03");
  EXPECT_EQ(bench.ask("010f000007b1f600"), "01 8f 03");
  EXPECT_EQ(bench.ask("01100000000000"), "01 90 03");
  Bytes coils_1969{15, 0, 0, 0x07, 0xB1, 247};
  coils_1969.resize(6 + 247);
  EXPECT_EQ(serial::to_hex(bench.ask(coils_1969)), "01 8f 03");
  EXPECT_EQ(bench.ask("01100000007cf80001"), "01 90 03");
}

TEST_F(ModbusSlave, FunctionFiveTakesOnAndOffOnly) {
  for (const char* value : {"0001", "00ff", "ff01", "0100", "ffff", "fe00"}) {
    EXPECT_EQ(bench.ask(std::string("01050000") + value), "01 85 03");
    EXPECT_EQ(bench.ask(std::string("0105ffff") + value), "01 85 03");
  }
  EXPECT_EQ(bench.qb(0), 0);
}

TEST_F(ModbusSlave, AByteCountThatDoesNotFitIsException3) {
  EXPECT_EQ(bench.ask("010f0000000802ff"), "01 8f 03");
  EXPECT_EQ(bench.ask("010f0000000902ff"), "01 8f 03") << "one byte missing";
  EXPECT_EQ(bench.ask("010f0000000801ffff"), "01 8f 03") << "one byte too many";
  EXPECT_EQ(bench.ask("01100000000103cafe"), "01 90 03");
  EXPECT_EQ(bench.ask("01100000000204cafe"), "01 90 03");
  EXPECT_EQ(bench.ask("01100000000102cafebabe"), "01 90 03");
  EXPECT_EQ(bench.ask("01100000008000"), "01 90 03") << "twice 128 is 0 in a byte";
  EXPECT_EQ(bench.qb(0), 0);
  EXPECT_EQ(bench.vw(0), 0);
}

TEST_F(ModbusSlave, ALengthThatDoesNotFitTheFunctionIsException3) {
  for (const char* function : {"01", "02", "03", "04", "05", "06", "0f", "10"}) {
    const std::string head = std::string("01") + function;
    const Bytes code = serial::bytes_of(serial::parse_hex_frame(function).frame);
    const Bytes refused{1, static_cast<std::uint8_t>(code[0] | 0x80), 3};
    for (const char* rest : {"", "00", "0000", "000000", "0000000000", "000000000000"})
      EXPECT_EQ(bench.ask(head + rest), serial::to_hex(refused)) << head << rest;
  }
}

TEST_F(ModbusSlave, AnAddressThatDoesNotExistIsException2) {
  for (const char* function : {"01", "02"}) {
    const std::string head = std::string("01") + function, refused = std::string("01 8") + function[1] + " 02";
    for (const char* what : {"00400001", "003f0002", "00000041", "7fff0001", "80000001", "ffff0001", "ffc00040", "000007d0"})
      EXPECT_EQ(bench.ask(head + what), refused) << what;
  }
  for (const char* what : {"03e80001", "03e70002", "036c007d", "7fff0001", "80000001", "ffff0001", "ff83007d"})
    EXPECT_EQ(bench.ask(std::string("0103") + what), "01 83 02") << what;
  for (const char* coil : {"0040", "7fff", "8000", "ffff"})
    EXPECT_EQ(bench.ask(std::string("0105") + coil + "ff00"), "01 85 02") << coil;
  for (const char* number : {"03e8", "7fff", "8000", "ffff"})
    EXPECT_EQ(bench.ask(std::string("0106") + number + "0001"), "01 86 02") << number;
  EXPECT_EQ(bench.ask("010f0040000101ff"), "01 8f 02");
  EXPECT_EQ(bench.ask("010f003f000201ff"), "01 8f 02");
  EXPECT_EQ(bench.ask("010fffff000101ff"), "01 8f 02");
  EXPECT_EQ(bench.ask("011003e7000204cafebabe"), "01 90 02");
  EXPECT_EQ(bench.ask("0110ffff000102cafe"), "01 90 02");
  EXPECT_EQ(serial::to_hex(bench.ask(modbus::write_coils(0, std::vector<bool>(1968, true)))), "01 8f 02");
}

TEST_F(ModbusSlave, TheSettingsDecideWhatExists) {
  bench.set_vw(3290, 11);
  bench.set_vw(3292, 6);
  EXPECT_EQ(bench.ask("010100000009"), "01 01 02 00 00");
  EXPECT_EQ(bench.ask("01010000000b"), "01 81 02");
  EXPECT_EQ(bench.ask("01050009ff00"), "01 05 00 09 ff 00");
  EXPECT_EQ(bench.ask("0105000aff00"), "01 85 02");
  EXPECT_EQ(bench.ask("010300040001"), "01 03 02 00 00");
  EXPECT_EQ(bench.ask("010300050001"), "01 83 02");
  bench.set_vw(3290, 1001);
  EXPECT_EQ(bench.ask("010100400001"), "01 81 02") << "never more than 64 points";
}

// --- frames ---

TEST_F(ModbusSlave, ExecutesABroadcastAndDoesNotAnswer) {
  EXPECT_EQ(bench.ask("0005000aff00"), "-");
  EXPECT_EQ(bench.qb(1), 0x04);
  EXPECT_EQ(bench.ask("0006000a1234"), "-");
  EXPECT_EQ(bench.vw(20), 0x1234);
  EXPECT_EQ(bench.ask("000f0000000901ff01"), "-") << "refused, silently";
  EXPECT_EQ(bench.qb(0), 0);
  EXPECT_EQ(bench.ask("000f000000080133"), "-");
  EXPECT_EQ(bench.qb(0), 0x33);
  EXPECT_EQ(bench.ask("001000000001020304"), "-");
  EXPECT_EQ(bench.vw(0), 0x0304);
  EXPECT_EQ(bench.ask("00030000000a"), "-");
  EXPECT_EQ(bench.ask("0007"), "-");
  EXPECT_EQ(bench.ask("010300000001"), "01 03 02 03 04");
}

TEST_F(ModbusSlave, DropsDisturbedAndForeignFramesAndAnswersTheNextOne) {
  Bytes overlong(300, 0x55);
  overlong[0] = 1;
  const std::vector<std::string> frames{"0103000a0001a409",
                                        "0103p000a0001a408",
                                        "01p03000a0001a408",
                                        "0103000a0001a408p",
                                        "0203000a0001a43b",
                                        "01",
                                        "00",
                                        "0103",
                                        "017e80",
                                        serial::to_hex(overlong)};
  for (const std::string& frame : frames) {
    EXPECT_EQ(bench.ask_raw(frame), "-") << frame;
    EXPECT_EQ(bench.ask("0106000a0001"), "01 06 00 0a 00 01") << "after " << frame;
  }
}

TEST_F(ModbusSlave, TakesACharacterWhoseStopBitIsAtSpaceBecauseTheCpuShowsItParityOnly) {
  bench.simulation().inject(serial::parse_fault("framing:character=8").fault);
  EXPECT_EQ(bench.ask("0103000a0001"), "01 03 02 00 00");
  EXPECT_EQ(bench.simulation().faults().state().injected.at(0).count, 1U);
}

TEST_F(ModbusSlave, TakesNothingInsideAFrameForTheBeginningOfOne) {
  const std::string good = "010300000001840a";
  EXPECT_EQ(bench.ask_raw(good), "01 03 02 00 00 b8 44");
  for (std::string foreign = "02"; foreign.size() < 40; foreign += "55")
    EXPECT_EQ(bench.ask_raw(foreign + good), "-") << "after " << foreign;
  EXPECT_EQ(bench.ask_raw("55p" + good), "-") << "after a disturbed character";
  EXPECT_EQ(bench.ask_raw("0100p" + good.substr(2)), "-") << "around a disturbed character";
  EXPECT_EQ(bench.ask_raw(good + "00p"), "-") << "before a disturbed character";
  EXPECT_EQ(bench.ask_raw("02"), "-");
  EXPECT_EQ(bench.ask_raw(good), "01 03 02 00 00 b8 44") << "after a lone character of another station";
}

TEST_F(ModbusSlave, Receives256CharactersAndNotOneMore) {
  Bytes pdu(253, 0xA5);
  pdu[0] = 0x65;
  EXPECT_EQ(serial::to_hex(bench.ask(pdu)), "01 e5 01");
  pdu.push_back(0);
  EXPECT_TRUE(bench.ask(pdu).empty());
  EXPECT_EQ(bench.ask("010300000001"), "01 03 02 00 00");
}

TEST_F(ModbusSlave, APauseInsideARequestEndsIt) {
  const serial::Frame request = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 1)));
  EXPECT_FALSE(bench.send({.frame = request, .gap = bench.format().character_time()}).timed_out);
  bench.run_for(50 * kMillisecond);
  EXPECT_TRUE(bench.send({.frame = request, .timeout = 100 * kMillisecond, .gap = 10 * kMillisecond}).timed_out);
}

TEST_F(ModbusSlave, HearsARequestThatFollowsItsAnswerAfterTheSilenceOfTheStandard) {
  const serial::Frame request = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 1)));
  for (int i = 0; i < 20; ++i)  // an exchange is over 3.5 characters after the answer
    EXPECT_FALSE(bench.send({.frame = request, .timeout = 100 * kMillisecond}).timed_out);
}

TEST_F(ModbusSlave, AnswersAfterTheQuietTimeOnly) {
  bench.ask("010300000001");
  EXPECT_GT(*bench.last().latency(), 6 * kMillisecond);
  EXPECT_LT(*bench.last().latency(), 20 * kMillisecond);
  bench.ask("01030000007d");
  EXPECT_LT(*bench.last().latency(), 100 * kMillisecond);
}

TEST_F(ModbusSlave, HasAnyStationAddress) {
  bench.set_vb(4095, 247);
  EXPECT_EQ(bench.ask("f7030000000a").substr(0, 8), "f7 03 14");
  EXPECT_EQ(bench.ask("01030000000a"), "-");
}

// --- random exchanges against a model of the memory ---

/// What the specification makes of a request.
struct Model {
  std::vector<bool> coils = std::vector<bool>(64), inputs = std::vector<bool>(64);
  std::vector<std::uint16_t> holding = std::vector<std::uint16_t>(1000), input = std::vector<std::uint16_t>(16);

  static Bytes exception(std::uint8_t function, std::uint8_t code) {
    return {1, static_cast<std::uint8_t>(function | 0x80), code};
  }
  static bool inside(unsigned first, unsigned count, std::size_t size) { return first + count <= size; }

  static Bytes read_bits(const Bytes& pdu, const std::vector<bool>& bits) {
    const unsigned first = load16(&pdu[1]), count = load16(&pdu[3]);
    if (count < 1 || count > 2000) return exception(pdu[0], 3);
    if (!inside(first, count, bits.size())) return exception(pdu[0], 2);
    Bytes answer{1, pdu[0], static_cast<std::uint8_t>((count + 7) / 8)};
    answer.resize(3U + answer[2]);
    for (unsigned i = 0; i < count; ++i)
      if (bits[first + i]) answer[3 + i / 8] = static_cast<std::uint8_t>(answer[3 + i / 8] | 1U << i % 8);
    return answer;
  }
  static Bytes read_words(const Bytes& pdu, const std::vector<std::uint16_t>& words) {
    const unsigned first = load16(&pdu[1]), count = load16(&pdu[3]);
    if (count < 1 || count > 125) return exception(pdu[0], 3);
    if (!inside(first, count, words.size())) return exception(pdu[0], 2);
    Bytes answer{1, pdu[0], static_cast<std::uint8_t>(2 * count)};
    for (unsigned i = 0; i < count; ++i) {
      answer.push_back(static_cast<std::uint8_t>(words[first + i] >> 8));
      answer.push_back(static_cast<std::uint8_t>(words[first + i] & 0xFF));
    }
    return answer;
  }
  static Bytes head(const Bytes& pdu) { return {1, pdu[0], pdu[1], pdu[2], pdu[3], pdu[4]}; }

  Bytes write_coil(const Bytes& pdu) {
    const unsigned coil = load16(&pdu[1]), value = load16(&pdu[3]);
    if (value != 0 && value != 0xFF00) return exception(pdu[0], 3);
    if (!inside(coil, 1, coils.size())) return exception(pdu[0], 2);
    coils[coil] = value != 0;
    return head(pdu);
  }
  Bytes write_register(const Bytes& pdu) {
    const unsigned number = load16(&pdu[1]);
    if (!inside(number, 1, holding.size())) return exception(pdu[0], 2);
    holding[number] = load16(&pdu[3]);
    return head(pdu);
  }
  Bytes write_coils(const Bytes& pdu) {
    const unsigned first = load16(&pdu[1]), count = load16(&pdu[3]);
    if (count < 1 || count > 1968 || pdu[5] != (count + 7) / 8 || pdu.size() != 6U + pdu[5]) return exception(pdu[0], 3);
    if (!inside(first, count, coils.size())) return exception(pdu[0], 2);
    for (unsigned i = 0; i < count; ++i) coils[first + i] = (pdu[6 + i / 8] >> i % 8 & 1) != 0;
    return head(pdu);
  }
  Bytes write_registers(const Bytes& pdu) {
    const unsigned first = load16(&pdu[1]), count = load16(&pdu[3]);
    if (count < 1 || count > 123 || pdu[5] != 2 * count || pdu.size() != 6U + pdu[5]) return exception(pdu[0], 3);
    if (!inside(first, count, holding.size())) return exception(pdu[0], 2);
    for (unsigned i = 0; i < count; ++i) holding[first + i] = load16(&pdu[6 + 2 * i]);
    return head(pdu);
  }

  /// `pdu` has at least the fields of its function.
  Bytes answer(const Bytes& pdu) {
    switch (pdu[0]) {
      case 1:
        return read_bits(pdu, coils);
      case 2:
        return read_bits(pdu, inputs);
      case 3:
        return read_words(pdu, holding);
      case 4:
        return read_words(pdu, input);
      case 5:
        return write_coil(pdu);
      case 6:
        return write_register(pdu);
      case 15:
        return write_coils(pdu);
      case 16:
        return write_registers(pdu);
      default:
        return exception(pdu[0], 1);
    }
  }
};

/// Requests that are mostly fine, often at a limit, sometimes wrong.
class RequestMaker {
 public:
  explicit RequestMaker(unsigned seed) : random_(seed) {}

  Bytes next() {
    switch (below(9)) {
      case 0:
        return modbus::read_coils(first(64), count(64));
      case 1:
        return modbus::read_inputs(first(64), count(64));
      case 2:
        return modbus::read_holding_registers(first(1000), count(125));
      case 3:
        return modbus::read_input_registers(first(16), count(16));
      case 4:
        return write_coil();
      case 5:
        return modbus::write_register(first(1000), word());
      case 6:
        return damaged(modbus::write_coils(first(64), coils(count(20))));
      case 7:
        return damaged(modbus::write_registers(first(1000), words(std::min<std::uint16_t>(count(123), 123))));
      default:
        return {static_cast<std::uint8_t>(17 + below(100)), 0, 0, 0, 0};
    }
  }
  unsigned below(unsigned limit) { return static_cast<unsigned>(random_() % limit); }
  std::uint16_t word() { return static_cast<std::uint16_t>(random_()); }

 private:
  std::uint16_t first(unsigned size) {
    const unsigned kind = below(10);
    return static_cast<std::uint16_t>(kind == 0 ? word() : kind == 1 ? size - 1 + below(3) : below(size));
  }
  std::uint16_t count(unsigned usual) {
    const unsigned kind = below(12);
    return static_cast<std::uint16_t>(kind == 0 ? below(3) : kind == 1 ? usual - 1 + below(3) : 1 + below(1 + usual / 4));
  }
  Bytes write_coil() {
    Bytes pdu = modbus::write_coil(first(64), below(2) != 0);
    if (below(8) == 0) pdu[4] = static_cast<std::uint8_t>(word());
    return pdu;
  }
  std::vector<bool> coils(std::size_t n) {
    std::vector<bool> on(n);
    for (std::size_t i = 0; i < n; ++i) on[i] = below(2) != 0;
    return on;
  }
  std::vector<std::uint16_t> words(std::size_t n) {
    std::vector<std::uint16_t> values(n);
    for (std::uint16_t& value : values) value = word();
    return values;
  }
  Bytes damaged(Bytes pdu) {
    const unsigned kind = below(20);
    if (kind == 0) pdu.push_back(0);
    if (kind == 1 && pdu.size() > 6) pdu.pop_back();
    if (kind == 2) pdu[5] = static_cast<std::uint8_t>(word());
    return pdu;
  }

  std::mt19937 random_;
};

TEST_F(ModbusSlave, AnswersFiveThousandRandomRequestsAsTheSpecificationSays) {
  Model model;
  RequestMaker make(20240607);
  for (std::size_t i = 0; i < 16; ++i) {
    model.input[i] = make.word();
    bench.set_vw(static_cast<std::uint32_t>(2000 + 2 * i), model.input[i]);
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const auto value = static_cast<std::uint8_t>(make.word());
    bench.set_input(i, value);
    for (unsigned bit = 0; bit < 8; ++bit) model.inputs[8 * i + bit] = (value >> bit & 1) != 0;
  }
  bench.run_for(5 * kMillisecond);
  for (int i = 0; i < 5000; ++i) {
    const Bytes pdu = make.next();
    const bool broadcast = make.below(25) == 0;
    const Bytes expected = model.answer(pdu);
    ASSERT_EQ(bench.ask(pdu, broadcast ? 0 : 1), broadcast ? Bytes{} : expected) << i << ": " << serial::to_hex(pdu);
  }
  for (std::uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(bench.vw(2 * i), model.holding[i]) << i;
  for (std::uint32_t i = 0; i < 64; ++i) ASSERT_EQ((bench.qb(i / 8) >> i % 8 & 1) != 0, model.coils[i]) << i;
}

// --- time ---

TEST(ModbusSlaveTime, FirstScanIsShort) {
  SlaveBench bench(slave_text());
  bench.start();
  EXPECT_LT(bench.state().longest_scan, 60 * kMillisecond);
}

TEST(ModbusSlaveTime, WorksAtEveryRate) {
  std::vector<RateSetting> rates(kRateSettings.begin(), kRateSettings.end());
  rates.push_back(k38400);
  const std::vector<std::uint16_t> values(123, 0x5AA5);
  for (const RateSetting& rate : rates) {
    SlaveBench bench(at_rate(slave_text(), rate));
    CountingSink sink;
    bench.cpu().set_sink(&sink);
    bench.start();
    EXPECT_EQ(bench.format().baud, rate.baud);
    EXPECT_EQ(bench.ask("0106000a1234"), "01 06 00 0a 12 34") << rate.baud;
    EXPECT_EQ(bench.ask("0103000a0001"), "01 03 02 12 34") << rate.baud;
    EXPECT_EQ(serial::to_hex(bench.ask(modbus::write_registers(0, values))), "01 10 00 00 00 7b") << rate.baud;
    EXPECT_EQ(bench.ask(modbus::read_holding_registers(0, 125)).size(), 253U) << rate.baud;
    EXPECT_EQ(sink.of(TraceKind::EventLost), 0U) << rate.baud;
    EXPECT_EQ(bench.state().error_count, 0U);
  }
}

/// The slave in a program whose own part of the scan takes `loops` × 150 us.
std::string with_long_scan(int loops) {
  return changed(slave_text(), "// Your own program stands here.",
                 "LD SM0.0\nFOR VW2100, 1, " + std::to_string(loops) + "\nNEXT\nWDR\nFOR VW2100, 1, " +
                     std::to_string(loops) + "\nNEXT\n");
}

TEST(ModbusSlaveTime, AnswersWithinALongScanBecauseItResetsTheWatchdog) {
  SlaveBench bench(with_long_scan(1600));
  bench.start();
  EXPECT_EQ(bench.ask(modbus::read_holding_registers(0, 125)).size(), 253U);
  EXPECT_EQ(bench.state().mode, Mode::Run);

  const std::string own_reset = "WDR                             // up to 80 ms";
  SlaveBench without(changed(with_long_scan(1600), own_reset, "// " + own_reset));
  without.start();
  EXPECT_TRUE(without.ask(modbus::read_holding_registers(0, 125)).empty());
  EXPECT_EQ(without.state().fatal_code, static_cast<std::uint16_t>(FatalError::Watchdog));
}

TEST(ModbusSlaveTime, HearsNothingWhileARequestWaitsForTheEndOfTheScan) {
  SlaveBench bench(with_long_scan(1600));
  bench.start();
  const serial::Frame request = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 1)));
  EXPECT_TRUE(bench.send({.frame = request, .timeout = 10 * kMillisecond}).timed_out);
  const serial::Exchange& stray = bench.send({.frame = serial::to_frame(Bytes{0x55})});
  EXPECT_EQ(serial::to_hex(stray.response_bytes()), "01 03 02 00 00 b8 44");
}

TEST(ModbusSlaveTime, SetsItselfUpWhateverTheMemoryHeld) {
  SlaveBench bench(slave_text());
  bench.start(0xA5);
  EXPECT_EQ(bench.ask("0103000a0001"), "01 03 02 a5 a5");
  EXPECT_EQ(bench.ask("010f003a0005011f"), "01 0f 00 3a 00 05");
  EXPECT_EQ(bench.ask("0101003a0006"), "01 01 01 1f");
  EXPECT_EQ(bench.state().error_count, 0U);
}

// --- in the place of the tip's slave ---

std::string before_mend(const std::string& text) { return text.substr(0, text.find("\nMEND")); }
std::string from_mend(const std::string& text) { return text.substr(text.find("\nMEND")); }

TEST(ModbusSlaveForTheTip, ServesTheTipsMainProgram) {
  if (!tip41::available()) GTEST_SKIP() << tip41::path() << " is not there: the document is not part of this project";
  SlaveBench bench(before_mend(tip41::text()) + from_mend(slave_text()));
  bench.start();
  EXPECT_EQ(bench.ask("0106000a1234"), "01 06 00 0a 12 34");
  EXPECT_EQ(bench.ask("0103000a0001"), "01 03 02 12 34");
  EXPECT_EQ(bench.ask("010f000300050115"), "01 0f 00 03 00 05");
  EXPECT_EQ(bench.qb(0), 0xA8);
}

/// The instructions of a text, printed one way, without comments.
std::vector<std::string> instruction_lines(const std::string& text) {
  std::vector<std::string> lines;
  const auto program = compile(text);
  for (const stl::Statement& statement : program->statements) lines.push_back(stl::to_text(statement));
  return lines;
}

TEST(ModbusSlaveForTheTip, HasNoTwelveInstructionsInARowInCommonWithTheTip) {
  if (!tip41::available()) GTEST_SKIP() << tip41::path() << " is not there: the document is not part of this project";
  const auto ours = instruction_lines(slave_text()), tips = instruction_lines(tip41::text());
  std::ptrdiff_t longest = 0;
  for (auto own = ours.begin(); own != ours.end(); ++own)
    for (auto tip = tips.begin(); tip != tips.end(); ++tip) {
      const auto [a, b] = std::mismatch(own, ours.end(), tip, tips.end());
      longest = std::max(longest, a - own);
    }
  EXPECT_LT(longest, 12);
}

}  // namespace
}  // namespace s7200::test::modbus_slave_test
