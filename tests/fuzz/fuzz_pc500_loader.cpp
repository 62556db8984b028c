// A PC503 at its loader port: what it says is one of the steps of a session.
#include <algorithm>

#include "serial_sim/westinghouse/loader_session.hpp"
#include "tests/fuzz/westinghouse_world.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace s7200;
  using namespace s7200::westinghouse;
  test::WestinghouseWorld(
      {.name = "pc500-loader",
       .request = {kStx},
       .right_answer =
           [](auto answer) {
             return std::ranges::equal(answer, Bytes{kDle, kAck});
           },
       .form = [](auto answer) { return is_whole_step(answer) && answer.size() <= 2 * (kMostLoaderBytes + 8); }})
      .run({data, size});
  return 0;
}
