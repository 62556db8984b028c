// What goes out in place of an answer.
#include "serial_sim/faults/answer_change.hpp"

#include <gtest/gtest.h>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/modbus/crc.hpp"

namespace s7200::serial::answer_change_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};

Bytes with_crc(Bytes bytes) {
  modbus::add_crc(bytes);
  return bytes;
}

/// What is on the line when the station sends this frame; `..` is a character that is not, `|` the pause.
std::string sent(const std::string& fault, const Bytes& frame, const Bytes& before = {}) {
  AnswerInProgress answer{.length = frame.size(), .before = before};
  const Fault parsed = parse_fault(fault).fault;
  if (!possible(parsed.misbehaviour, answer)) return "impossible";
  std::string text;
  for (const std::uint8_t byte : frame) {
    answer.bytes.push_back(byte);
    Mishap mishap;
    change(parsed, answer, k8E1, mishap);
    text += (text.empty() ? "" : " ") + (mishap.lost ? std::string("..") : to_hex(Bytes{mishap.instead.value_or(byte)}));
    if (mishap.pause > 0) text += " |";
    for (const std::uint8_t more : mishap.after) text += " " + to_hex(Bytes{more});
  }
  return text;
}

const Bytes kAnswer = with_crc({0x01, 0x03, 0x04, 0x12, 0x34, 0x56, 0x78});

std::string hex(const Bytes& bytes) { return to_hex(bytes); }

TEST(AnswerChange, AnExceptionTakesThePlaceOfTheData) {
  EXPECT_EQ(sent("answer:exception=6", kAnswer), hex(with_crc({0x01, 0x83, 0x06})) + " .. .. .. ..");
}

TEST(AnswerChange, AnotherStationOrFunctionHasARightCrc) {
  EXPECT_EQ(sent("answer:station=7", kAnswer), hex(with_crc({0x07, 0x03, 0x04, 0x12, 0x34, 0x56, 0x78})));
  EXPECT_EQ(sent("answer:function=4", kAnswer), hex(with_crc({0x01, 0x04, 0x04, 0x12, 0x34, 0x56, 0x78})));
}

TEST(AnswerChange, AShortAnswerLacksTwoBytesOfDataAndHasARightCrc) {
  EXPECT_EQ(sent("answer:short", kAnswer), hex(with_crc({0x01, 0x03, 0x04, 0x12, 0x34})) + " .. ..");
  EXPECT_EQ(sent("answer:short", with_crc({0x01, 0x83})), "impossible");
}

TEST(AnswerChange, AStaleAnswerIsTheOneBeforeHoweverLong) {
  const Bytes shorter = with_crc({0x01, 0x83, 0x02}), longer = with_crc({0x01, 0x03, 0x06, 1, 2, 3, 4, 5, 6});
  EXPECT_EQ(sent("answer:stale", kAnswer, shorter), hex(shorter) + " .. .. .. ..");
  EXPECT_EQ(sent("answer:stale", kAnswer, longer), hex(longer));
  EXPECT_EQ(sent("answer:stale", kAnswer), "impossible") << "there was none before";
}

TEST(AnswerChange, AnAnswerThatIsSentTwiceHasAPauseBetween) {
  EXPECT_EQ(sent("answer:twice", kAnswer), hex(kAnswer) + " | " + hex(kAnswer));
}

TEST(AnswerChange, ASilentStationSendsNothing) { EXPECT_EQ(sent("answer:silent", Bytes{1, 2, 3}), ".. .. .."); }

TEST(AnswerChange, AnAnswerThatIsOnlyLateIsUnchanged) { EXPECT_EQ(sent("answer:delay=1s", kAnswer), hex(kAnswer)); }

}  // namespace
}  // namespace s7200::serial::answer_change_test
