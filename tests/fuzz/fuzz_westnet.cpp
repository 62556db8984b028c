// Westnet II: a computer's own PCI and a PLC at another drop.
#include <algorithm>

#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "tests/fuzz/westinghouse_world.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace s7200;
  using namespace s7200::westinghouse;
  test::WestinghouseWorld(
      {.name = "westnet",
       .request = highway(HighwayCommand::ReadLocalAddress),
       .right_answer =
           [](auto answer) { return std::ranges::equal(answer, highway(HighwayCommand::ReadLocalAddress, 0, 1)); },
       .form =
           [](auto answer) {
             return is_whole_answer(answer) && (answer[0] == kHighwayError || sum(answer.first(5)) == answer[5]);
           }})
      .run({data, size});
  return 0;
}
