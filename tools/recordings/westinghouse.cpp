#include "tools/recordings/westinghouse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/block_message.hpp"
#include "serial_sim/westinghouse/hppc_message.hpp"
#include "serial_sim/westinghouse/loader_session.hpp"
#include "serial_sim/westinghouse/pc1000.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;
using serial::to_hex;
using serial::Verdict;

bool fits(const serial::Answer& answer) { return answer.verdict == Verdict::Right || answer.verdict == Verdict::Exception; }

// --- six-byte messages ---

class BlockReader final : public FrameReader {
 public:
  ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) override {
    const Data bytes(frame.bytes);
    ReadFrame read;
    if (open != nullptr && frame.direction != Direction::Request) {
      const serial::Answer answer = westinghouse::check_block_answer(open->bytes, bytes);
      if (fits(answer) || frame.direction == Direction::Answer) {
        read.direction = Direction::Answer;
        read.right = fits(answer);
        read.text = answer_text(open->bytes, answer);
        return read;
      }
    }
    const std::size_t length = frame.direction == Direction::Answer ? 0 : request_length(bytes);
    if (length != bytes.size()) {
      read.text = frame.direction == Direction::Answer ? "an answer without its request"
                                                       : "not a message: its opcode, length or check is wrong";
      return read;
    }
    if (bytes[0] == static_cast<std::uint8_t>(westinghouse::Opcode::SetUnitAddress)) unit_ = bytes[1];
    read.direction = Direction::Request;
    read.right = true;
    read.station = unit_;
    read.text = request_text(bytes);
    return read;
  }

  bool may_be_echoed(const RecordedFrame& frame) const override {
    return fits(westinghouse::check_block_answer(frame.bytes, frame.bytes));
  }

  std::size_t first_message(Data bytes, const RecordedFrame* open) const override {
    if (open == nullptr || (bytes[0] != open->bytes[0] && bytes[0] != westinghouse::kHighwayError))
      return request_length(bytes);
    for (std::size_t length = 1; length <= bytes.size(); ++length)
      if (westinghouse::is_whole_answer(bytes.first(length))) return length;
    return 0;
  }

 private:
  /// 0 if it is none, or not all there.
  static std::size_t request_length(Data bytes) {
    using westinghouse::kMessageLength;
    if (bytes.size() < kMessageLength || !westinghouse::Pc1000::check_right(bytes)) return 0;
    const std::size_t length = westinghouse::Pc1000::length(bytes);
    return length <= bytes.size() ? length : 0;
  }

  static std::string request_text(Data bytes) {
    using westinghouse::Opcode;
    constexpr std::size_t kAddress = 1, kCount = 3;
    const unsigned address = load16_low_first(&bytes[kAddress]);
    const std::string count = plural(bytes[kCount] + 1U, "byte");
    switch (static_cast<Opcode>(bytes[0])) {
      case Opcode::BitWrite:
        if (westinghouse::is_retest(bytes)) return "retest";
        return fmt::format("{} bit {} of word 16#{:04X}", bytes[kCount] >> 4 != 0 ? "set" : "reset", bytes[kCount] & 0xF,
                           address);
      case Opcode::ReadBlock:
        return fmt::format("read {} from word 16#{:04X} on", count, address);
      case Opcode::WriteBlock: {
        const Data data = bytes.subspan(westinghouse::kMessageLength, bytes[kCount] + 1U);
        const bool right = westinghouse::sum(data) == bytes.back();
        return fmt::format("write {} from word 16#{:04X} on: {}{}", count, address, to_hex(data),
                           right ? "" : "; wrong data check");
      }
      case Opcode::Highway:
        return highway_text(bytes);
      case Opcode::SetUnitAddress:
        return fmt::format("address unit 16#{:02X}", bytes[1]);
      case Opcode::Erase:
        return "erase memory";
    }
    return to_hex(bytes);
  }

  static std::string highway_text(Data bytes) {
    static constexpr std::array<std::string_view, 7> kCommands{
        "address",       "read remote address", "read highway status", "open session",
        "close session", "read session status", "read local address"};
    if (bytes[1] >= kCommands.size()) return fmt::format("highway command {:02X}", bytes[1]);
    const std::string name(kCommands[bytes[1]]);
    return bytes[1] != 0 ? name : fmt::format("{} {:02X}.{:02X}.{:02X}", name, bytes[2], bytes[3], bytes[4]);
  }

  static std::string answer_text(Data request, const serial::Answer& answer) {
    using westinghouse::Opcode;
    if (answer.verdict == Verdict::Exception)
      return serial::error_text(answer.exception, westinghouse::highway_error_name(answer.exception));
    if (answer.verdict != Verdict::Right) return answer.fault;
    switch (static_cast<Opcode>(request[0])) {
      case Opcode::SetUnitAddress:
        return westinghouse::unit_text(answer.bytes);
      case Opcode::Highway:
        return westinghouse::highway_text(request, answer.bytes);
      default:
        return answer.bytes.empty() ? "done" : to_hex(answer.bytes);
    }
  }

  std::optional<std::uint8_t> unit_;  // that was addressed last
};

