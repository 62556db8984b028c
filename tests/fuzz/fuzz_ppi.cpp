// Any characters and gaps at a port in PPI mode: requests for a CPU. Promises: it says nothing but whole frames, memory that
// no request can name is left alone, and after a second of silence it answers a request for its status.
#include "interpreter/base/ppi_frame.hpp"
#include "tests/fuzz/ppi_script.hpp"

namespace s7200::test::ppi {
namespace {

bool is_whole(const Bytes& said) {
  for (std::span<const std::uint8_t> rest = said; !rest.empty();) {
    const auto length = s7200::ppi::frame_length(rest);
    if (!length || *length == 0 || *length > rest.size()) return false;
    rest = rest.subspan(*length);
  }
  return true;
}

const Bytes kStatus = sd1(2, 0, 0x49), kIsSlave = sd1(0, 2, 0x00);

/// A CPU whose program leaves its port alone.
void ask_a_cpu(Script script) {
  Plc plc("LD SM0.0\nMOVW VW0, VW0\nMEND\n");
  Master master(plc);
  const Bytes good = sd2(2, 0, 0x6C, reading({variable(2, 4, 0x84, 800, 1)}));
  for (int frames = 0; frames < 20 && !script.over(); ++frames) {
    must(is_whole(master.say(script.frame(good, 2, 0, 0x6C))));
    must(is_whole(master.say(sd1(2, 0, frames % 2 == 0 ? 0x5C : 0x7C))));
  }
  plc.run_until(plc.cpu.time() + kSecond);
  must(master.say(kStatus) == kIsSlave);
}

}  // namespace
}  // namespace s7200::test::ppi

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace s7200::test::ppi;
  ask_a_cpu(Script({data, size}));
  return 0;
}
