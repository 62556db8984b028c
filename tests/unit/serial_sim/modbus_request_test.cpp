#include <gtest/gtest.h>

#include <array>
#include <string>

#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus::modbus_request_test {
namespace {

using serial::to_hex;

Bytes hex(std::string_view text) { return serial::bytes_of(serial::parse_hex_frame(text).frame); }

Bytes with_crc(std::string_view text) {
  Bytes bytes = hex(text);
  add_crc(bytes);
  return bytes;
}

std::string said(std::string_view request, std::string_view response) {
  return describe(with_crc(request), with_crc(response));
}

TEST(ModbusCrc, KnownFrames) {
  EXPECT_EQ(to_hex(with_crc("01 03 00 0a 00 01")), "01 03 00 0a 00 01 a4 08");
  EXPECT_EQ(to_hex(with_crc("01 03 00 00 00 0a")), "01 03 00 00 00 0a c5 cd");
  EXPECT_EQ(to_hex(with_crc("11 03 00 6b 00 03")), "11 03 00 6b 00 03 76 87");
}

TEST(ModbusCrc, CheckValueOfTheAlgorithm) {
  const std::string_view digits = "123456789";
  EXPECT_EQ(crc16(Bytes(digits.begin(), digits.end())), 0x4B37);
}

TEST(ModbusCrc, AnyWrongBitIsFound) {
  const Bytes good = hex("01 03 00 0a 00 01 a4 08");
  ASSERT_TRUE(crc_ok(good));
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 1U << bit % 8);
    EXPECT_FALSE(crc_ok(bad)) << bit;
  }
}

TEST(ModbusCrc, FrameWithoutContentIsNeverRight) {
  EXPECT_FALSE(crc_ok({}));
  EXPECT_FALSE(crc_ok(hex("ff ff")));
}

TEST(ModbusRequest, FunctionsOfTheTip) {
  EXPECT_EQ(to_hex(read_coils(0x13, 0x25)), "01 00 13 00 25");
  EXPECT_EQ(to_hex(read_inputs(0xC4, 0x16)), "02 00 c4 00 16");
  EXPECT_EQ(to_hex(read_holding_registers(0x6B, 3)), "03 00 6b 00 03");
  EXPECT_EQ(to_hex(read_input_registers(8, 1)), "04 00 08 00 01");
  EXPECT_EQ(to_hex(write_coil(0xAC, true)), "05 00 ac ff 00");
  EXPECT_EQ(to_hex(write_coil(0xAC, false)), "05 00 ac 00 00");
  EXPECT_EQ(to_hex(write_register(1, 3)), "06 00 01 00 03");
}

TEST(ModbusRequest, CoilsArePackedFromTheLowestBitOn) {
  const std::vector<bool> coils{true, false, true, true, false, false, true, true, true, false};
  EXPECT_EQ(to_hex(write_coils(0x13, coils)), "0f 00 13 00 0a 02 cd 01");
}

TEST(ModbusRequest, RegistersAreSentHighByteFirst) {
  const std::array<std::uint16_t, 2> values{0x000A, 0x0102};
  EXPECT_EQ(to_hex(write_registers(1, values)), "10 00 01 00 02 04 00 0a 01 02");
}

TEST(ModbusRequest, FrameIsStationPduAndCrc) {
  EXPECT_EQ(to_hex(rtu_frame(1, read_holding_registers(10, 1))), "01 03 00 0a 00 01 a4 08");
}

TEST(ModbusAnswer, RegistersInHex) {
  EXPECT_EQ(said("01 03 00 0a 00 03", "01 03 06 12 34 00 00 ff ff"), "3 registers: 16#1234 16#0000 16#FFFF");
  EXPECT_EQ(said("01 04 00 0a 00 01", "01 04 02 12 34"), "1 register: 16#1234");
}

TEST(ModbusAnswer, BitsInGroupsOfFourFromTheFirstOn) {
  EXPECT_EQ(said("01 01 00 00 00 08", "01 01 01 55"), "coils 0…7: 1010 1010");
  EXPECT_EQ(said("01 02 00 20 00 0a", "01 02 02 0f 03"), "inputs 32…41: 1111 0000 11");
  EXPECT_EQ(said("01 01 00 05 00 01", "01 01 01 01"), "coil 5: 1");
}