// --- the hand-shakes of the loader ---

class LoaderReader final : public FrameReader {
 public:
  explicit LoaderReader(westinghouse::Dle dle) : dle_(dle) {}

  ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) override {
    const Data bytes(frame.bytes);
    ReadFrame read;
    const auto step = step_of(frame, open);
    if (!step) {
      read.text = fmt::format("does not fit the hand-shake: {} was due", due_text());
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

  /// Known wherever the hand-shake is, so that it is found again after what does not fit.
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

  /// The step that is due, or a landmark; nothing if the frame is neither.
  std::optional<Step> step_of(const RecordedFrame& frame, const RecordedFrame* open) const {
    if (fits(Step::Begin, frame) && is_late(frame, open)) return Step::Begin;
    const bool ends_without_data = step_ == Step::DataSent && !opcode_ && fits(Step::End, frame);
    if (ends_without_data) return Step::End;
    // The 02 and 10 06 before it were the begin of a session, not the PLC's readiness.
    const bool begun = (step_ == Step::HeaderHeard || step_ == Step::End) && is_known_opcode(frame);
    if (begun) return Step::Opcode;
    if (fits(step_, frame)) return step_;
    const auto landmark = std::ranges::find_if(kLandmarks, [&](Step step) { return fits(step, frame); });
    return landmark == kLandmarks.end() ? std::nullopt : std::optional(*landmark);
  }

  /// How many of the bytes are this step; 0 if they are not, or not all there.
  std::size_t first_of(Step step, Data bytes) const {
    if (is_of_plc(step) && begins_with(bytes, westinghouse::kRefusal)) return westinghouse::kRefusal.size();
    switch (step) {
      case Step::Opcode:
        return std::ranges::any_of(kLandmarks, [&](Step landmark) { return begins_with(bytes, fixed(landmark)); }) ? 0 : 1;
      case Step::Arguments:
        return begins_with(bytes, fixed(step)) ? up_to(bytes, fixed(step).size(), westinghouse::kEndOfArguments) : 0;
      case Step::DataSent:
        return dle_ == westinghouse::Dle::Doubled ? up_to(bytes, 0, westinghouse::kEndOfData) : up_to_plain_end(bytes);
      default: {
        const Bytes due = fixed(step);
        return begins_with(bytes, due) ? due.size() : 0;
      }
    }
  }

  static bool begins_with(Data text, Data beginning) {
    return text.size() >= beginning.size() && std::ranges::equal(text.first(beginning.size()), beginning);
  }

  /// Up to `end`, a DLE and another, included; 0 if that has not come. A doubled DLE is one of the data.
  static std::size_t up_to(Data bytes, std::size_t from, Data end) {
    using westinghouse::kDle;
    for (std::size_t at = from; at + 1 < bytes.size(); at += bytes[at] == kDle && bytes[at + 1] == kDle ? 2U : 1U)
      if (begins_with(bytes.subspan(at), end)) return at + end.size();
    return 0;
  }

  /// Where a 10 stands for itself only the number of bytes says where data end; if that is not known, or the PLC sends
  /// more than is known of it ([S2] leaves open what comes last), where the frame does.
  std::size_t up_to_plain_end(Data bytes) const {
    using westinghouse::kEndOfData;
    const auto is_end = [&](std::size_t end) {
      return end >= kEndOfData.size() && end <= bytes.size() &&
             begins_with(bytes.subspan(end - kEndOfData.size()), kEndOfData);
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

  /// What the step says; the next one is due.
  std::string go_on(Data bytes) {
    const Step step = step_;
    const bool refused = is_of_plc(step) && begins_with(bytes, westinghouse::kRefusal);
    const bool with_data = !opcode() || westinghouse::has_data(*opcode());
    step_ = refused || step == Step::Close ? Step::Begin : after(step, with_data);
    if (refused) return serial::error_text(westinghouse::kNak, westinghouse::kRefusalName);
    switch (step) {
      case Step::Begin:
        opcode_.reset();
        count_.reset();
        return "begin of a session";
      case Step::Opcode:
        opcode_ = bytes[0];
        return operation_text();
      case Step::Arguments: {
        const Bytes arguments = unstuffed(without_end(bytes.subspan(fixed(step).size()), westinghouse::kEndOfArguments));
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
    return dle_ == westinghouse::Dle::Doubled ? unstuffed(sent) : Bytes(sent.begin(), sent.end());
  }

  static Bytes unstuffed(Data bytes) {
    Bytes plain;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      plain.push_back(bytes[at]);
      if (bytes[at] == westinghouse::kDle && at + 1 < bytes.size() && bytes[at + 1] == westinghouse::kDle) ++at;
    }
    return plain;
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

// --- HPPC ---

class HppcReader final : public FrameReader {
 public:
  ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) override {
    const Data bytes(frame.bytes);
    ReadFrame read;
    if (first_message(bytes, open) != bytes.size()) {
      read.text = "not a message: its length is wrong";
      return read;
    }
    const auto table = right_table(bytes);
    read.right = table.has_value();
    if (bytes[kDestination] == westinghouse::kApl) {
      read.direction = open != nullptr ? Direction::Answer : Direction::Unknown;
      read.text = open == nullptr ? "an answer without its request" : answer_text(open->bytes, bytes, table);
      if (open != nullptr && table) read.right = fits(westinghouse::check_hppc_answer(open->bytes, bytes, *table));
    } else {
      read.direction = Direction::Request;
      read.station = bytes[kDestination];
      read.needs_no_answer = bytes[kDestination] == westinghouse::kAll;
      read.text = table ? request_text(bytes) : "wrong frame check";
    }
    return read;
  }

  bool may_be_echoed(const RecordedFrame&) const override { return false; }

  std::size_t first_message(Data bytes, const RecordedFrame*) const override {
    using westinghouse::kLongestHppc;
    using westinghouse::kShortestHppc;
    if (bytes.size() < kShortestHppc) return 0;
    const std::size_t length = load16_low_first(&bytes[0]);
    return length >= kShortestHppc && length <= std::min(bytes.size(), kLongestHppc) ? length : 0;
  }

 private:
  static constexpr std::size_t kDestination = 2, kOpcode = 5, kCheck = 2, kAddress = 3;

  static Data operands_of(Data bytes) {
    return bytes.subspan(westinghouse::kHppcHeader, bytes.size() - westinghouse::kHppcHeader - kCheck);
  }

  static std::optional<westinghouse::FcsTable> right_table(Data bytes) {
    using westinghouse::FcsTable;
    for (const FcsTable table : {FcsTable::Document, FcsTable::Polynomial})
      if (westinghouse::hppc_fcs(bytes, table) == 0) return table;
    return {};
  }

  static std::string request_text(Data bytes) {
    using westinghouse::HppcOpcode;
    const Data operands = operands_of(bytes);
    const auto address = [&] { return westinghouse::hppc_address(operands); };
    switch (static_cast<HppcOpcode>(bytes[kOpcode])) {
      case HppcOpcode::Read:
        if (operands.size() == kAddress + 1)
          return fmt::format("read {} from 16#{:05X} on", plural(operands[kAddress], "byte"), address());
        break;
      case HppcOpcode::Write:
        if (operands.size() > kAddress)
          return fmt::format("write {} from 16#{:05X} on: {}", plural(operands.size() - kAddress - 1, "byte"), address(),
                             to_hex(operands.subspan(kAddress + 1)));
        break;
      case HppcOpcode::BitWrite:
        if (operands.size() == kAddress + 4)
          return fmt::format("write bits of the word at 16#{:05X}: 16#{:04X}, those of the mask 16#{:04X}", address(),
                             load16_low_first(&operands[kAddress]), load16_low_first(&operands[kAddress + 2]));
        break;
      case HppcOpcode::Parameters:
        if (operands.size() == 1) return fmt::format("parameter table, {}", plural(operands[0], "byte"));
        break;
      case HppcOpcode::Monitor:
        if (const auto monitored = monitored_by(operands)) {
          std::string text = fmt::format("monitor network {}", address());
          for (const Monitored& each : *monitored) text += fmt::format(", {} at 16#{:05X}", each.name(), each.address);
          return text;
        }
        break;
      case HppcOpcode::Error:
        break;
    }
    return fmt::format("opcode {:02X}{}{}", bytes[kOpcode], operands.empty() ? "" : ": ", to_hex(operands));
  }

  static std::string answer_text(Data request, Data bytes, std::optional<westinghouse::FcsTable> table) {
    if (!table) return "wrong frame check";
    const serial::Answer answer = westinghouse::check_hppc_answer(request, bytes, *table);
    if (answer.verdict == Verdict::Exception)
      return serial::error_text(answer.exception, westinghouse::hppc_error_name(answer.exception));
    if (answer.verdict != Verdict::Right) return answer.fault;
    const Data operands(answer.bytes);
    const auto opcode = static_cast<westinghouse::HppcOpcode>(request[kOpcode]);
    if (opcode == westinghouse::HppcOpcode::Parameters && operands.size() >= kAddress) return parameters_text(operands);
    if (opcode == westinghouse::HppcOpcode::Read && !operands.empty() && operands.size() == 1U + operands[0])
      return fmt::format("{}{}{}", plural(operands[0], "byte"), operands[0] == 0 ? "" : ": ", to_hex(operands.subspan(1)));
    if (const auto monitored = monitored_by(operands_of(request)); monitored && opcode == westinghouse::HppcOpcode::Monitor)
      if (std::string text = monitored_text(*monitored, operands); !text.empty()) return text;
    return operands.empty() ? "done" : to_hex(operands);
  }

  static std::string parameters_text(Data operands) {
    const Data table = operands.subspan(kAddress);
    std::string text = fmt::format("parameter table at 16#{:05X}", westinghouse::hppc_address(operands));
    if (const auto found = westinghouse::holding_registers(table))
      text += fmt::format(", holding register 1 at 16#{:05X}", found->base);
    return table.empty() ? text : fmt::format("{}: {}", text, to_hex(table));
  }

  struct Monitored {
    std::uint32_t address = 0;
    std::size_t bytes = 1;

    std::string_view name() const { return bytes == 1 ? "byte" : bytes == 2 ? "word" : "double word"; }
  };

  /// In the order of the message; nothing if its operands are not those of a monitor with addresses of three bytes.
  static std::optional<std::vector<Monitored>> monitored_by(Data operands) {
    constexpr std::size_t kSizes = 3, kHead = kAddress + kSizes;
    if (operands.size() < kHead) return {};
    std::vector<Monitored> monitored;
    for (std::size_t size = 0; size < kSizes; ++size)
      for (unsigned i = 0; i < operands[kAddress + size]; ++i) {
        const std::size_t place = kHead + kAddress * monitored.size();
        if (place + kAddress > operands.size()) return {};
        monitored.push_back({westinghouse::hppc_address(operands.subspan(place)), std::size_t{1} << size});
      }
    return kHead + kAddress * monitored.size() == operands.size() ? std::optional(monitored) : std::nullopt;
  }

  /// Empty if there are more or fewer bytes than were asked for.
  static std::string monitored_text(const std::vector<Monitored>& monitored, Data operands) {
    if (operands.empty()) return "";
    std::string text = fmt::format("status 16#{:02X}", operands[0]);
    std::size_t place = 1;
    for (const Monitored& each : monitored) {
      if (place + each.bytes > operands.size()) return "";
      std::uint32_t value = 0;
      for (std::size_t i = each.bytes; i-- > 0;) value = value << 8 | operands[place + i];
      text += fmt::format(", 16#{:05X} is 16#{:0{}X}", each.address, value, 2 * each.bytes);
      place += each.bytes;
    }
    return place == operands.size() ? text : "";
  }
};

}  // namespace

std::unique_ptr<FrameReader> pc1000_lan_reader() { return std::make_unique<BlockReader>(); }
std::unique_ptr<FrameReader> westnet_reader() { return std::make_unique<BlockReader>(); }
std::unique_ptr<FrameReader> pc500_loader_reader() { return std::make_unique<LoaderReader>(westinghouse::Dle::Doubled); }
std::unique_ptr<FrameReader> pc500_loader_plain_dle_reader() {
  return std::make_unique<LoaderReader>(westinghouse::Dle::Plain);
}
std::unique_ptr<FrameReader> hppc_reader() { return std::make_unique<HppcReader>(); }

}  // namespace s7200::tools
