// Any characters and gaps at a port in PPI mode: requests for a CPU, or answers to one that is a master itself. Promises: a
// CPU says nothing but whole frames, memory that no request can name is left alone, and after a second of silence it answers
// a request for its status; as a master it ends every job, and begins the next.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "interpreter/base/ppi_frame.hpp"
#include "tests/support/ppi_master.hpp"

namespace s7200::test::ppi {
namespace {

void must(bool promise) {
  if (!promise) std::abort();
}

class Script {
 public:
  explicit Script(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool over() const { return bytes_.empty(); }
  std::uint8_t byte() {
    const std::uint8_t first = bytes_.empty() ? std::uint8_t{0} : bytes_[0];
    bytes_ = bytes_.subspan(bytes_.empty() ? 0 : 1);
    return first;
  }

  /// So many bytes, as they stand or as the PDU of a right frame, or a good frame with one bit changed.
  Bytes frame(const Bytes& good, std::uint8_t to, std::uint8_t from, std::uint8_t function) {
    const std::uint8_t kind = byte();
    if (kind % 4 == 3) return good;
    if (kind % 4 == 2) {
      Bytes changed = good;
      const std::uint8_t bit = byte();
      changed[byte() % changed.size()] ^= static_cast<std::uint8_t>(1U << bit % 8);
      return changed;
    }
    Bytes bytes;
    for (int count = byte() % 64; count > 0 && !over(); --count) bytes.push_back(byte());
    return kind % 4 == 0 ? bytes : sd2(to, from, function, bytes);
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

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

/// A CPU that reads 4 bytes of station 3 again and again. What it gets for an answer is the script's.
void answer_a_cpu(Script script) {
  Plc plc(
      "LD SM0.1\nMOVB 2, SMB30\nMOVB 3, VB101\nMOVD &VB200, VD102\nMOVB 4, VB106\nLDN V100.6\nNETR VB100, 0\nINCW VW1000\n"
      "MEND\n");
  const Bytes good =
      sd2(2, 3, 0x08, joined({{0x32, 3, 0, 0, 0, 1, 0, 2, 0, 8, 0, 0, 0x04, 1, 0xFF, 0x04, 0, 32}, {1, 2, 3, 4}}));
  for (int replies = 0; replies < 40 && !script.over(); ++replies) {
    plc.port.sent.clear();
    for (int waited = 0; waited < 200 && plc.port.sent.empty(); ++waited) plc.run_until(plc.cpu.time() + ms);
    if (plc.port.sent.empty()) break;
    plc.run_until(plc.port.sent.back().at + 2 * kCharacter);
    Bytes reply = script.frame(good, 2, 3, 0x08);
    if (script.byte() % 2 == 0) reply = {0xE5};
    Time start = plc.cpu.time() + 11 * kBit;
    for (const std::uint8_t byte : reply) {
      plc.received_at({.byte = byte, .start = start, .end = start + 10 * kBit + kBit / 2});
      start += kCharacter;
    }
    plc.run_until(start);
  }
  const auto jobs = plc.value("VW1000");
  plc.run_until(plc.cpu.time() + 10 * kSecond);
  must(plc.value("VW1000") != jobs);
  must(plc.cpu.state().image[image::kV + 111] == 0);
}

}  // namespace
}  // namespace s7200::test::ppi

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace s7200::test::ppi;
  if (size == 0) return 0;
  const Script script({data + 1, size - 1});
  data[0] % 2 == 0 ? ask_a_cpu(script) : answer_a_cpu(script);
  return 0;
}
