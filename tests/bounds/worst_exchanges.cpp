// Sends a Modbus slave requests by chance, and compares the longest time from the last character of one to the first of its
// answer with the bound, and the longest scan with its: `worst_exchanges slave|tip|plant EXCHANGES SEED LINE=TIMES…`, loops
// as of `s7200 inspect --loop`. The plant is dosing_plant.stl with our slave below it, whose lines are meant; its inputs and
// weights change by chance too.
//
// Requests are long and short, of all functions, whole or with more characters in front of their CRC, with values that make
// the division for the CRC long or any, and go to registers with any content. Ends with 1 if an exchange took longer than
// the bound.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "interpreter/analysis/bounds.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "tests/support/inspected.hpp"
#include "tests/support/source_path.hpp"
#include "tests/support/tip41.hpp"
#include "tools/trials/chance.hpp"
#include "tools/trials/trial_bench.hpp"

namespace s7200::test {
namespace {

using tools::Chance;
using tools::Stimulus;
using tools::TrialBench;

constexpr int kSkipped = 4;
constexpr std::size_t kLongestFrame = 256;
constexpr std::uint32_t kRegisterBytes = 2000;
constexpr Time kBetween = 30 * kMillisecond, kJitter = 4 * kMillisecond;
constexpr std::string_view kEndOfMain = "\nMEND\n";

void add_word(Bytes& frame, std::uint64_t word) {
  frame.push_back(static_cast<std::uint8_t>(word >> 8));
  frame.push_back(static_cast<std::uint8_t>(word));
}

/// The next byte of a frame, for which a division that treats odd values apart takes longest.
std::uint8_t odd_in_crc(const Bytes& frame, Chance& chance) {
  const auto byte = static_cast<std::uint8_t>(chance.byte() & 0xFE);
  return static_cast<std::uint8_t>(byte | (~modbus::crc16(frame) & 1));
}

/// A request for station 1, mostly one that is answered, and now and then as much as one can ask for.
Bytes request(Chance& chance) {
  constexpr std::uint8_t kFunctions[]{1, 2, 3, 3, 4, 5, 6, 15, 16, 16};
  const std::uint8_t function = chance.one_of(kFunctions);
  Bytes frame{1, function};
  const bool most = chance.one_in(4);
  const bool coils = function <= 2 || function == 5 || function == 15;
  const std::uint64_t limit = coils ? 64 : function == 4 ? 16 : function == 16 ? 123 : 125;
  const std::uint64_t quantity = most ? limit : 1 + chance.below(limit);
  add_word(frame, chance.below(most ? 1 : coils ? 65 - quantity : 1000 - limit));
  if (function == 5)
    add_word(frame, chance.one_in(2) ? 0xFF00 : 0);
  else
    add_word(frame, function == 6 ? chance.draw() : quantity);
  if (function >= 15) {
    const std::uint64_t bytes = function == 15 ? (quantity + 7) / 8 : 2 * quantity;
    frame.push_back(static_cast<std::uint8_t>(bytes));
    const bool odd = chance.one_in(2);
    for (std::uint64_t i = 0; i < bytes; ++i) frame.push_back(odd ? odd_in_crc(frame, chance) : chance.byte());
  }
  if (chance.one_in(8)) {
    const std::size_t length =
        chance.one_in(2) ? kLongestFrame - 2 : frame.size() + chance.below(kLongestFrame - 2 - frame.size());
    while (frame.size() < length) frame.push_back(chance.byte());
  }
  modbus::add_crc(frame);
  return frame;
}

class Exchanges {
 public:
  Exchanges(std::shared_ptr<const Program> program, std::uint64_t seed, bool moves_inputs)
      : bench_(std::move(program), 0), chance_(seed), moves_inputs_(moves_inputs) {
    bench_.power_up();
    bench_.run_until(2 * kSecond);
  }

  void run(std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (i % 64 == 0) fill_registers();
      bench_.run_until(bench_.time() + kBetween + static_cast<Time>(chance_.below(kJitter)));
      if (moves_inputs_) move_inputs();
      one(request(chance_));
      if (i % 1024 == 1023) forget_what_was_sent();
    }
  }

  Time worst() const { return worst_; }
  Time longest_scan() const { return bench_.cpu().state().longest_scan; }
  bool stopped() const { return bench_.stopped(); }
  std::uint64_t answered() const { return answered_; }
  std::string worst_request() const {
    const Bytes head(request_.begin(), request_.begin() + 6);
    return fmt::format("{:02x} … of {} characters", fmt::join(head, " "), request_.size());
  }

 private:
  void fill_registers() {
    Bytes content(kRegisterBytes);
    for (std::uint8_t& byte : content) byte = chance_.byte();
    bench_.poke(image::kV, content);
  }

