#include "serial_sim/modbus/rtu_stream.hpp"

#include <gtest/gtest.h>

#include <array>

#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus::rtu_stream_test {
namespace {

using serial::to_hex;

Bytes operator+(Bytes one, const Bytes& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

/// A start of two bytes, then enough to make the CRC right; one of each length that a request has.
const std::vector<Bytes>& requests() {
  static const std::array<std::uint16_t, 3> values{1, 2, 3};
  static const std::array references{Reference{.file = 1, .record = 2, .count = 3}};
  static const std::vector<Bytes> all{rtu_frame(1, read_holding_registers(10, 2)),
                                      rtu_frame(0, write_register(10, 5)),
                                      rtu_frame(1, write_coils(3, {true, false, true})),
                                      rtu_frame(0, write_registers(3, values)),
                                      rtu_frame(1, read_exception_status()),
                                      rtu_frame(1, report_slave_id()),
                                      rtu_frame(1, diagnostics(0, values)),
                                      rtu_frame(1, read_file_record(references)),
                                      rtu_frame(1, Bytes{0x41, 1, 2, 3})};
  return all;
}

TEST(RtuStream, RequestsThatComeAtOnceAreToldApart) {
  for (const Bytes& one : requests())
    for (const Bytes& other : requests()) {
      EXPECT_EQ(first_request(one), one.size()) << to_hex(one);
      EXPECT_EQ(first_request(one + other), one.size()) << to_hex(one + other);
      EXPECT_EQ(first_request(one + Bytes(300, 0x55)), one.size()) << to_hex(one);
    }
}

TEST(RtuStream, ARequestIsWaitedForUntilItIsComplete) {
  for (const Bytes& one : requests())
    for (std::size_t size = 0; size < one.size(); ++size)
      EXPECT_EQ(first_request(std::span(one).first(size)), 0U) << to_hex(one) << ", " << size;
}

TEST(RtuStream, ALongRequestIsNotTakenForAShortOneThatItHappensToBeginWith) {
  const Bytes short_one = rtu_frame(1, Bytes{16, 0, 10, 0, 100, 200});
  Bytes long_one(short_one);
  long_one.resize(7 + 200, 0x55);
  add_crc(long_one);
  EXPECT_EQ(first_request(std::span(long_one).first(100)), 0U);
  EXPECT_EQ(first_request(long_one + requests()[0]), long_one.size());
}

TEST(RtuStream, ARequestWithAWrongLengthIsOneAllTheSame) {
  const Bytes too_long = rtu_frame(1, read_holding_registers(10, 2) + Bytes{0}), too_short = rtu_frame(1, Bytes{3, 0});
  for (const Bytes& wrong : {too_long, too_short}) {
    EXPECT_EQ(first_request(wrong), wrong.size());
    EXPECT_EQ(first_request(wrong + requests()[0]), wrong.size());
  }
}

TEST(RtuStream, HowMuchOfARequestThereIsIsToldByItsFunction) {
  for (Bytes wrong : requests()) {
    wrong.back() ^= 1;
    const bool known = wrong[1] <= 21 && wrong[1] != 8;  // diagnostics: subfunction 0 has any length
    for (std::size_t size = 0; size < wrong.size(); ++size)
      EXPECT_EQ(extent_of_request(std::span(wrong).first(size)), known || size < 4 ? Extent::Part : Extent::Unknown)
          << to_hex(wrong) << ", " << size;
    for (const Bytes& more : {Bytes{}, Bytes{0}, requests()[0]})
      EXPECT_EQ(extent_of_request(wrong + more), known ? Extent::Whole : Extent::Unknown) << to_hex(wrong);
  }
}

TEST(RtuStream, AWrongCrcMakesNoRequest) {
  for (Bytes wrong : requests()) {
    wrong.back() ^= 1;
    EXPECT_EQ(first_request(wrong), 0U);
  }
  EXPECT_EQ(first_request(Bytes(1000, 0x55)), 0U);
}

}  // namespace
}  // namespace s7200::modbus::rtu_stream_test
