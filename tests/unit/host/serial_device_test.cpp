#include "tools/host/serial_device.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <string>
#include <thread>
#include <vector>

#include "tools/host/posix/termios2.hpp"

namespace s7200::tools::serial_device_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};

/// The device under test is the far side of a pty; the test holds the near one.
class SerialDeviceTest : public testing::Test {
 protected:
  void SetUp() override {
    near_ = posix_openpt(O_RDWR | O_NOCTTY);
    if (near_ < 0 || grantpt(near_) != 0 || unlockpt(near_) != 0) GTEST_SKIP() << "no pty can be opened here";
    path_ = ptsname(near_);
  }
  ~SerialDeviceTest() override { close(near_); }

  std::optional<SerialDevice> open(const SerialFormat& format = k8E1) {
    auto device = SerialDevice::open(path_, format);
    EXPECT_TRUE(device) << device.why();
    return std::move(device).if_any();
  }
  void write_near(const std::string& bytes) {
    ASSERT_EQ(::write(near_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  /// Waits until `count` characters have come.
  static std::vector<SerialDevice::Character> read(SerialDevice& device, std::size_t count) {
    std::vector<SerialDevice::Character> characters;
    while (characters.size() < count && device.wait_for_input(std::chrono::seconds(10)))
      if (const auto done = device.read(characters); !done) {
        ADD_FAILURE() << done.why();
        break;
      }
    return characters;
  }

  int near_ = -1;
  std::string path_;
};

TEST_F(SerialDeviceTest, EveryByteComesThroughBothWays) {
  auto device = open();
  ASSERT_TRUE(device);
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all.push_back(static_cast<char>(byte));
  write_near(all);
  const auto characters = read(*device, all.size());
  ASSERT_EQ(characters.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(characters[i], (SerialDevice::Character{static_cast<std::uint8_t>(i), false}));

  const auto* bytes = reinterpret_cast<const std::uint8_t*>(all.data());
  EXPECT_EQ(device->write({bytes, all.size()}), all.size());
  std::string heard;
  while (heard.size() < all.size()) {
    char part[256];
    const ssize_t count = ::read(near_, part, sizeof part);
    ASSERT_GT(count, 0);
    heard.append(part, static_cast<std::size_t>(count));
  }
  EXPECT_EQ(heard, all);
}

TEST_F(SerialDeviceTest, ASideThatNeverStopsTalkingHoldsNoOne) {
  auto device = open();
  ASSERT_TRUE(device);
  fcntl(near_, F_SETFL, O_NONBLOCK);
  const std::vector<char> zeros(65536, 0);
  std::jthread flood([this, &zeros](const std::stop_token& enough) {
    while (!enough.stop_requested()) [[maybe_unused]] const ssize_t count = ::write(near_, zeros.data(), zeros.size());
  });
  for (int reading = 0; reading < 100; ++reading) {
    const std::size_t count = read(*device, 1).size();
    EXPECT_GE(count, 1U);
    EXPECT_LE(count, SerialDevice::kMostAtOnce);
  }
}

TEST_F(SerialDeviceTest, SettingsAreThoseOfTheFormatAtAnyRate) {
  for (const std::uint32_t baud : {300U, 9600U, 187'500U, 12'345U}) {
    auto device = open({baud, 8, Parity::Odd, 2});
    ASSERT_TRUE(device);
    termios2 settings{};
    ASSERT_TRUE(read_settings(near_, settings));
    EXPECT_EQ(settings.c_ospeed, baud);
    EXPECT_TRUE(settings.c_cflag & CSTOPB);
    EXPECT_TRUE(settings.c_cflag & PARODD);
    EXPECT_EQ(device->set(k8E1).why(), "");
    ASSERT_TRUE(read_settings(near_, settings));
    EXPECT_EQ(settings.c_ospeed, 9600U);
    EXPECT_FALSE(settings.c_cflag & (CSTOPB | PARODD));
    EXPECT_EQ(device->format(), k8E1);
  }
}

TEST_F(SerialDeviceTest, APtyIsToldOfParityByItsCheckAlone) {
  for (const Parity parity : {Parity::None, Parity::Even, Parity::Odd, Parity::None}) {
    const auto device = open({9600, 8, parity, 1});
    ASSERT_TRUE(device);
    termios2 settings{};
    ASSERT_TRUE(read_settings(near_, settings));
    EXPECT_EQ((settings.c_iflag & INPCK) != 0, parity != Parity::None);
  }
}

TEST_F(SerialDeviceTest, WhatTheDeviceDoesNotTakeIsSaidAndTheOldFormatHolds) {
  auto device = open();
  ASSERT_TRUE(device);
  EXPECT_EQ(device->set({9600, 7, Parity::Even, 1}).why(), "the device does not do 7 data bits");
  EXPECT_EQ(device->format(), k8E1);
}

TEST_F(SerialDeviceTest, TheSettingsFoundArePutBack) {
  termios2 before{}, after{};
  ASSERT_TRUE(read_settings(near_, before));
  open();
  ASSERT_TRUE(read_settings(near_, after));
  EXPECT_EQ(before.c_lflag, after.c_lflag);
  EXPECT_EQ(before.c_iflag, after.c_iflag);
  EXPECT_EQ(before.c_ospeed, after.c_ospeed);
}

TEST_F(SerialDeviceTest, OneProgramAtATime) {
  auto device = open();
  std::string why = SerialDevice::open(path_, k8E1).why();
  EXPECT_NE(why.find("another program"), std::string::npos) << why;
}

TEST_F(SerialDeviceTest, ADeviceThatIsUnpluggedIsGone) {
  auto device = open();
  ASSERT_TRUE(device);
  close(near_);
  near_ = -1;
  std::vector<SerialDevice::Character> characters;
  std::string why = device->read(characters).why();
  EXPECT_NE(why, "");
  EXPECT_FALSE(device->write(std::vector<std::uint8_t>{1}));
}

TEST_F(SerialDeviceTest, WhatIsNoSerialDeviceIsSaid) {
  std::string why = SerialDevice::open("/dev/null", k8E1).why();
  EXPECT_EQ(why, "it is not a serial device");
  EXPECT_EQ(SerialDevice::open("/no/such/device", k8E1).why(), "No such file or directory");
}

}  // namespace
}  // namespace s7200::tools::serial_device_test
