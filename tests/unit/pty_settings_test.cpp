// Programs that set the far side of a pty as they would set a serial port.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <filesystem>

#include "tools/pty.hpp"

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

TEST(PtySettings, EveryClientMaySetTheSameParity) {
  std::string why, folder = (std::filesystem::temp_directory_path() / "s7200-pty-XXXXXX").string();
  ASSERT_TRUE(mkdtemp(folder.data()));
  {
    const auto pty = Pty::open(folder + "/plc", k8E1, why);
    ASSERT_TRUE(pty) << why;
    for (int client = 1; client <= 3; ++client) {
      const int port = open_and_set(folder + "/plc");
      EXPECT_GE(port, 0) << "client " << client;
      EXPECT_EQ(pty->settings().baud, 9600U);
      if (port >= 0) close(port);
      pty->look();
    }
  }
  EXPECT_TRUE(std::filesystem::remove(folder));
}

}  // namespace
}  // namespace s7200::tools
