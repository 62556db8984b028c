#include "interpreter/base/listen_address.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>

#include <array>

namespace s7200::listen_address_test {
namespace {

/// As it is understood, or what is wrong.
std::string read(const std::string& text) {
  const auto address = parse_listen_address(text);
  EXPECT_EQ(address.has_value(), address.why().empty());
  return address ? to_text(*address) : address.why();
}

TEST(ListenAddress, APortAloneIsForThisComputerOnly) {
  EXPECT_EQ(read("502"), "127.0.0.1:502");
  EXPECT_EQ(read(":502"), "127.0.0.1:502");
  EXPECT_EQ(read("0"), "127.0.0.1:0");
  EXPECT_EQ(read("localhost:502"), "127.0.0.1:502");
}

TEST(ListenAddress, AnotherAddressIsWrittenOut) {
  EXPECT_EQ(read("0.0.0.0:65535"), "0.0.0.0:65535");
  EXPECT_EQ(read("[::1]:502"), "[::1]:502");
  EXPECT_EQ(read("[::]:0"), "[::]:0");
}

TEST(ListenAddress, WhatIsWrongIsSaid) {
  EXPECT_EQ(read(""), "'' is not a port from 0 to 65535");
  EXPECT_EQ(read("65536"), "'65536' is not a port from 0 to 65535");
  EXPECT_EQ(read("-1"), "'-1' is not a port from 0 to 65535");
  EXPECT_EQ(read("5a"), "'5a' is not a port from 0 to 65535");
  EXPECT_EQ(read("1.2.3:5"), "'1.2.3' is not an IP address");
  EXPECT_EQ(read("plant:5"), "'plant' is not an IP address");
  EXPECT_EQ(read("[1.2.3.4]:5"), "'1.2.3.4' is not an IPv6 address");
  EXPECT_EQ(read("::1:5"), "write an IPv6 address in brackets, as [::1]:5");
}

TEST(ListenAddress, AddressesAreThoseOfTheSystem) {
  for (const char* const text : {"0.0.0.0",
                                 "255.255.255.255",
                                 "127.0.0.1",
                                 "1.2.3",
                                 "1.2.3.256",
                                 "01.2.3.4",
                                 "1.2.3.4.",
                                 "1..2.3",
                                 " 1.2.3.4",
                                 "1.2.3.0x4",
                                 "",
                                 "::",
                                 "::1",
                                 "1::",
                                 "1:2:3:4:5:6:7:8",
                                 "1:2:3:4:5:6:7",
                                 "1:2:3:4:5:6:7::",
                                 "::2:3:4:5:6:7:8",
                                 "1:2:3:4::5:6:7:8",
                                 "fe80::1:abcd",
                                 "fe80::12345",
                                 "g::1",
                                 "1:::2",
                                 "1::2::3",
                                 ":1",
                                 "1:",
                                 ":",
                                 "::ffff:10.0.0.1",
                                 "1:2:3:4:5:6:10.0.0.1",
                                 "1:2:3:4:5:6:7:10.0.0.1",
                                 "10.0.0.1::",
                                 "::10.0.0",
                                 "FE80::ABCD",
                                 "fe80::1%eth0"}) {
    std::array<unsigned char, sizeof(in6_addr)> address{};
    EXPECT_EQ(is_ipv4_address(text), inet_pton(AF_INET, text, address.data()) == 1) << text;
    EXPECT_EQ(is_ipv6_address(text), inet_pton(AF_INET6, text, address.data()) == 1) << text;
  }
}

}  // namespace
}  // namespace s7200::listen_address_test
