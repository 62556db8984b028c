// Any characters, gaps and sync edges for a simulated PLC, without a line. Promises: it says something only after it was
// told something, what it says has the form of its protocol and begins no earlier than now, a copy of it goes on as it does,
// and after a second of silence a good request has its right answer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "serial_sim/westinghouse/plcs.hpp"

namespace s7200::test {

class WestinghouseWorld {
 public:
  using Data = std::span<const std::uint8_t>;

  struct Protocol {
    std::string_view name;
    Bytes request;                           ///< a good one
    std::function<bool(Data)> right_answer;  ///< to it
    std::function<bool(Data)> form;          ///< of any answer
    bool sync = false;                       ///< characters need it
  };

  explicit WestinghouseWorld(const Protocol& protocol)
      : protocol_(protocol), plc_(westinghouse::find_plc(protocol.name)->make()) {}

  void run(Data script) {
    const auto byte = [&] {
      const std::uint8_t first = script.empty() ? std::uint8_t{0} : script[0];
      script = script.subspan(script.empty() ? 0 : 1);
      return first;
    };
    while (!script.empty()) {
      const std::uint8_t operation = byte();
      switch (operation & 7) {
        case 0:
        case 1:
          for (int count = byte() % 40; count > 0 && !script.empty(); --count) hear(byte(), 0);
          break;
        case 2:
          hear(byte(), operation);
          break;
        case 3:
          pass((1 + byte()) * 4 * kMillisecond);
          break;
        case 4:
          sync((operation & 8) != 0);
          break;
        case 5:  // the good request, or its beginning, with one byte changed
          send(byte(), byte(), byte());
          break;
        case 6:
          check_copy();
          break;
        case 7:
          sync(true);
          send(0xFF, 0xFF, 0);
          sync(false);
          break;
      }
    }
    sync(false);
    pass(11 * kSecond);
    last_.clear();
    sync(true);
    send(0xFF, 0xFF, 0);
    sync(false);
    pass(kSecond);
    must(protocol_.right_answer(last_));
  }

 private:
  static void must(bool promise) {
    if (!promise) std::abort();
  }

  void sync(bool high) {
    if (protocol_.sync) plc_->sync(high, now_);
    look();
  }

  void send(std::uint8_t length, std::uint8_t place, std::uint8_t change) {
    for (std::size_t i = 0; i < protocol_.request.size() && i < length; ++i)
      hear(static_cast<std::uint8_t>(protocol_.request[i] ^ (i == place ? change : 0)), 0);
  }

  void hear(std::uint8_t byte, std::uint8_t errors) {
    const SerialFormat format = plc_->format();
    ReceivedCharacter character{.byte = byte, .parity_error = (errors & 8) != 0, .framing_error = (errors & 16) != 0};
    character.start = now_;
    character.end = now_ + format.character_time() - format.bit_times(1);
    pass(format.character_time() - format.bit_times(1), true);
    plc_->hear(character);
    look();
    pass(format.bit_times(1));
  }

  /// `receiving`: time-outs wait for the character that is coming in.
  void pass(Time time, bool receiving = false) {
    const Time end = now_ + time;
    while (!receiving && plc_->due() <= end) {
      must(plc_->due() >= 0);
      now_ = std::max(now_, plc_->due());
      plc_->wake(now_);
      must(plc_->due() > now_ || plc_->due() == kNever);
      look();
    }
    now_ = end;
  }

  void look() {
    plc_->take_abort();
    const auto answer = plc_->take_answer();
    if (!answer) return;
    must(!answer->bytes.empty() && answer->at >= now_);
    must(protocol_.form(answer->bytes));
    last_ = answer->bytes;
  }

  void check_copy() {
    const auto copy = plc_->clone();
    must(copy->equals(*plc_) && plc_->equals(*copy));
    must(copy->due() == plc_->due());
  }

  Protocol protocol_;
  std::unique_ptr<westinghouse::Plc> plc_;
  Time now_ = 0;
  Bytes last_;
};

}  // namespace s7200::test
