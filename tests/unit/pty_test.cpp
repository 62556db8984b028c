// Programs that open and set the far side of a pty as they would a serial port.
#include "tools/pty.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

namespace s7200::tools {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};

/// As pyserial does it: everything at once, with even parity. The port, or -1.
int open_and_set(const std::string& path) {
  const int port = open(path.c_str(), O_RDWR | O_NOCTTY);
  termios settings{};
  tcgetattr(port, &settings);
  cfmakeraw(&settings);
  cfsetspeed(&settings, B9600);
  settings.c_cflag |= CLOCAL | CREAD | PARENB;
  if (tcsetattr(port, TCSANOW, &settings) == 0) return port;
  close(port);
  return -1;
}

/// A pty in a folder of its own.
class PtyClients : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(mkdtemp(folder_.data()));
    std::string why;
    pty_ = Pty::open(link(), k8E1, why);
    ASSERT_TRUE(pty_) << why;
  }
  void TearDown() override {
    pty_.reset();
    EXPECT_TRUE(std::filesystem::remove(folder_));
  }

  std::string link() const { return folder_ + "/plc"; }
  int open_far_side(int how) const { return open(link().c_str(), how | O_NOCTTY | O_NONBLOCK); }

  std::string folder_ = (std::filesystem::temp_directory_path() / "s7200-pty-XXXXXX").string();
  std::unique_ptr<Pty> pty_;
};

TEST_F(PtyClients, EachMaySetTheSameParity) {
  for (int client = 1; client <= 3; ++client) {
    const int port = open_and_set(link());
    EXPECT_GE(port, 0) << "client " << client;
    EXPECT_EQ(pty_->settings().baud, 9600U);
    if (port >= 0) close(port);
    pty_->look();
  }
}

TEST_F(PtyClients, AreCountedWhoeverComesAndGoesBetweenTwoLooks) {
  for (const int second : {O_RDONLY, O_WRONLY, O_RDWR}) {
    const int one = open_far_side(O_RDONLY), two = open_far_side(second);
    close(one);
    close(two);
    const int stays = open_far_side(O_RDWR);
    pty_->look();
    EXPECT_EQ(pty_->open_now(), 1);
    close(stays);
    pty_->look();
    EXPECT_EQ(pty_->open_now(), 0);
  }
  EXPECT_EQ(pty_->opened_ever(), 9U);
}

TEST_F(PtyClients, OneIsServedAlthoughTheSystemHasForgottenHowManyCame) {
  for (int i = 0; i < 20'000; ++i) close(open_far_side(O_RDWR));  // more than max_queued_events, see inotify(7)
  const int stays = open_far_side(O_RDWR);
  pty_->look();
  EXPECT_GE(pty_->open_now(), 1);
  close(stays);
}

}  // namespace
}  // namespace s7200::tools
