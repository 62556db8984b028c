// Six-byte messages and their blocks: PC1000 LAN and Westnet II.
#include <fmt/format.h>

#include <array>

#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "serial_sim/westinghouse/pc1000.hpp"
#include "tools/recordings/protocols/westinghouse.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;
using serial::to_hex;
using serial::Verdict;

class BlockReader final : public FrameReader {
 public:
  explicit BlockReader(westinghouse::DataCheck by) : by_(by) {}

  /// The answer to a set unit address tells the position of the unit's key, so one bit of it is always set: it never repeats
  /// the message.
  static constexpr auto kSetUnit = static_cast<std::uint8_t>(westinghouse::Opcode::SetUnitAddress);

  ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) override {
    const Data bytes(frame.bytes);
    ReadFrame read;
    const bool asks_again =
        open != nullptr && frame.direction == Direction::Unknown && bytes[0] == kSetUnit && frame.bytes == open->bytes;
    if (open != nullptr && frame.direction != Direction::Request && !asks_again) {
      const serial::Answer answer = westinghouse::check_block_answer(open->bytes, bytes, by_);
      const bool by_other_rule = fits(westinghouse::check_block_answer(open->bytes, bytes, other_rule()));
      if (fits(answer) || by_other_rule || frame.direction == Direction::Answer) {
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
    if (bytes[0] == kSetUnit) unit_ = bytes[1];
    read.direction = Direction::Request;
    read.right = data_check_right(bytes);
    read.station = unit_;
    read.text = request_text(bytes);
    return read;
  }

  bool may_be_echoed(const RecordedFrame& frame) const override {
    return frame.bytes[0] != kSetUnit && fits(westinghouse::check_block_answer(frame.bytes, frame.bytes, by_));
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

  /// The other rule by which the check of a block could be made.
  westinghouse::DataCheck other_rule() const {
    using enum westinghouse::DataCheck;
    return by_ == Sum ? Xor : Sum;
  }

  /// Whether the data check of a whole message is right; messages without data have none.
  bool data_check_right(Data bytes) const {
    if (bytes[0] != static_cast<std::uint8_t>(westinghouse::Opcode::WriteBlock)) return true;
    const Data data = bytes.subspan(westinghouse::kMessageLength);
    return westinghouse::data_check(data.first(data.size() - 1), by_) == data.back();
  }

  std::string request_text(Data bytes) const {
    using westinghouse::Opcode;
    constexpr std::size_t kAddress = 1, kCount = 3;
    const unsigned address = load16_low_first(&bytes[kAddress]);
    const std::string count = counted(bytes[kCount] + 1U, "byte");
    switch (static_cast<Opcode>(bytes[0])) {
      case Opcode::BitWrite:
        if (westinghouse::is_retest(bytes)) return "retest";
        return fmt::format("{} bit {} of word 16#{:04X}", bytes[kCount] >> 4 != 0 ? "set" : "reset", bytes[kCount] & 0xF,
                           address);
      case Opcode::ReadBlock:
        return fmt::format("read {} from word 16#{:04X} on", count, address);
      case Opcode::WriteBlock: {
        const Data data = bytes.subspan(westinghouse::kMessageLength, bytes[kCount] + 1U);
        return fmt::format("write {} from word 16#{:04X} on: {}{}", count, address, to_hex(data),
                           data_check_right(bytes) ? "" : "; " + westinghouse::wrong_data_check(data, bytes.back(), by_));
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

  westinghouse::DataCheck by_;
  std::optional<std::uint8_t> unit_;  // that was addressed last
};

}  // namespace

std::unique_ptr<FrameReader> block_reader(const ChosenWords& chosen) {
  return std::make_unique<BlockReader>(static_cast<westinghouse::DataCheck>(chosen[0]));
}

}  // namespace s7200::tools
