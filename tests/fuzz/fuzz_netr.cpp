// Any characters and gaps for an answer to a CPU that is a PPI master: it reads with NETR and writes with NETW, as many
// bytes as the first byte of the input says. Promises: every job ends, and the next begins; of a table nothing changes but
// its status, its error and the data that were read; what is written stays as it is.
#include "tests/fuzz/ppi_script.hpp"

namespace s7200::test::ppi {
namespace {

constexpr unsigned kMostBytes = 16;
constexpr std::size_t kFunction = 17;  // of a request: after the frame's 7 bytes and the 10 of the S7 header

/// Tables at VB100 and VB130; the jobs that were begun are counted in VW1000 and VW1002.
std::string program(unsigned read, unsigned written) {
  const auto table = [](unsigned at, unsigned bytes) {
    return "MOVB 3, VB" + std::to_string(at + 1) + "\nMOVD &VB200, VD" + std::to_string(at + 2) + "\nMOVB " +
           std::to_string(bytes) + ", VB" + std::to_string(at + 6) + "\n";
  };
  return "LD SM0.1\nMOVB 2, SMB30\n" + table(100, read) + table(130, written) +
         "LDN V100.6\nNETR VB100, 0\nINCW VW1000\nLDN V130.6\nNETW VB130, 0\nINCW VW1002\nMEND\n";
}

class ReadingMaster {
 public:
  ReadingMaster(unsigned read, unsigned written) : read_(read), written_(written), plc_(program(read, written)) {}

  void run(Script script) {
    for (int replies = 0; replies < 40 && !script.over(); ++replies) {
      plc_.port.sent.clear();
      for (int waited = 0; waited < 200 && plc_.port.sent.empty(); ++waited) plc_.run_until(plc_.cpu.time() + ms);
      if (plc_.port.sent.empty()) break;
      plc_.run_until(plc_.port.sent.back().at + 2 * kCharacter);
      if (plc_.port.sent.size() > kFunction) writes_ = plc_.port.sent[kFunction].byte == 0x05;
      const Bytes reply = script.frame(writes_ ? right_answer_to_write() : right_answer_to_read(), 2, 3, 0x08);
      hear(script.byte() % 2 == 0 ? Bytes{0xE5} : reply);
      look();
    }
    const auto reads = plc_.value("VW1000"), writes = plc_.value("VW1002");
    plc_.run_until(plc_.cpu.time() + 10 * kSecond);
    must(plc_.value("VW1000") != reads && plc_.value("VW1002") != writes);
    look();
  }

 private:
  Bytes right_answer_to_read() const {
    const Bytes data(read_, 0x5A);
    return sd2(2, 3, 0x08,
               joined({{0x32, 3, 0, 0, 0, 1, 0, 2}, word(4 + read_), {0, 0, 0x04, 1, 0xFF, 0x04}, word(8 * read_), data}));
  }
  static Bytes right_answer_to_write() {
    return sd2(2, 3, 0x08, joined({{0x32, 3, 0, 0, 0, 1, 0, 2, 0, 1, 0, 0, 0x05, 1, 0xFF}}));
  }

  void hear(const Bytes& reply) {
    Time start = plc_.cpu.time() + 11 * kBit;
    for (const std::uint8_t byte : reply) {
      plc_.received_at({.byte = byte, .start = start, .end = start + 10 * kBit + kBit / 2});
      start += kCharacter;
    }
    plc_.run_until(start);
  }

  void look() const {
    const auto v = [&](unsigned number) { return plc_.cpu.state().image[image::kV + number]; };
    for (unsigned i = read_; i < kMostBytes; ++i) must(v(107 + i) == 0);
    for (unsigned i = 0; i < kMostBytes; ++i) must(v(137 + i) == 0 && v(200 + i) == 0);
    for (const unsigned table : {100U, 130U}) {
      must(v(table + 1) == 3 && v(table + 6) == (table == 100 ? read_ : written_));
      const unsigned status = v(table);
      must((status & 0xC0) != 0xC0);                       // not done while it is under way
      must((status & 0x0F) == 0 || (status & 0x20) != 0);  // a code of an error is one of an error
    }
  }

  unsigned read_, written_;
  Plc plc_;
  bool writes_ = false;  // the job that is under way
};

}  // namespace
}  // namespace s7200::test::ppi

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace s7200::test::ppi;
  if (size == 0) return 0;
  ReadingMaster(1 + data[0] % 16U, 1 + data[0] / 16U).run(Script({data + 1, size - 1}));
  return 0;
}