  /// Most inputs keep what lets the plant go on.
  void move_inputs() {
    const auto input = [&](std::uint32_t place, int byte) {
      bench_.apply({.what = Stimulus::What::Input, .place = place, .bytes = {static_cast<std::uint8_t>(byte)}},
                   bench_.time());
    };
    input(0, chance_.one_in(8) ? chance_.byte() : 0x18 | (chance_.byte() & 0x21));
    input(1, chance_.one_in(8) ? chance_.byte() : 0x0F);
    for (std::uint32_t word = 0; word < 4; ++word) bench_.poke(image::kAI + 2 * word, {chance_.byte(), chance_.byte()});
  }

  void one(const Bytes& frame) {
    const SerialFormat format = bench_.format();
    const Time last = bench_.time() + static_cast<Time>(frame.size() - 1) * format.character_time();
    const Time end = last + format.half_bits(2 * (format.bits() - format.stop_bits) + 1);  // when it is reported
    const std::size_t before = bench_.done().sent.size();
    bench_.apply({.what = Stimulus::What::Frame, .bytes = frame}, bench_.time());
    for (Time waited = 0; waited < kSecond && bench_.done().sent.size() == before; waited += tools::kPatience)
      bench_.run_until(bench_.time() + tools::kPatience);
    if (bench_.done().sent.size() == before) return;
    bench_.run_until(bench_.time() + kSecond / 2);
    ++answered_;
    const Time took = bench_.done().sent[before].at - end;
    if (took <= worst_) return;
    worst_ = took;
    request_ = frame;
  }

  void forget_what_was_sent() {
    TrialBench::Snapshot now = bench_.snapshot();
    now.done = {};
    bench_.restore(now);
  }

  TrialBench bench_;
  Chance chance_;
  bool moves_inputs_;
  Time worst_ = 0;
  std::uint64_t answered_ = 0;
  Bytes request_{};
};

/// Our slave below the plant. `below`: how many lines further down that of the slave stand.
std::string plant_with_slave(std::ptrdiff_t& below) {
  const std::string plant = text_of(source_path("tests/bounds/dosing_plant.stl")), slave = slave_text();
  const std::size_t end = slave.find(kEndOfMain) + kEndOfMain.size();
  const auto lines = [](std::string_view text) { return std::ranges::count(text, '\n'); };
  below = lines(plant) - lines(std::string_view(slave).substr(0, end));
  return plant + slave.substr(end);
}

StatedLoops loops_of(const Program& program, std::ptrdiff_t below, int count, char** texts) {
  StatedLoops stated;
  for (int i = 0; i < count; ++i) {
    char* end = nullptr;
    const auto line = static_cast<std::size_t>(std::strtol(texts[i], &end, 10) + below);
    for (std::uint32_t op = 0; op < program.ops.size(); ++op)
      if (is_loop(program, op) && program.statement(op).position.line == line)
        stated[op] = std::strtol(end + 1, nullptr, 10);
  }
  return stated;
}

int compare_with_bound(int count, char** words) {
  const bool tip = std::string(words[1]) == "tip", plant = std::string(words[1]) == "plant";
  if (tip && !tip41::available()) {
    fmt::print("Application Tip 41 is not here\n");
    return kSkipped;
  }
  std::ptrdiff_t below = 0;
  const std::string text = tip ? tip41::text() : plant ? plant_with_slave(below) : slave_text();
  const tools::Inspection inspection = inspected(text, {}, *find_cpu("214"));
  const Program& program = *inspection.program;
  const Bounds bounds = bounds_of(inspection.facts, calls_of(program, inspection.facts.flow), program,
                                  loops_of(program, below, count - 4, words + 4));
  Exchanges exchanges(inspection.program, std::strtoull(words[3], nullptr, 10), plant);
  exchanges.run(std::strtoull(words[2], nullptr, 10));
  if (bounds.answers.empty() || !bounds.answers.front().time || !bounds.answers.front().loops.empty() ||
      exchanges.answered() == 0) {
    fmt::print("no bound, or no answer\n");
    return 1;
  }
  const Time bound = *bounds.answers.front().time;
  fmt::print("{} answers; the longest took {} at {}; the bound is {}, {:.1f} % above it\n", exchanges.answered(),
             format_duration(exchanges.worst()), exchanges.worst_request(), format_duration(bound),
             100.0 * static_cast<double>(bound - exchanges.worst()) / static_cast<double>(exchanges.worst()));
  const Time scan = bounds.scan_with_interrupts.value_or(0);
  fmt::print("{} instructions; the longest scan took {}; the bound is {}{}\n", program.ops.size(),
             format_duration(exchanges.longest_scan()), format_duration(scan),
             exchanges.stopped() ? "; it has stopped" : "");
  const bool holds = exchanges.worst() <= bound && exchanges.longest_scan() <= scan;
  return holds && !exchanges.stopped() ? 0 : 1;
}

}  // namespace
}  // namespace s7200::test

int main(int count, char** words) {
  if (count < 4) {
    fmt::print(stderr, "usage: worst_exchanges slave|tip|plant EXCHANGES SEED LINE=TIMES...\n");
    return 2;
  }
  return s7200::test::compare_with_bound(count, words);
}
