// The Modbus personality of the simulated PLCs.
#include <algorithm>

#include "serial_sim/modbus/crc.hpp"
#include "tests/fuzz/westinghouse_world.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace s7200;
  const Bytes loopback{0x01, 0x08, 0x00, 0x00, 0x34, 0x12, 0x76, 0xC6};
  test::WestinghouseWorld(
      {.name = "modbus",
       .request = loopback,
       .right_answer = [&](auto answer) { return std::ranges::equal(answer, loopback); },
       .form = [](auto answer) { return modbus::crc_ok(answer) && answer[0] == 1 && answer.size() <= 259; }})
      .run({data, size});
  return 0;
}
