// Messages of HPPC1500 and HPPC1700 at their loader port.
#include <fmt/format.h>

#include <array>
#include <utility>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/messages/hppc_message.hpp"
#include "tools/recordings/protocols/westinghouse.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;
using serial::to_hex;
using serial::Verdict;
using BitWrite = westinghouse::HppcLayout::BitWrite;
using ReadRequest = westinghouse::HppcLayout::ReadRequest;

class HppcReader final : public FrameReader {
 public:
  explicit HppcReader(const westinghouse::HppcLayout& layout) : layout_(layout) {}

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
    if (table == westinghouse::FcsTable::Polynomial) read.text += "; its frame check is right by the polynomial only";
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

  std::string request_text(Data bytes) const {
    using westinghouse::HppcOpcode;
    const Data operands = operands_of(bytes);
    const auto address = [&] { return westinghouse::hppc_address(operands); };
    switch (static_cast<HppcOpcode>(bytes[kOpcode])) {
      case HppcOpcode::Read:
        if (layout_.read_request == ReadRequest::Number && operands.size() == 1)
          return fmt::format("read {} from 16#00000 on", counted(operands[0], "byte"));
        if (layout_.read_request == ReadRequest::AddressAndNumber && operands.size() == kAddress + 1)
          return fmt::format("read {} from 16#{:05X} on", counted(operands[kAddress], "byte"), address());
        break;
      case HppcOpcode::Write:
        if (operands.size() > kAddress)
          return fmt::format("write {} from 16#{:05X} on: {}", counted(operands.size() - kAddress - 1, "byte"), address(),
                             to_hex(operands.subspan(kAddress + 1)));
        break;
      case HppcOpcode::BitWrite:
        if (operands.size() == kAddress + 4) {
          unsigned pattern = load16_low_first(&operands[kAddress]), mask = load16_low_first(&operands[kAddress + 2]);
          if (layout_.bit_write == BitWrite::MaskFirst) std::swap(pattern, mask);
          return fmt::format("write bits of the word at 16#{:05X}: 16#{:04X}, those of the mask 16#{:04X}", address(),
                             pattern, mask);
        }
        break;
      case HppcOpcode::Parameters:
        if (operands.size() == 1) return fmt::format("parameter table, {}", counted(operands[0], "byte"));
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

  std::string answer_text(Data request, Data bytes, std::optional<westinghouse::FcsTable> table) const {
    if (!table) return "wrong frame check";
    const serial::Answer answer = westinghouse::check_hppc_answer(request, bytes, *table);
    if (answer.verdict == Verdict::Exception)
      return serial::error_text(answer.exception, westinghouse::hppc_error_name(answer.exception));
    if (answer.verdict != Verdict::Right) return answer.fault;
    const Data operands(answer.bytes);
    const auto opcode = static_cast<westinghouse::HppcOpcode>(request[kOpcode]);
    if (opcode == westinghouse::HppcOpcode::Parameters && operands.size() >= kAddress)
      return westinghouse::hppc_parameters_text(operands);
    if (opcode == westinghouse::HppcOpcode::Read && !operands.empty() && operands.size() == 1U + operands[0])
      return fmt::format("{}{}{}", counted(operands[0], "byte"), operands[0] == 0 ? "" : ": ", to_hex(operands.subspan(1)));
    if (const auto monitored = monitored_by(operands_of(request)); monitored && opcode == westinghouse::HppcOpcode::Monitor)
      if (std::string text = monitored_text(*monitored, operands); !text.empty()) return text;
    return operands.empty() ? "done" : to_hex(operands);
  }

  struct Monitored {
    std::uint32_t address = 0;
    std::size_t bytes = 1;

    std::string_view name() const { return bytes == 1 ? "byte" : bytes == 2 ? "word" : "double word"; }
  };

  /// The monitored places in the order of the message; nothing if its operands are not those of a monitor with addresses of
  /// this length.
  std::optional<std::vector<Monitored>> monitored_by(Data operands) const {
    const std::size_t width = layout_.monitor_address_bytes;
    constexpr std::size_t kSizes = 3, kHead = kAddress + kSizes;
    if (operands.size() < kHead) return {};
    std::vector<Monitored> monitored;
    for (std::size_t size = 0; size < kSizes; ++size)
      for (unsigned i = 0; i < operands[kAddress + size]; ++i) {
        const std::size_t place = kHead + width * monitored.size();
        if (place + width > operands.size()) return {};
        monitored.push_back({westinghouse::hppc_address(operands.subspan(place)), std::size_t{1} << size});
      }
    return kHead + width * monitored.size() == operands.size() ? std::optional(monitored) : std::nullopt;
  }

  /// Empty if there are more or fewer bytes than were asked for.
  static std::string monitored_text(const std::vector<Monitored>& monitored, Data operands) {
    if (operands.empty()) return "";
    std::string text = westinghouse::hppc_status_text(operands[0]);
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

  westinghouse::HppcLayout layout_;
};

}  // namespace

std::unique_ptr<FrameReader> hppc_reader(const ChosenWords& chosen) {
  const auto [read_request, bit_write, wide_addresses] = chosen;
  return std::make_unique<HppcReader>(
      westinghouse::HppcLayout{.read_request = static_cast<ReadRequest>(read_request),
                               .bit_write = static_cast<BitWrite>(bit_write),
                               .monitor_address_bytes = westinghouse::kMonitorAddressBytes[wide_addresses]});
}

}  // namespace s7200::tools
