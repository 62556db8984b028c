// Captures in all the forms that pcap and pcapng allow.
#include "tools/recordings/capture_file.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>

namespace s7200::tools::capture_file_test {
namespace {

/// Numbers in an order of bytes: {4, 1} is 1 in four bytes.
std::string numbers(bool big_endian, std::initializer_list<std::pair<int, std::uint64_t>> values) {
  std::string bytes;
  for (const auto& [size, value] : values)
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * (big_endian ? size - 1 - i : i));
  return bytes;
}

std::string block(bool big_endian, std::uint32_t type, const std::string& body) {
  const auto length = static_cast<std::uint32_t>(body.size() + 12);
  return numbers(big_endian, {{4, type}, {4, length}}) + body + numbers(big_endian, {{4, length}});
}

std::string section(bool big_endian) {
  return block(big_endian, 0x0A0D0D0A, numbers(big_endian, {{4, 0x1A2B3C4D}, {2, 1}, {2, 0}, {8, ~std::uint64_t{0}}}));
}

std::string interface_of(bool big_endian, int link_type, const std::string& options = {}) {
  return block(big_endian, 1, numbers(big_endian, {{2, static_cast<std::uint64_t>(link_type)}, {2, 0}, {4, 0}}) + options);
}

std::string packet_at(bool big_endian, std::uint64_t time, const std::string& data, std::uint32_t interface_number = 0) {
  std::string padded = data;
  padded.resize((data.size() + 3) / 4 * 4);
  return block(
      big_endian, 6,
      numbers(big_endian,
              {{4, interface_number}, {4, time >> 32}, {4, time & 0xFFFFFFFF}, {4, data.size()}, {4, data.size()}}) +
          padded);
}

struct Read {
  std::vector<CaptureFile::Packet> packets{};
  std::string error{};
};

Read read(const std::string& bytes) {
  auto file = CaptureFile::open(bytes);
  if (!file) return {.error = file.why()};
  Read result;
  while (const auto packet = file->next()) result.packets.push_back(*packet);
  result.error = file->error();
  return result;
}

TEST(CaptureFile, BothOrdersOfBytesAndBothUnitsOfAPcapAreRead) {
  for (const bool big_endian : {false, true})
    for (const auto& [magic, fraction] : {std::pair(0xA1B2C3D4U, 250U), std::pair(0xA1B23C4DU, 250'000U)}) {
      const std::string bytes =
          numbers(
              big_endian,
              {{4, magic}, {2, 2}, {2, 4}, {4, 0}, {4, 0}, {4, 65535}, {4, 147}, {4, 7}, {4, fraction}, {4, 2}, {4, 2}}) +
          "ab";
      const Read done = read(bytes);
      EXPECT_EQ(done.error, "");
      ASSERT_EQ(done.packets.size(), 1U);
      EXPECT_EQ(done.packets[0].seconds, 7);
      EXPECT_EQ(done.packets[0].nanoseconds, 250'000);
      EXPECT_EQ(done.packets[0].link_type, 147);
      EXPECT_EQ(done.packets[0].data[1], 'b');
    }
}

TEST(CaptureFile, APcapThatIsCutOffHasItsWholePacketsRead) {
  const std::string head = numbers(false, {{4, 0xA1B2C3D4}, {2, 2}, {2, 4}, {4, 0}, {4, 0}, {4, 65535}, {4, 1}});
  const std::string packet = numbers(false, {{4, 1}, {4, 0}, {4, 3}, {4, 3}}) + "abc";
  for (std::size_t length = 1; length < packet.size(); ++length) {
    const Read done = read(head + packet + packet.substr(0, length));
    EXPECT_EQ(done.packets.size(), 1U);
    EXPECT_EQ(done.error, "after packet 1 the file cannot be read: it is cut off") << length;
  }
  EXPECT_EQ(read(head.substr(0, 20)).error, "it is cut off in its head");
  EXPECT_EQ(read(numbers(false, {{4, 0xA1B2C3D4}, {2, 1}, {2, 0}, {8, 0}, {8, 0}})).error,
            "it is of version 1.0 of pcap, and 2 is the one that is read");
}

TEST(CaptureFile, TimesOfAPcapngHaveTheUnitAndTheOffsetOfTheirInterface) {
  for (const bool big_endian : {false, true}) {
    const auto option = [&](std::uint64_t code, std::uint64_t size, std::uint64_t value) {
      std::string bytes = numbers(big_endian, {{2, code}, {2, size}, {static_cast<int>(size), value}});
      return bytes.append((4 - bytes.size() % 4) % 4, '\0');
    };
    const std::string bytes = section(big_endian) + interface_of(big_endian, 1, option(9, 1, 9)) +
                              interface_of(big_endian, 147, option(9, 1, 0x80 | 10)) +
                              interface_of(big_endian, 148, option(14, 8, 100)) + packet_at(big_endian, 3'000'000'007, "x") +
                              packet_at(big_endian, 1024 + 512, "y", 1) + packet_at(big_endian, 1'500'000, "z", 2);
    const Read done = read(bytes);
    EXPECT_EQ(done.error, "");
    ASSERT_EQ(done.packets.size(), 3U);
    EXPECT_EQ(std::pair(done.packets[0].seconds, done.packets[0].nanoseconds), std::pair(std::int64_t{3}, Time{7}));
    EXPECT_EQ(std::pair(done.packets[1].seconds, done.packets[1].nanoseconds),
              std::pair(std::int64_t{1}, Time{500'000'000}));
    EXPECT_EQ(std::pair(done.packets[2].seconds, done.packets[2].nanoseconds),
              std::pair(std::int64_t{101}, Time{500'000'000}));
  }
}

TEST(CaptureFile, EachSectionOfAPcapngHasItsOwnOrderAndInterfaces) {
  const std::string bytes = section(false) + interface_of(false, 1) + packet_at(false, 1, "ab") + section(true) +
                            interface_of(true, 147) + packet_at(true, 2, "c");
  const Read done = read(bytes);
  EXPECT_EQ(done.error, "");
  ASSERT_EQ(done.packets.size(), 2U);
  EXPECT_EQ(done.packets[1].number, 2U);
  EXPECT_EQ(done.packets[1].link_type, 147);
}

TEST(CaptureFile, SimpleAndOldPacketsOfAPcapngAreReadToo) {
  const std::string simple = block(false, 3, numbers(false, {{4, 2}}) + std::string("ab\0\0", 4));
  const std::string old =
      block(false, 2, numbers(false, {{2, 0}, {2, 0}, {4, 0}, {4, 1}, {4, 1}, {4, 1}}) + std::string("c\0\0\0", 4));
  const Read done = read(section(false) + interface_of(false, 1) + simple + old);
  EXPECT_EQ(done.error, "");
  ASSERT_EQ(done.packets.size(), 2U);
  EXPECT_EQ(done.packets[0].data.size(), 2U);
  EXPECT_EQ(done.packets[1].nanoseconds, 1000);
}

TEST(CaptureFile, WhatABrokenPcapngSaysIsNotBelieved) {
  const std::string begin = section(false) + interface_of(false, 1), good = begin + packet_at(false, 1, "abcd");
  EXPECT_EQ(read(good + packet_at(false, 1, "x", 7)).error,
            "after packet 1 the file cannot be read: a packet is of interface 7, which it does not have");
  EXPECT_EQ(read(good + numbers(false, {{4, 6}, {4, 8}, {4, 8}})).error,
            "after packet 1 the file cannot be read: a block says that it has 8 bytes");
  EXPECT_EQ(read(begin + block(false, 6, numbers(false, {{4, 0}, {8, 0}, {4, 9}, {4, 9}}))).error,
            "the file cannot be read: a packet is longer than its block");
  EXPECT_EQ(read(begin + interface_of(false, 1, numbers(false, {{2, 9}, {2, 1}, {4, 40}}))).error,
            "the file cannot be read: an interface has a unit of time that is too small");
  for (std::size_t length = 1; length < good.size(); ++length) read(good.substr(0, length));
  for (std::size_t at = 0; at < good.size(); ++at)
    for (const char value : {'\0', '\x7F', '\xFF'}) {
      std::string changed = good;
      changed[at] = value;
      read(changed);
    }
}

}  // namespace
}  // namespace s7200::tools::capture_file_test