TEST(ModbusAnswer, Writes) {
  EXPECT_EQ(said("01 05 00 03 ff 00", "01 05 00 03 ff 00"), "coil 3 written: 1");
  EXPECT_EQ(said("01 05 00 03 00 00", "01 05 00 03 00 00"), "coil 3 written: 0");
  EXPECT_EQ(said("01 06 00 03 12 34", "01 06 00 03 12 34"), "register 3 written: 16#1234");
  EXPECT_EQ(said("01 0f 00 00 00 08 01 55", "01 0f 00 00 00 08"), "8 coils written from 0 on");
  EXPECT_EQ(said("01 10 00 02 00 01 02 12 34", "01 10 00 02 00 01"), "1 register written from 2 on");
}

TEST(ModbusAnswer, ExceptionsByName) {
  EXPECT_EQ(said("01 03 00 0a 00 01", "01 83 02"), "exception 2: illegal data address");
  EXPECT_EQ(said("01 41 00", "01 c1 01"), "exception 1: illegal function");
  EXPECT_EQ(said("01 03 00 0a 00 01", "01 83 63"), "exception 99: unknown code");
}

TEST(ModbusAnswer, WhatIsWrongWithIt) {
  const Bytes request = with_crc("01 03 00 0a 00 01");
  EXPECT_EQ(describe(request, {}), "no answer");
  EXPECT_EQ(describe(request, hex("01 03")), "too short for an answer: 01 03");
  EXPECT_EQ(describe(request, hex("01 03 02 12 34 00 00")), "wrong CRC");
  EXPECT_EQ(said("01 03 00 0a 00 01", "02 03 02 12 34"), "answer of station 2, not 1");
  EXPECT_EQ(said("01 03 00 0a 00 01", "01 04 02 12 34"), "answer to function 4, not 3");
  EXPECT_EQ(said("01 03 00 0a 00 02", "01 03 02 12 34"), "wrong length: 2 data bytes, expected 4");
  EXPECT_EQ(said("01 03 00 0a 00 01", "01 03 04 12 34"), "wrong byte count: 4, expected 2");
  EXPECT_EQ(said("01 06 00 03 12 34", "01 06 00 03 12 35"), "does not repeat the request: 00 03 12 35");
}

TEST(ModbusAnswer, AnEchoIsCalledOne) {
  EXPECT_EQ(said("01 03 00 00 00 01", "01 03 00 00 00 01"),
            "wrong length: 3 data bytes, expected 2: your own request has come back, an echo");
}

TEST(ModbusAnswer, ARequestIsCalledOne) {
  constexpr const char* kAsks = ": a request, so somebody else is a master, too";
  EXPECT_EQ(said("01 03 00 0a 00 02", "01 03 00 00 00 0a"), std::string("wrong length: 3 data bytes, expected 4") + kAsks);
  EXPECT_EQ(said("01 03 00 0a 00 02", "02 04 00 00 00 0a"), std::string("answer of station 2, not 1") + kAsks);
  EXPECT_EQ(said("01 03 00 0a 00 02", "01 10 00 00 00 01 02 12 34"), std::string("answer to function 16, not 3") + kAsks);
  EXPECT_EQ(said("02 03 00 0a 00 02", "01 06 00 00 00 0a"), "answer of station 1, not 2") << "its answer repeats it";
  EXPECT_EQ(said("02 03 00 0a 00 02", "01 10 00 00 00 01"), "answer of station 1, not 2") << "the answer to a write";
}

TEST(ModbusAnswer, ARequestIsWhatNoAnswerLooksLike) {
  for (const char* const request : {"01 01 00 00 00 08", "01 03 03 00 00 02", "01 04 03 ff 00 7d",
                                    "01 0f 00 00 00 09 02 ff 01", "01 10 00 00 00 02 04 12 34 56 78"})
    EXPECT_TRUE(is_request(with_crc(request))) << request;
  EXPECT_FALSE(is_request(with_crc("01 01 03 12 00 56"))) << "three bytes of coils";
  EXPECT_FALSE(is_request(hex("01 03 00 00 00 0a 00 00"))) << "the CRC";
  EXPECT_FALSE(is_request(with_crc("01 03 02 12 34 56"))) << "more registers than may be asked for: a longer answer";
  EXPECT_FALSE(is_request(with_crc("01 03 04 00 00 00 01"))) << "two registers";
  EXPECT_FALSE(is_request(with_crc("01 10 00 00 00 02 04 12 34 56"))) << "it ends too early";
  EXPECT_FALSE(is_request(with_crc("01 10 00 00 00 02 03 12 34 56 78"))) << "its count is another one";
  EXPECT_FALSE(is_request({}));
}

