#include "tools/trials/shortened.hpp"

#include <algorithm>

#include "serial_sim/modbus/crc.hpp"

namespace s7200::tools {
namespace {

using What = Stimulus::What;

constexpr std::size_t kFewCharacters = 8;
constexpr Time kAlone = kSecond;  ///< after power-up

class Shortening {
 public:
  Shortening(Trial trial, const std::function<bool(const Trial&)>& holds, std::size_t most)
      : trial_(std::move(trial)), holds_(holds), left_(most) {}

  Trial result() {
    cut_out_of_frames();
    leave_out_stimuli();
    for (std::size_t i = 0; i < trial_.size(); ++i) {
      if (trial_[i].what == What::Frame) cut_frame(i);
      mend_character(i);
      simplify_times(i);
      simplify_bytes(i);
    }
    leave_out_stimuli();
    let_time_pass_instead_of_the_last();
    return std::move(trial_);
  }

 private:
  bool accept(Trial candidate) {
    if (left_ == 0 || candidate == trial_) return false;
    --left_;
    if (!holds_(candidate)) return false;
    trial_ = std::move(candidate);
    return true;
  }

  /// A few characters of one frame alone may be enough, wherever they stand in it.
  void cut_out_of_frames() {
    const std::size_t kept = left_ / 2;
    for (std::size_t length = 1; length <= kFewCharacters; ++length)
      for (const Stimulus& frame : Trial(trial_)) {
        if (frame.what != What::Frame) continue;
        for (std::size_t at = 0; at + length <= frame.bytes.size() && left_ > kept; ++at) {
          Stimulus alone = frame;
          cut(alone, at + length, frame.bytes.size());
          cut(alone, 0, at);
          alone.wait = std::max(frame.wait, kAlone);
          if (accept({alone})) return;
        }
      }
  }

  /// Without its time, or with it at what comes next, or with a second instead: then a program is ready again.
  bool leave_out(std::size_t first, std::size_t count) {
    const auto begin = trial_.begin() + static_cast<std::ptrdiff_t>(first);
    Trial candidate(trial_.begin(), begin);
    candidate.insert(candidate.end(), begin + static_cast<std::ptrdiff_t>(count), trial_.end());
    if (accept(candidate)) return true;
    if (first >= candidate.size()) return false;
    for (std::size_t i = 0; i < count; ++i) candidate[first].wait += trial_[first + i].wait;
    if (accept(candidate)) return true;
    candidate[first].wait += kAlone;
    return accept(std::move(candidate));
  }

  void leave_out_stimuli() {
    for (std::size_t count = std::max<std::size_t>(1, trial_.size() / 2);; count /= 2) {
      for (std::size_t end = trial_.size(); end >= count && end > 0;) {
        const bool shorter = leave_out(end - count, count);
        end = shorter ? std::min(end - count + count, trial_.size()) : end - 1;
        if (shorter && end < count) break;
      }
      if (count <= 1) return;
    }
  }

  /// Where time alone leads there, the last stimulus only says how long that takes: it leaves the inputs as they are.
  void let_time_pass_instead_of_the_last() {
    if (trial_.empty()) return;
    std::uint8_t levels = 0;
    for (auto one = trial_.begin(); one + 1 != trial_.end(); ++one)
      if (one->what == What::Input && one->place == 0) levels = one->bytes.front();
    Trial candidate = trial_;
    candidate.back() = {.wait = trial_.back().wait, .what = What::Input, .bytes = {levels}};
    if (accept(std::move(candidate))) simplify_times(trial_.size() - 1);
  }

  /// Takes characters out of a frame; the damaged one stays the same one, if it stays.
  static void cut(Stimulus& frame, std::size_t from, std::size_t to) {
    const auto begin = frame.bytes.begin();
    frame.bytes.erase(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(to));
    if (frame.damaged > to)
      frame.damaged = static_cast<std::uint16_t>(frame.damaged - (to - from));
    else if (frame.damaged > from)
      mend(frame);
  }

  static void mend(Stimulus& frame) {
    frame.damaged = 0;
    frame.bad_stop = false;
  }

  bool accept_at(std::size_t i, Stimulus stimulus) {
    if (stimulus.bytes.empty()) return false;
    Trial candidate = trial_;
    candidate[i] = std::move(stimulus);
    return accept(std::move(candidate));
  }

  bool accept_bytes(std::size_t i, std::vector<std::uint8_t> bytes) {
    Stimulus stimulus = trial_[i];
    stimulus.bytes = std::move(bytes);
    return accept_at(i, std::move(stimulus));
  }

  /// The same with a right CRC instead of the last two bytes, if the frame has one.
  bool accept_body(std::size_t i, Stimulus frame) {
    if (accept_at(i, frame)) return true;
    if (!modbus::crc_ok(trial_[i].bytes) || frame.bytes.size() < 3) return false;
    frame.bytes.resize(frame.bytes.size() - 2);
    modbus::add_crc(frame.bytes);
    return accept_at(i, std::move(frame));
  }

  void cut_frame(std::size_t i) {
    for (std::size_t count = std::max<std::size_t>(1, trial_[i].bytes.size() / 2);; count /= 2) {
      for (std::size_t end = trial_[i].bytes.size(); end >= count; --end) {
        if (end > trial_[i].bytes.size()) continue;
        Stimulus shorter = trial_[i];
        cut(shorter, end - count, end);
        accept_body(i, std::move(shorter));
      }
      if (count <= 1) return;
    }
  }

  void mend_character(std::size_t i) {
    Trial candidate = trial_;
    mend(candidate[i]);
    accept(std::move(candidate));
  }

  void simplify_times(std::size_t i) {
    for (const Time wait : {Time{0}, kMillisecond, 10 * kMillisecond, 100 * kMillisecond, kSecond, 10 * kSecond}) {
      if (wait >= trial_[i].wait) break;
      Trial candidate = trial_;
      candidate[i].wait = wait;
      if (accept(std::move(candidate))) break;
    }
    for (Time unit = kSecond; unit >= kMillisecond; unit /= 10) {  // rounded
      Trial candidate = trial_;
      candidate[i].wait = (trial_[i].wait + unit - 1) / unit * unit;
      if (candidate[i].wait <= 2 * trial_[i].wait && accept(std::move(candidate))) break;
    }
    if (trial_[i].bad_stop && trial_[i].damaged < trial_[i].bytes.size()) return;  // needs it
    Trial candidate = trial_;
    candidate[i].gap = 0;
    accept(std::move(candidate));
  }

  void simplify_bytes(std::size_t i) {
    for (std::size_t at = 0; at < trial_[i].bytes.size(); ++at) {
      Stimulus simple = trial_[i];
      simple.bytes[at] = 0;
      if (trial_[i].what == What::Frame)
        accept_body(i, std::move(simple));
      else
        clear_bits(i, at);
    }
  }

  /// Of inputs as few as possible are on.
  void clear_bits(std::size_t i, std::size_t at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      std::vector<std::uint8_t> bytes = trial_[i].bytes;
      bytes[at] = static_cast<std::uint8_t>(bytes[at] & ~(1u << bit));
      accept_bytes(i, std::move(bytes));
    }
  }

  Trial trial_;
  const std::function<bool(const Trial&)>& holds_;
  std::size_t left_;
};

}  // namespace

Trial shortened(Trial trial, const std::function<bool(const Trial&)>& holds, std::size_t most) {
  return Shortening(std::move(trial), holds, most).result();
}

}  // namespace s7200::tools
