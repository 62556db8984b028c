// Programs that open and set the far side of a pty as they would a serial port.
#include "tools/host/posix/pty.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace s7200::tools::pty_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};

/// As pyserial does it: everything at once.
bool set_even_parity(int port) {
  termios settings{};
  tcgetattr(port, &settings);
  cfmakeraw(&settings);
  cfsetspeed(&settings, B9600);
  settings.c_cflag |= CLOCAL | CREAD | PARENB;
  return tcsetattr(port, TCSANOW, &settings) == 0;
}

/// The port, or -1.
int open_and_set(const std::string& path) {
  const int port = open(path.c_str(), O_RDWR | O_NOCTTY);
  if (set_even_parity(port)) return port;
  close(port);
  return -1;
}

/// A pty in a folder of its own.
class PtyClients : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(mkdtemp(folder_.data()));
    auto pty = Pty::open(link(), k8E1);
    ASSERT_TRUE(pty) << pty.why();
    pty_ = *std::move(pty);
  }
  void TearDown() override {
    pty_.reset();
    EXPECT_TRUE(std::filesystem::remove(folder_));
  }

  std::string link() const { return folder_ + "/plc"; }
  /// Waits until the link leads to another port than this one.
  void await_another_than(int port) const {
    std::array<char, 64> name{};
    ASSERT_EQ(ttyname_r(port, name.data(), name.size()), 0);
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::filesystem::read_symlink(link()).lexically_normal() == name.data())
      ASSERT_LT(std::chrono::steady_clock::now(), until);
  }
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

TEST_F(PtyClients, AreNeverRefusedTheirParityHoweverOftenTheyComeBack) {
  for (int client = 1; client <= 5000; ++client) {
    const int port = open_and_set(link());
    ASSERT_GE(port, 0) << "client " << client;
    await_another_than(port);
    close(port);
  }
}

TEST_F(PtyClients, AreNeverRefusedTheirParityWhileOthersSetTheirs) {
  std::mutex opening;
  std::atomic<int> refused = 0;
  const auto come_and_go = [&] {
    for (int client = 1; client <= 2000; ++client) {
      int port = -1;
      {
        const std::lock_guard lock(opening);
        port = open_far_side(O_RDWR);
        await_another_than(port);
      }
      refused += set_even_parity(port) ? 0 : 1;
      close(port);
    }
  };
  std::vector<std::thread> clients;
  for (int i = 0; i < 3; ++i) clients.emplace_back(come_and_go);
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(refused, 0);
}

TEST_F(PtyClients, FindTheirSettingsAsTheyMadeThem) {
  const int port = open_and_set(link());
  const auto before = std::chrono::steady_clock::now();
  termios made{}, found{};
  ASSERT_EQ(tcgetattr(port, &made), 0);
  for (int i = 0; i < 1000; ++i) {
    close(open_far_side(O_RDWR));  // others come and go
    pty_->look();
    ASSERT_EQ(tcgetattr(port, &found), 0);
    if (std::chrono::steady_clock::now() - before > std::chrono::milliseconds(900)) break;
    ASSERT_EQ(found.c_cflag, made.c_cflag);
    ASSERT_EQ(found.c_lflag, made.c_lflag);
  }
  close(port);
}

TEST_F(PtyClients, MaySetTheSameParityAgainASecondLater) {
  const int port = open_and_set(link());
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!set_even_parity(port)) {
    ASSERT_LT(std::chrono::steady_clock::now(), until);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    pty_->look();
  }
  close(port);
}

TEST_F(PtyClients, FindThePortAsTheLastOneLeftIt) {
  const int port = open_and_set(link());
  termios settings{};
  tcgetattr(port, &settings);
  cfsetspeed(&settings, B19200);
  settings.c_cflag |= PARODD;
  tcsetattr(port, TCSANOW, &settings);
  close(port);
  pty_->look();
  const int next = open_far_side(O_RDWR);
  pty_->look();
  EXPECT_EQ(pty_->settings().baud, 19200U);
  EXPECT_EQ(pty_->settings().parity, Parity::Odd);
  close(next);
}

TEST_F(PtyClients, ShareAPortWhenThereIsNoOther) {
  std::vector<int> open;
  for (int client = 0; client < 70; ++client) {
    open.push_back(open_far_side(O_RDWR));
    EXPECT_GE(open.back(), 0);
    pty_->look();
  }
  EXPECT_EQ(pty_->open_now(), 70);
  EXPECT_EQ(pty_->port_count(), 64U);
  for (const int port : open) close(port);
  pty_->look();
  EXPECT_EQ(pty_->open_now(), 0);
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
}  // namespace s7200::tools::pty_test