TEST(ModbusAnswer, NoRequestOrAnswerOfAnyLengthIsReadBeyondItsEnd) {
  const Bytes answer = with_crc("01 0f 00 00 00 08");
  for (unsigned function = 0; function < 256; ++function) {
    for (std::size_t length = 0; length < 12; ++length) {
      Bytes request(length, 0xFF);
      if (length > 0) request[0] = 1;
      if (length > 1) request[1] = static_cast<std::uint8_t>(function);
      Bytes cut(length, static_cast<std::uint8_t>(function));
      add_crc(cut);
      EXPECT_FALSE(describe(request, answer).empty());
      EXPECT_FALSE(describe(request, cut).empty());
      EXPECT_FALSE(describe(cut, cut).empty());
    }
  }
}

TEST(ModbusRequest, FunctionsOfDiagnosis) {
  EXPECT_EQ(to_hex(read_exception_status()), "07");
  EXPECT_EQ(to_hex(report_slave_id()), "11");
  EXPECT_EQ(to_hex(diagnostics(0, std::array<std::uint16_t, 2>{0x1234, 0xABCD})), "08 00 00 12 34 ab cd");
  EXPECT_EQ(to_hex(diagnostics(10, std::array<std::uint16_t, 1>{0})), "08 00 0a 00 00");
}

TEST(ModbusRequest, FilesAreReadAndWrittenByReference) {
  // Modbus Application Protocol V1.1b3, the examples of 6.14 and 6.15
  const std::array<Reference, 2> wanted{Reference{.file = 4, .record = 1, .count = 2},
                                        Reference{.file = 3, .record = 9, .count = 2}};
  EXPECT_EQ(to_hex(read_file_record(wanted)), "14 0e 06 00 04 00 01 00 02 06 00 03 00 09 00 02");
  const std::array<Reference, 1> given{Reference{.file = 4, .record = 7, .count = 3, .data = hex("06 af 04 be 10 0d")}};
  const Bytes write = write_file_record(given);
  EXPECT_EQ(to_hex(write), "15 0d 06 00 04 00 07 00 03 06 af 04 be 10 0d");
  EXPECT_EQ(references_of(std::span(write).subspan(2), true), (std::vector<Reference>{given[0]}));
}

TEST(ModbusRequest, ReferencesToExtendedMemoryCountBytes) {
  const std::array<Reference, 1> given{
      Reference{.type = kExtendedMemoryReference, .file = 0x0001, .record = 0x0203, .count = 3, .data = hex("aa bb cc")}};
  const Bytes write = write_file_record(given);
  EXPECT_EQ(to_hex(write), "15 0a 33 00 01 02 03 00 03 aa bb cc");
  EXPECT_EQ(references_of(std::span(write).subspan(2), true), (std::vector<Reference>{given[0]}));
  EXPECT_TRUE(references_of(std::span(write).subspan(2, 9), true).empty());
}

TEST(ModbusFunctions, TheTableIsInOrderAndEachNumberIsThereOnce) {
  for (std::size_t row = 1; row < functions().size(); ++row)
    EXPECT_LT(functions()[row - 1].function, functions()[row].function);
  for (const FunctionRow& row : functions()) EXPECT_EQ(find_function(static_cast<std::uint8_t>(row.function)), &row);
  EXPECT_EQ(find_function(9), nullptr);
}

TEST(ModbusLimits, CountsGoFromOneToTheLimitOfTheFunction) {
  const auto allowed = [](Bytes pdu, std::uint16_t most) {
    for (const unsigned count : {0U, 1U, unsigned{most}, most + 1U}) {
      pdu[3] = static_cast<std::uint8_t>(count >> 8);
      pdu[4] = static_cast<std::uint8_t>(count & 0xFF);
      EXPECT_EQ(beyond_limits(pdu).empty(), count >= 1 && count <= most) << to_hex(pdu) << " " << beyond_limits(pdu);
    }
  };
  allowed(read_coils(0, 0), 2000);
  allowed(read_inputs(0, 0), 2000);
  allowed(read_holding_registers(0, 0), 125);
  allowed(read_input_registers(0, 0), 125);
  allowed(write_coils(0, {true}), 1968);
  allowed(write_registers(0, std::array<std::uint16_t, 1>{}), 123);
  EXPECT_EQ(beyond_limits(read_holding_registers(0, 126)),
            "126 registers in one request: function 3 (read holding registers) takes 1 to 125");
}

