// The handshakes of the loader port of PC500 and PC2000.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/loader_session.hpp"
#include "tools/recordings/protocols/westinghouse.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;
using serial::to_hex;

class LoaderReader final : public FrameReader {
 public:
  explicit LoaderReader(westinghouse::Dle dle) : dle_(dle) {}

  ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) override {
    const Data bytes(frame.bytes);
    ReadFrame read;
    const auto step = step_of(frame, open);
    if (!step) {
      read.text = fmt::format("does not fit the handshake: expected {}", due_text());
      step_ = Step::Begin;
      opcode_.reset();
      return read;
    }
    step_ = *step;
    read.direction = side_of(step_);
    read.right = true;
    read.text = go_on(bytes);
    read.needs_no_answer = read.direction == Direction::Request && step_ == Step::Begin;
    return read;
  }

  bool may_be_echoed(const RecordedFrame&) const override { return false; }

  std::size_t first_message(Data bytes, const RecordedFrame*) const override {
    std::size_t length = first_of(step_, bytes);
    if (step_ == Step::DataSent) return length;  // anything may be data
    for (auto landmark = kLandmarks.begin(); length == 0 && landmark != kLandmarks.end(); ++landmark)
      length = first_of(*landmark, bytes);
    return length;
  }

  /// The computer begins a session right after it has closed the one before.
  bool messages_share_frames() const override { return true; }

 private:
  using Step = westinghouse::LoaderStep;

  /// Known wherever the handshake is, so that it is found again after what does not fit.
  static constexpr std::array kLandmarks{Step::Begin, Step::HeaderHeard, Step::End};

  static Direction side_of(Step step) { return is_of_plc(step) ? Direction::Answer : Direction::Request; }

  bool fits(Step step, const RecordedFrame& frame) const {
    return first_of(step, frame.bytes) == frame.bytes.size() &&
           (frame.direction == Direction::Unknown || frame.direction == side_of(step));
  }

  /// A PLC is ready at once: after that it is the computer, which begins anew.
  static bool is_late(const RecordedFrame& frame, const RecordedFrame* open) {
    return open != nullptr && open->at && frame.at && *frame.at - *open->at > kMasterTimeout;
  }

  bool is_known_opcode(const RecordedFrame& frame) const {
    return frame.bytes.size() == 1 && westinghouse::is_loader_opcode(frame.bytes[0]) && fits(Step::Opcode, frame);
  }

  /// The step that the frame is, which is the expected one or a landmark; nothing if it is neither.
  std::optional<Step> step_of(const RecordedFrame& frame, const RecordedFrame* open) const {
    if (fits(Step::Begin, frame) && is_late(frame, open)) return Step::Begin;
    const bool ends_without_data = step_ == Step::DataSent && !opcode_ && fits(Step::End, frame);
    if (ends_without_data) return Step::End;
    // The 02 and 10 06 before it were the start of a session, not the PLC's readiness.
    const bool begun = (step_ == Step::HeaderHeard || step_ == Step::End) && is_known_opcode(frame);
    if (begun) return Step::Opcode;
    if (fits(step_, frame)) return step_;
    const auto landmark = std::ranges::find_if(kLandmarks, [&](Step step) { return fits(step, frame); });
    return landmark == kLandmarks.end() ? std::nullopt : std::optional(*landmark);
  }

  /// The number of bytes of this step; 0 if the bytes are not this step, or not all of it.
  std::size_t first_of(Step step, Data bytes) const {
    if (is_of_plc(step) && westinghouse::begins_with(bytes, westinghouse::kRefusal)) return westinghouse::kRefusal.size();
    switch (step) {
      case Step::Opcode:
        return std::ranges::any_of(kLandmarks,
                                   [&](Step landmark) { return westinghouse::begins_with(bytes, fixed(landmark)); })
                   ? 0
                   : 1;
      case Step::Arguments:
        return westinghouse::begins_with(bytes, fixed(step))
                   ? up_to(bytes, fixed(step).size(), westinghouse::kEndOfArguments)
                   : 0;
      case Step::DataSent:
        return dle_ == westinghouse::Dle::Doubled ? up_to(bytes, 0, westinghouse::kEndOfData) : up_to_plain_end(bytes);
      default: {
        const Bytes due = fixed(step);
        return westinghouse::begins_with(bytes, due) ? due.size() : 0;
      }
    }
  }

  /// The length up to and including `end`, which is a DLE and another character; 0 if that has not come. A doubled DLE is
  /// data.
  static std::size_t up_to(Data bytes, std::size_t from, Data end) {
    using westinghouse::kDle;
    for (std::size_t at = from; at + 1 < bytes.size(); at += bytes[at] == kDle && bytes[at + 1] == kDle ? 2U : 1U)
      if (westinghouse::begins_with(bytes.subspan(at), end)) return at + end.size();
    return 0;
  }

  /// The end of data in which a 10 is not doubled: their number says it; if the number is not known, or the PLC sends more
  /// than is known of it ([S2] leaves open what comes last), the data end with the frame.
  std::size_t up_to_plain_end(Data bytes) const {
    using westinghouse::kEndOfData;
    const auto is_end = [&](std::size_t end) {
      return end >= kEndOfData.size() && end <= bytes.size() &&
             westinghouse::begins_with(bytes.subspan(end - kEndOfData.size()), kEndOfData);
    };
    const std::size_t counted = count_.value_or(0) + kEndOfData.size();
    if (count_ && is_end(counted)) return counted;
    return bytes.size() >= counted && is_end(bytes.size()) ? bytes.size() : 0;
  }

  std::string due_text() const {
    switch (step_) {
      case Step::Opcode:
        return "an opcode";
      case Step::Arguments:
        return "arguments with 10 04 after them";
      case Step::DataSent:
        return "data with 10 03 after them";
      default:
        return to_hex(fixed(step_));
    }
  }

  /// Describes the step and expects the next one.
  std::string go_on(Data bytes) {
    const Step step = step_;
    const bool refused = is_of_plc(step) && westinghouse::begins_with(bytes, westinghouse::kRefusal);
    const bool with_data = !opcode() || westinghouse::has_data(*opcode());
    step_ = refused || step == Step::Close ? Step::Begin : after(step, with_data);
    if (refused) return serial::error_text(westinghouse::kNak, westinghouse::kRefusalName);
    switch (step) {
      case Step::Begin:
        opcode_.reset();
        count_.reset();
        return "start of a session";
      case Step::Opcode:
        opcode_ = bytes[0];
        return operation_text();
      case Step::Arguments: {
        const Bytes arguments =
            westinghouse::unstuffed(without_end(bytes.subspan(fixed(step).size()), westinghouse::kEndOfArguments));
        count_ = count_asked_for(arguments);
        return arguments_text(arguments);
      }
      case Step::ArgumentsHeard:
        return "arguments accepted";
      case Step::DataSent:
        return to_hex(data_of(without_end(bytes, westinghouse::kEndOfData)));
      case Step::Ready:
      case Step::EndReady:
        return "ready";
      case Step::HeaderHeard:
        return "wants arguments";
      case Step::End:
        return "end";
      case Step::Close:
        return "session closed";
      default:
        return "acknowledged";
    }
  }

  static Data without_end(Data bytes, Data end) { return bytes.first(bytes.size() - end.size()); }

  Bytes data_of(Data sent) const {
    return dle_ == westinghouse::Dle::Doubled ? westinghouse::unstuffed(sent) : Bytes(sent.begin(), sent.end());
  }

  /// Bytes that the PLC sends then; nothing if that is not known.
  std::optional<std::size_t> count_asked_for(Data arguments) const {
    using westinghouse::LoaderOpcode;
    const auto opcode = this->opcode();
    if (opcode == LoaderOpcode::Pointers) return westinghouse::loader_pointers().data;
    if (opcode == LoaderOpcode::Block) return westinghouse::loader_block(0).data;
    if (opcode == LoaderOpcode::Directory) return westinghouse::loader_directory().data;
    if (opcode != LoaderOpcode::Read || arguments.size() != 4) return {};
    const std::size_t first = load16(&arguments[0]), last = load16(&arguments[2]);
    return last >= first ? std::optional(westinghouse::kReadHead + last - first + 1) : std::nullopt;
  }

  std::string operation_text() const {
    using westinghouse::LoaderOpcode;
    switch (*opcode()) {
      case LoaderOpcode::Write:
        return "write memory";
      case LoaderOpcode::Read:
        return "read memory";
      case LoaderOpcode::Pointers:
        return "read system parameters";
      case LoaderOpcode::Block:
        return "where a block is";
      case LoaderOpcode::Directory:
        return "directory of blocks";
    }
    return fmt::format("opcode {:02X}", *opcode_);
  }

  std::string arguments_text(Data arguments) const {
    using westinghouse::LoaderOpcode;
    const auto opcode = this->opcode();
    if (opcode == LoaderOpcode::Read && arguments.size() == 4)
      return fmt::format("bytes 16#{:04X}…{:04X}", load16(&arguments[0]), load16(&arguments[2]));
    if (opcode == LoaderOpcode::Write && arguments.size() > 2)
      return fmt::format("from 16#{:04X} on: {}", load16(&arguments[0]), to_hex(arguments.subspan(2)));
    if (opcode == LoaderOpcode::Block && arguments.size() == 2)
      return fmt::format("type {}, block {}", arguments[0], arguments[1]);
    if (opcode == LoaderOpcode::Directory && arguments.size() == 1) return fmt::format("type {}", arguments[0]);
    return arguments.empty() ? "no arguments" : to_hex(arguments);
  }

  std::optional<westinghouse::LoaderOpcode> opcode() const {
    return opcode_ ? std::optional(static_cast<westinghouse::LoaderOpcode>(*opcode_)) : std::nullopt;
  }

  westinghouse::Dle dle_;
  Step step_ = Step::Begin;
  std::optional<std::size_t> count_;    // of the bytes that the PLC sends in this session, as far as it is known
  std::optional<std::uint8_t> opcode_;  // of this session; nothing if it was not heard
};

}  // namespace

std::unique_ptr<FrameReader> pc500_loader_reader(const ChosenWords& chosen) {
  return std::make_unique<LoaderReader>(static_cast<westinghouse::Dle>(chosen[0]));
}

}  // namespace s7200::tools
