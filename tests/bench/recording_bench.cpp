// How fast recordings are read: `recording_bench [MEGABYTES]`, from build/release. The same exchanges in each form, of 1 to
// 29 registers, read, judged and put into words as `s7200 decode` does.
#include <fmt/format.h>
#include <sys/resource.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/decoded.hpp"

namespace {

using namespace s7200;
using namespace s7200::tools;

struct Row {
  std::size_t number = 0;
  bool sent = false;
  std::uint8_t unit = 1;
  Bytes pdu{};

  Bytes frame() const { return modbus::rtu_frame(unit, pdu); }
  std::string hex() const { return serial::to_hex(frame()); }
  /// A day has room for all.
  std::string clock() const {
    const std::size_t ms = 25 * number;
    return fmt::format("{:02}:{:02}:{:02}.{:03}", ms / 3'600'000 % 24, ms / 60'000 % 60, ms / 1000 % 60, ms % 1000);
  }
};

Row row(std::size_t number) {
  const std::size_t exchange = number / 2, registers = 1 + exchange % 29;
  Row row{.number = number, .sent = number % 2 == 0};
  if (row.sent) {
    row.pdu =
        modbus::read_holding_registers(static_cast<std::uint16_t>(exchange % 1000), static_cast<std::uint16_t>(registers));
  } else {
    row.pdu = {3, static_cast<std::uint8_t>(2 * registers)};
    for (std::size_t i = 0; i < 2 * registers; ++i) row.pdu.push_back(static_cast<std::uint8_t>(7 * exchange + 31 * i));
  }
  return row;
}

std::string dump(const Row& row) {
  const Bytes frame = row.frame();
  std::string text = fmt::format("{}  {} length={}\n", row.clock(), row.sent ? ">" : "<", frame.size());
  constexpr std::size_t kInRow = 16;
  for (std::size_t at = 0; at < frame.size(); at += kInRow) {
    const auto part = std::span(frame).subspan(at, std::min(kInRow, frame.size() - at));
    text += fmt::format("{:04x}  {:<47}  |", at, serial::to_hex(part));
    for (const std::uint8_t byte : part) text += byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '.';
    text += "|\n";
  }
  return text;
}

std::string characters(const Row& row) {
  std::string text;
  const Bytes frame = row.frame();
  for (std::size_t i = 0; i < frame.size(); ++i)
    text += fmt::format("{:.6f},0x{:02X},,\n", 0.1 * static_cast<double>(row.number) + 0.001146 * static_cast<double>(i),
                        frame[i]);
  return text;
}

struct Form {
  const char* name;
  std::string head;
  std::function<std::string(const Row&)> text;
};
const std::array kForms{
    Form{"hex with times", "",
         [](const Row& r) { return fmt::format("{} {} {}\n", r.clock(), r.sent ? "TX" : "RX", r.hex()); }},
    Form{"hex alone", "", [](const Row& r) { return r.hex() + "\n"; }},
    Form{"hex with characters beside it", "", dump},
    Form{"Modbus TCP in hex", "",
         [](const Row& r) {
           return fmt::format("{} {} {}\n", r.clock(), r.sent ? "TX" : "RX",
                              serial::to_hex(modbus::to_bytes({static_cast<std::uint16_t>(r.number / 2), r.unit, r.pdu})));
         }},
    Form{"CSV of frames", "Time,Direction,Data\n",
         [](const Row& r) { return fmt::format("{},{},{}\n", r.clock(), r.sent ? "TX" : "RX", r.hex()); }},
    Form{"CSV of characters", "Time [s],Value,Parity Error,Framing Error\n", characters},
    Form{"JSON", "",
         [](const Row& r) {
           return fmt::format("{{\"time\": \"{}\", \"direction\": \"{}\", \"data\": \"{}\"}}\n", r.clock(),
                              r.sent ? "tx" : "rx", r.hex());
         }},
    Form{"key=value", "",
         [](const Row& r) { return fmt::format("time={} dir={} data=\"{}\"\n", r.clock(), r.sent ? "tx" : "rx", r.hex()); }},
    Form{"text without bytes", "", [](const Row& r) { return fmt::format("{} nothing to tell of\n", r.clock()); }},
    Form{"line ends", "", [](const Row&) { return "\n"; }},
};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void measure(const Form& form, std::size_t bytes) {
  std::string text = form.head;
  for (std::size_t number = 0; text.size() < bytes; ++number) text += form.text(row(number));
  const RecordedProtocol& protocol = *find_recorded_protocol("modbus");
  const double before = processor_seconds();
  std::size_t frames = 0, right = 0, said = 0;
  if (auto recording = read_recording(text, {})) {
    const Stamps stamps{.character = recording->over_tcp ? 0 : SerialFormat{}.character_time()};
    settle_directions(*recording, protocol, stamps);
    tell_conversation(*recording, protocol, stamps, [&](const ReadFrame& frame) {
      ++frames;
      right += frame.right;
      said += decoded_text(frame, false, false).size();
      return true;
    });
  }
  const double seconds = processor_seconds() - before;
  fmt::print("{:<32}{:>8.0f} MB/s  {:>8} frames, {} right\n", form.name, static_cast<double>(text.size()) / 1e6 / seconds,
             frames, right);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t megabytes = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 30;
  for (const Form& form : kForms) measure(form, megabytes * 1'000'000);
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  fmt::print("{} MB of memory at most, with the text\n", used.ru_maxrss / 1024);
  return EXIT_SUCCESS;
}