TEST(ModbusLimits, AddressesEndAt65535) {
  EXPECT_EQ(beyond_limits(read_holding_registers(65535, 1)), "");
  EXPECT_EQ(beyond_limits(read_holding_registers(65535, 2)), "registers 65535 to 65536: the last is 65535");
  EXPECT_EQ(beyond_limits(write_coil(65535, true)), "");
  EXPECT_EQ(beyond_limits(write_register(65535, 0xFFFF)), "");
}

TEST(ModbusLimits, OfDiagnosticsAndFiles) {
  EXPECT_EQ(beyond_limits(diagnostics(0, std::vector<std::uint16_t>(125))), "");
  EXPECT_NE(beyond_limits(diagnostics(0, std::vector<std::uint16_t>(126))), "");
  const auto file = [](std::uint16_t number, std::uint16_t record, std::uint16_t count) {
    return beyond_limits(read_file_record(std::array{Reference{.file = number, .record = record, .count = count}}));
  };
  EXPECT_EQ(file(1, 9999, 1), "");
  EXPECT_EQ(file(1, 9999, 2), "records 9999 to 10000 of file 1: the last is 9999");
  EXPECT_EQ(file(0, 0, 1), "files are counted from 1");
  EXPECT_NE(file(1, 0, 0), "");
  EXPECT_EQ(file(1, 0, 121), "");
  EXPECT_EQ(file(1, 0, 122), "the answer would have 246 bytes of data: function 20 (read file record) allows 245");
  const std::vector<Reference> many(36, Reference{.file = 1, .record = 0, .count = 1});
  EXPECT_NE(beyond_limits(read_file_record(many)), "");
  EXPECT_EQ(beyond_limits(read_file_record(std::span(many).first(35))), "");
  const auto written = [](std::uint16_t count) {
    return beyond_limits(write_file_record(
        std::array{Reference{.file = 1, .record = 0, .count = count, .data = Bytes(2 * std::size_t{count})}}));
  };
  EXPECT_EQ(written(122), "");
  EXPECT_NE(written(123), "");
}

TEST(ModbusLimits, WhatIsNotInTheTableOrIncompleteHasNone) {
  EXPECT_EQ(beyond_limits({}), "");
  EXPECT_EQ(beyond_limits(hex("41 00 00 ff ff")), "");
  for (const FunctionRow& row : functions()) {
    const Bytes alone{static_cast<std::uint8_t>(row.function)};
    EXPECT_EQ(beyond_limits(alone), "") << row.name;
  }
}

TEST(ModbusAnswer, Diagnosis) {
  EXPECT_EQ(said("01 07", "01 07 6d"), "exception status 0…7: 1011 0110");
  EXPECT_EQ(said("01 08 00 00 12 34", "01 08 00 00 12 34"), "loopback: 16#1234 returned");
  EXPECT_EQ(said("01 08 00 0b 00 00", "01 08 00 0b 00 11"), "bus message count: 17");
  EXPECT_EQ(said("01 08 00 63 00 00", "01 08 00 63 00 11"), "subfunction 99: 16#0011");
  EXPECT_EQ(said("01 11", "01 11 02 15 ff"), "slave id 16#15, running");
  EXPECT_EQ(said("01 11", "01 11 04 15 00 01 02"), "slave id 16#15, stopped, further data 01 02");
  EXPECT_EQ(said("01 11", "01 11 00"), "slave id: empty");
}

