// A PLC on the PC1000 LAN.
#include <algorithm>

#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "tests/fuzz/westinghouse_world.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace s7200;
  using namespace s7200::westinghouse;
  test::WestinghouseWorld({.name = "pc1000-lan",
                           .request = set_unit_address(5),
                           .right_answer =
                               [](auto answer) {
                                 return std::ranges::equal(answer, Bytes{0x0A, 0x05, 0x01, 0x00, 0x00, 0x10});
                               },
                           .form =
                               [](auto answer) {
                                 const auto head = answer.first(std::min<std::size_t>(answer.size(), 5));
                                 const auto block = answer.subspan(std::min<std::size_t>(answer.size(), 6));
                                 return is_whole_answer(answer) && sum(head) == answer[5] &&
                                        (block.empty() || sum(block.first(block.size() - 1)) == block.back());
                               },
                           .sync = true})
      .run({data, size});
  return 0;
}
