#include <gtest/gtest.h>

#include <array>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/pc_protocol/answer.hpp"
#include "serial_sim/pc_protocol/command.hpp"

namespace s7200::pc_protocol::pc_protocol_test {
namespace {

using serial::Verdict;

Bytes bytes(const std::string& hex) {
  const serial::ParsedFrame parsed = serial::parse_hex_frame(hex);
  EXPECT_TRUE(parsed.ok()) << hex;
  return serial::bytes_of(parsed.frame);
}

const Command kRead{Type::Read, 2, {Area::V, 1000}, {}};
const Command kWrite{Type::Write, 2, {Area::V, 1001}, {0x11, 0x22, 0x33, 0x44, 0x55}};

// An answer with eight bytes of data, its check code given.
Bytes answer(std::uint8_t status, const std::string& data, const std::string& code, std::uint8_t end = kEndCharacter) {
  Bytes made{'g', status};
  made.insert(made.end(), data.begin(), data.end());
  made.insert(made.end(), code.begin(), code.end());
  made.push_back(end);
  return made;
}

const std::string kData = "0123456789ABCDEF";
const std::string kCode = "06";

std::string fault(const Command& command, const Bytes& response, std::uint8_t end = kEndCharacter) {
  const serial::Answer judged = check_answer(to_bytes(command), response, end);
  return judged.verdict == Verdict::Wrong ? judged.fault : "none";
}

TEST(PcCommand, AReadHas33CharactersAndFullData) {
  EXPECT_EQ(to_bytes(kRead),
            bytes("67 05 30 32 30 38 30 30 30 33 45 38 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 30 "
                  "37 31 47"));
}

TEST(PcCommand, AWriteSaysHowManyDigitsItWrites) {
  EXPECT_EQ(to_bytes(kWrite),
            bytes("67 06 30 32 30 38 30 30 30 33 45 39 30 41 31 31 32 32 33 33 34 34 35 35 30 30 30 30 30 30 "
                  "30 32 47"));
  const Command whole{Type::Write, 2, {Area::M, 8}, {1, 2, 3, 4, 5, 6, 7, 8}};
  EXPECT_EQ(to_bytes(whole),
            bytes("67 06 30 32 30 32 30 30 30 30 30 38 31 30 30 31 30 32 30 33 30 34 30 35 30 36 30 37 30 38 "
                  "30 37 47"));
}

TEST(PcCommand, WhatIsBuiltIsReadBack) {
  for (const Area area : {Area::I, Area::Q, Area::M, Area::V}) {
    EXPECT_EQ(parse_command(to_bytes({Type::Read, 255, {area, 65535}, {}})), (Command{Type::Read, 255, {area, 65535}, {}}));
    EXPECT_EQ(parse_command(to_bytes({Type::Write, 0, {area, 0}, {0xFF}})), (Command{Type::Write, 0, {area, 0}, {0xFF}}));
  }
  EXPECT_EQ(parse_command(to_bytes(kWrite)), kWrite);
}

TEST(PcCommand, WhatIsDamagedIsNotACommand) {
  const Bytes good = to_bytes(kWrite);
  for (std::size_t place = 0; place < good.size(); ++place) {
    Bytes damaged = good;
    damaged[place] ^= 0x01;
    EXPECT_FALSE(parse_command(damaged)) << place;
  }
  EXPECT_FALSE(parse_command(std::span(good).first(32)));
  EXPECT_FALSE(parse_command({}));
}

// Each with the right check code: the field alone makes it none.
TEST(PcCommand, TypesAreasAndCountsThatDoNotExistAreNotCommands) {
  const auto with = [](std::size_t place, std::string_view text) {
    Bytes bytes = to_bytes(kWrite);
    std::copy(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(place));
    const std::uint8_t code = check_code(std::span(bytes).subspan(1, 29));
    Bytes digits;
    append_digits(digits, std::array{code});
    std::copy(digits.begin(), digits.end(), bytes.begin() + 30);
    return parse_command(bytes);
  };
  EXPECT_TRUE(with(12, "0A"));
  for (const auto& [place, text] : std::initializer_list<std::pair<std::size_t, std::string_view>>{
           {1, "\x07"}, {4, "05"}, {6, "01"}, {12, "00"}, {12, "03"}, {12, "12"}, {12, "0a"}, {14, "zz"}})
    EXPECT_FALSE(with(place, text)) << place << " " << text;
}

TEST(PcAddress, IsWrittenAsInStl) {
  EXPECT_EQ(parse_address("VB100"), (Address{Area::V, 100}));
  EXPECT_EQ(parse_address("mb8"), (Address{Area::M, 8}));
  EXPECT_EQ(parse_address("IB0"), (Address{Area::I, 0}));
  EXPECT_EQ(parse_address("QB65535"), (Address{Area::Q, 65535}));
  for (const char* text : {"", "VB", "V100", "VW100", "VB65536", "VB-1", "SMB0", "VB1x", "VB 1", "100"}) {
    const std::string why = parse_address(text).why();
    EXPECT_NE(why.find("write for example VB100"), std::string::npos) << text;
  }
  EXPECT_EQ(notation({Area::V, 100}), "VB100");
  EXPECT_EQ(notation({Area::I, 0}), "IB0");
}

TEST(PcAnswer, OfAReadCarriesEightBytes) {
  const serial::Answer judged = check_answer(to_bytes(kRead), answer(1, kData, kCode), kEndCharacter);
  EXPECT_EQ(judged.verdict, Verdict::Right);
  EXPECT_EQ(judged.bytes, (Bytes{0x01, 0x23, 0x45, 0x67, 0x89, 0xAB, 0xCD, 0xEF}));
  EXPECT_EQ(check_answer(to_bytes(kRead), {}, kEndCharacter).verdict, Verdict::Silent);
}

TEST(PcAnswer, DataAndCheckCodeMeanNothingUnlessSomethingWasRead) {
  const std::string none(16, '\0');
  for (const std::uint8_t status : std::to_array<std::uint8_t>({2, 3, 4})) {
    const auto judged = check_answer(to_bytes(kWrite), answer(status, none, std::string(2, '\0')), kEndCharacter);
    EXPECT_EQ(judged.verdict, status == 2 ? Verdict::Right : Verdict::Exception);
    EXPECT_EQ(judged.exception, status == 2 ? 0 : status);
    EXPECT_TRUE(judged.bytes.empty());
  }
  EXPECT_EQ(refusal_name(3), "check code wrong");
  EXPECT_EQ(refusal_name(4), "command not legal");
}

TEST(PcAnswer, TheEndCharacterIsAsAgreed) {
  EXPECT_EQ(fault(kRead, answer(1, kData, kCode, 0x1A)), "end character 16#1A, expected 16#26");
  EXPECT_EQ(fault(kRead, answer(1, kData, kCode, 0x1A), 0x1A), "none");
  EXPECT_EQ(fault(kRead, answer(1, kData, kCode), 0x1A), "end character 16#26, expected 16#1A");
}

TEST(PcAnswer, EachFaultIsNamed) {
  EXPECT_EQ(fault(kRead, answer(1, kData, "B0")), "wrong check code");
  EXPECT_EQ(fault(kRead, answer(1, "0123456789abcdef", kCode)), "data or check code are not hex digits");
  EXPECT_EQ(fault(kRead, answer(1, kData, std::string(2, '\0'))), "data or check code are not hex digits");
  EXPECT_EQ(fault(kRead, answer(2, kData, kCode)), "status 2 to a read");
  EXPECT_EQ(fault(kWrite, answer(1, kData, kCode)), "status 1 to a write");
  EXPECT_EQ(fault(kRead, answer(0, kData, kCode)), "status 0: there are 1 to 4");
  EXPECT_EQ(fault(kRead, answer(5, kData, kCode)), "status 5: there are 1 to 4");
  EXPECT_EQ(fault(kRead, bytes("67 01 30")), "wrong length: 3 bytes, expected 21");
  EXPECT_EQ(fault(kRead, bytes("01 83 02")), "begins with 16#01, not with g: 01 83 02");
}

TEST(PcAnswer, ToWhatIsNotACommandIsJudgedByItsForm) {
  const Bytes cut = bytes("67 05 30 32 47");
  EXPECT_EQ(check_answer(cut, answer(4, kData, kCode), kEndCharacter).verdict, Verdict::Exception);
  EXPECT_EQ(check_answer(cut, answer(1, kData, kCode), kEndCharacter).verdict, Verdict::Right);
  EXPECT_EQ(check_answer(cut, answer(1, kData, "00"), kEndCharacter).verdict, Verdict::Wrong);
}

}  // namespace
}  // namespace s7200::pc_protocol::pc_protocol_test
