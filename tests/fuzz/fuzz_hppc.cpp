// An HPPC at its loader port.
#include <algorithm>

#include "serial_sim/westinghouse/messages/hppc_message.hpp"
#include "tests/fuzz/westinghouse_world.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace s7200;
  using namespace s7200::westinghouse;
  const Bytes resync = hppc_message(kIop, kApl, HppcOpcode::Read, hppc_read(0, 0), FcsTable::Document);
  const Bytes in_step = hppc_message(kApl, 0, HppcOpcode::Read, Bytes{0}, FcsTable::Document);
  test::WestinghouseWorld(
      {.name = "hppc",
       .request = resync,
       .right_answer = [&](auto answer) { return std::ranges::equal(answer, in_step); },
       .form = [](auto answer) { return is_whole_hppc(answer) && hppc_fcs(answer, FcsTable::Document) == 0; }})
      .run({data, size});
  return 0;
}
