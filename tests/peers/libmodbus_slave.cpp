// A Modbus RTU slave made with libmodbus: libmodbus_slave LINK. Station 1, 9600 baud 8E1. Register n holds 1000 + n until it
// is written. Says "asked" at each request. Serves until its standard input ends, then shows registers 0 to 39 on one line.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <modbus/modbus.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>

namespace {

constexpr int kPoints = 1000;

struct Close {
  void operator()(modbus_t* port) const {
    modbus_close(port);
    modbus_free(port);
  }
  void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
};

/// Whether a request may be on its way; false when standard input has ended.
bool wait_for_request(int line) {
  std::array<pollfd, 2> waits{{{line, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}}};
  while (poll(waits.data(), waits.size(), -1) < 0) {
  }
  return (waits[1].revents & (POLLIN | POLLHUP)) == 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::unique_ptr<modbus_t, Close> port(modbus_new_rtu(arguments[1], 9600, 'E', 8, 1));
  const std::unique_ptr<modbus_mapping_t, Close> memory(modbus_mapping_new(kPoints, kPoints, kPoints, kPoints));
  if (!port || !memory || modbus_set_slave(port.get(), 1) != 0 || modbus_connect(port.get()) != 0) {
    fmt::print(stderr, "{}\n", modbus_strerror(errno));
    return 1;
  }
  for (int i = 0; i < kPoints; ++i) memory->tab_registers[i] = static_cast<std::uint16_t>(1000 + i);
  std::array<std::uint8_t, MODBUS_RTU_MAX_ADU_LENGTH> request{};
  while (wait_for_request(modbus_get_socket(port.get()))) {
    const int length = modbus_receive(port.get(), request.data());
    if (length <= 0) continue;
    modbus_reply(port.get(), request.data(), length, memory.get());
    fmt::print("asked\n");
    std::fflush(stdout);
  }
  fmt::print("{}\n", fmt::join(std::span(memory->tab_registers, 40), " "));
}
