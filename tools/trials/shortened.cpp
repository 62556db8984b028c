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
      simplify_times(i);
      simplify_bytes(i);
    }
    leave_out_stimuli();
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
          const auto first = frame.bytes.begin() + static_cast<std::ptrdiff_t>(at);
          Stimulus alone = frame;
          alone.bytes.assign(first, first + static_cast<std::ptrdiff_t>(length));
          alone.wait = std::max(frame.wait, kAlone);
          if (accept({alone})) return;
        }
      }
  }

  /// Without its time, or with it at what comes next.
  bool leave_out(std::size_t first, std::size_t count) {
    const auto begin = trial_.begin() + static_cast<std::ptrdiff_t>(first);
    Trial candidate(trial_.begin(), begin);
    candidate.insert(candidate.end(), begin + static_cast<std::ptrdiff_t>(count), trial_.end());
    if (accept(candidate)) return true;
    if (first >= candidate.size()) return false;
    for (std::size_t i = 0; i < count; ++i) candidate[first].wait += trial_[first + i].wait;
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

  bool accept_bytes(std::size_t i, std::vector<std::uint8_t> bytes) {
    if (bytes.empty()) return false;
    Trial candidate = trial_;
    candidate[i].bytes = std::move(bytes);
    return accept(std::move(candidate));
  }

  /// The same with a right CRC instead of the last two bytes, if the frame has one.
  bool accept_body(std::size_t i, std::vector<std::uint8_t> bytes) {
    if (accept_bytes(i, bytes)) return true;
    if (!modbus::crc_ok(trial_[i].bytes) || bytes.size() < 3) return false;
    bytes.resize(bytes.size() - 2);
    modbus::add_crc(bytes);
    return accept_bytes(i, std::move(bytes));
  }

  void cut_frame(std::size_t i) {
    for (std::size_t count = std::max<std::size_t>(1, trial_[i].bytes.size() / 2);; count /= 2) {
      for (std::size_t end = trial_[i].bytes.size(); end >= count; --end) {
        if (end > trial_[i].bytes.size()) continue;
        std::vector<std::uint8_t> bytes = trial_[i].bytes;
        const auto last = bytes.begin() + static_cast<std::ptrdiff_t>(end);
        bytes.erase(last - static_cast<std::ptrdiff_t>(count), last);
        accept_body(i, std::move(bytes));
      }
      if (count <= 1) return;
    }
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
    Trial candidate = trial_;
    candidate[i].gap = 0;
    accept(std::move(candidate));
  }

  void simplify_bytes(std::size_t i) {
    for (std::size_t at = 0; at < trial_[i].bytes.size(); ++at) {
      std::vector<std::uint8_t> bytes = trial_[i].bytes;
      bytes[at] = 0;
      if (trial_[i].what == What::Frame)
        accept_body(i, std::move(bytes));
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
