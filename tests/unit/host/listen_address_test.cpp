#include "tools/host/listen_address.hpp"

#include <gtest/gtest.h>

namespace s7200::tools {
namespace {

/// As it is understood, or what is wrong.
std::string read(const std::string& text) {
  std::string why;
  const auto address = parse_listen_address(text, why);
  EXPECT_EQ(address.has_value(), why.empty());
  return address ? to_text(*address) : why;
}

TEST(ListenAddress, APortAloneIsForThisComputerOnly) {
  EXPECT_EQ(read("502"), "127.0.0.1:502");
  EXPECT_EQ(read(":502"), "127.0.0.1:502");
  EXPECT_EQ(read("0"), "127.0.0.1:0");
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
  EXPECT_EQ(read("localhost:5"), "'localhost' is not an IP address");
  EXPECT_EQ(read("[1.2.3.4]:5"), "'1.2.3.4' is not an IPv6 address");
  EXPECT_EQ(read("::1:5"), "write an IPv6 address in brackets, as [::1]:5");
}

}  // namespace
}  // namespace s7200::tools