TEST(ModbusAnswer, Files) {
  const std::string_view read = "01 14 0e 06 00 04 00 01 00 02 06 00 03 00 09 00 02";
  EXPECT_EQ(said(read, "01 14 0c 05 06 0d fe 00 20 05 06 33 cd 00 40"),
            "file 4 from 1 on, 2 registers: 16#0DFE 16#0020; file 3 from 9 on, 2 registers: 16#33CD 16#0040");
  EXPECT_EQ(said("01 15 09 06 00 04 00 07 00 01 06 af", "01 15 09 06 00 04 00 07 00 01 06 af"), "1 reference written");
  EXPECT_EQ(said("01 14 07 33 00 01 00 02 00 03", "01 14 05 04 33 0a 0b 0c"), "references of kind 16#33: 0a 0b 0c");
}

TEST(ModbusAnswer, ValuesAreDecoded) {
  const auto checked = [](std::string_view request, std::string_view response) {
    return check_answer(with_crc(request), with_crc(response));
  };
  using Words = std::vector<std::uint16_t>;
  EXPECT_EQ(checked("01 01 00 00 00 09", "01 01 02 05 01").values, (Words{1, 0, 1, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(checked("01 03 00 00 00 02", "01 03 04 12 34 ff ff").values, (Words{0x1234, 0xFFFF}));
  EXPECT_EQ(checked("01 08 00 00 12 34", "01 08 00 00 12 34").values, (Words{0x1234}));
  EXPECT_EQ(checked("01 07", "01 07 6d").bytes, Bytes{0x6D});
  EXPECT_EQ(checked("01 11", "01 11 02 15 ff").bytes, (Bytes{0x15, 0xFF}));
  EXPECT_EQ(checked("01 41", "01 41 01 02").bytes, (Bytes{1, 2}));
  const Answer exception = checked("01 03 00 00 00 02", "01 83 02");
  EXPECT_EQ(exception.verdict, Verdict::Exception);
  EXPECT_EQ(exception.exception, 2);
  EXPECT_EQ(checked("01 03 00 00 00 01", "01 03 02 00 01").verdict, Verdict::Right);
  EXPECT_EQ(checked("01 03 00 00 00 01", "01 03 02 00").verdict, Verdict::Wrong);
  EXPECT_EQ(check_answer(with_crc("01 03 00 00 00 01"), {}).verdict, Verdict::Silent);
}

TEST(ModbusAnswer, WhatIsWrongWithDiagnosisAndFiles) {
  EXPECT_EQ(said("01 07", "01 07 6d 00"), "wrong length: 2 data bytes, expected 1");
  EXPECT_EQ(said("01 08 00 00 12 34", "01 08 00 00 12 35"), "does not repeat the request: 00 00 12 35");
  EXPECT_EQ(said("01 08 00 00 12 34", "01 08 00 01 12 34"), "answer to subfunction 1, not 0");
  EXPECT_EQ(said("01 08 00 00 12 34", "01 08 00"), "wrong length: 1 data byte, expected 4");
  EXPECT_EQ(said("01 08 00 0b 00 00", "01 08 00 0b 00"), "wrong length: 3 data bytes, expected 4");
  EXPECT_EQ(said("01 08 00 04 00 00", "01 08 00 04 00 00"), "this subfunction is never answered");
  EXPECT_EQ(said("01 11", "01 11 03 15 ff"), "wrong byte count: 3, expected 2");
  EXPECT_EQ(said("01 14 07 06 00 04 00 01 00 01", "01 14 04 03 05 0d fe"), "reference of kind 16#05, not 16#06");
  EXPECT_EQ(said("01 14 07 06 00 04 00 01 00 01", "01 14 03 02 06 0d"), "1 bytes of file 4, expected 2");
  EXPECT_EQ(said("01 14 07 06 00 04 00 01 00 01", "01 14 05 03 06 0d fe"), "wrong byte count: 5, expected 4");
  EXPECT_EQ(said("01 14 07 06 00 04 00 01 00 01", "01 14 02 03 06"), "a reference is missing or cut off: 02 03 06");
  EXPECT_EQ(said("01 14 07 06 00 04 00 01 00 01", "01 14 05 03 06 0d fe 00"), "more than was asked for: 00");
  EXPECT_EQ(said("01 15 09 06 00 04 00 07 00 01 06 af", "01 15 09 06 00 04 00 07 00 01 06 ae"),
            "does not repeat the request: 09 06 00 04 00 07 00 01 06 ae");
  EXPECT_EQ(said("01 41", "01"), "too short for an answer: 01 7e 80");
}

}  // namespace
}  // namespace s7200::modbus::modbus_request_test
