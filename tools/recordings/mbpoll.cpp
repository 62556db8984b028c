// What mbpoll prints of its polls without its option -v: values, and no frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/forms.hpp"

namespace s7200::tools {
namespace {

using modbus::Function;

struct DataType {
  std::string_view words;  ///< in the line `Data type.............:`
  Function function;
};
constexpr std::array kDataTypes{
    DataType{"discrete output", Function::ReadCoils}, DataType{"discrete input", Function::ReadInputs},
    DataType{"input register", Function::ReadInputRegisters}, DataType{"output (holding)", Function::ReadHoldingRegisters}};

constexpr std::uint16_t kMostValues = 125;  // that mbpoll reads at once

/// The number after `name` in a line.
std::optional<std::uint16_t> number_after(std::string_view line, std::string_view name) {
  const std::size_t at = line.find(name);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = line.substr(at + name.size());
  return parse_decimal<std::uint16_t>(rest.substr(0, std::min(rest.find_first_not_of("0123456789"), rest.size())));
}

/// `[11]: 	4660`, `[11]: 	0x1234`, `[12]: 	65535 (-1)`
struct PrintedValue {
  std::uint16_t reference = 0, value = 0;
};
std::optional<PrintedValue> value_in(std::string_view line) {
  const std::size_t end = line.find("]:");
  if (!line.starts_with('[') || end == std::string_view::npos) return {};
  const auto reference = parse_decimal<std::uint16_t>(line.substr(1, end - 1));
  std::string_view text = stl::trim(line.substr(end + 2));
  text = text.substr(0, text.find(' '));
  const auto value = text.starts_with("0x") ? parse_integer(fmt::format("16#{}", text.substr(2))) : parse_integer(text);
  if (!reference || !value || *value < 0 || *value > UINT16_MAX) return {};
  return PrintedValue{*reference, static_cast<std::uint16_t>(*value)};
}

constexpr std::string_view kStart = "start reference = ";

/// What references count from: 1; with its option -0, which mbpoll does not show, 0. Then one of them may be 0.
std::uint16_t base_in(std::span<const std::string> lines) {
  const auto is_zero = [](const std::string& line) { return number_after(line, kStart) == 0; };
  return std::ranges::any_of(lines, is_zero) ? 0 : 1;
}

class MbpollReader {
 public:
  /// `base`: what references count from.
  MbpollReader(LineRecording& recording, std::uint16_t base) : recording_(recording), base_(base) {}

  void take(std::string_view line, std::size_t number) {
    if (line.starts_with("Data type")) return take_type(line);
    if (const auto first = number_after(line, kStart)) {
      first_ = *first;
      count_ = number_after(line, "count = ").value_or(1);
    } else if (const auto station = number_after(line, "-- Polling slave ")) {
      ask(static_cast<std::uint8_t>(*station), number);
    } else if (const auto value = value_in(line)) {
      take_value(*value);
    } else if (asked_ && line.find(" failed: ") != std::string_view::npos &&
               line.find("timed out") == std::string_view::npos) {
      asked_ = false;  // a refusal or a wrong answer: what it was is not said
      recording_.frames.pop_back();
    }
  }

 private:
  void take_type(std::string_view line) {
    const auto type = std::ranges::find_if(kDataTypes, [&](const DataType& each) {
      return line.find(each.words) != std::string_view::npos && line.find("32-bit") == std::string_view::npos;
    });
    function_ = type == kDataTypes.end() ? std::nullopt : std::optional(type->function);
  }

  void ask(std::uint8_t station, std::size_t number) {
    asked_ = function_ && first_ >= base_ && count_ > 0 && count_ <= kMostValues;
    if (!asked_) return;
    station_ = station;
    place_ = fmt::format("line {}", number);
    values_.clear();
    const std::uint16_t first = static_cast<std::uint16_t>(first_ - base_);
    Bytes pdu{static_cast<std::uint8_t>(*function_)};
    for (const std::uint16_t word : {first, count_}) {
      pdu.push_back(static_cast<std::uint8_t>(word >> 8));
      pdu.push_back(static_cast<std::uint8_t>(word & 0xFF));
    }
    add(Direction::Request, pdu);
  }

  void take_value(const PrintedValue& printed) {
    if (!asked_ || printed.reference != first_ + values_.size()) return;
    values_.push_back(printed.value);
    if (values_.size() == count_) answer();
  }

  void answer() {
    asked_ = false;
    Bytes data;
    if (*function_ == Function::ReadCoils || *function_ == Function::ReadInputs) {
      data.resize((values_.size() + 7) / 8);
      for (std::size_t bit = 0; bit < values_.size(); ++bit)
        if (values_[bit] != 0) data[bit / 8] = static_cast<std::uint8_t>(data[bit / 8] | 1U << bit % 8);
    } else {
      for (const std::uint16_t value : values_) {
        data.push_back(static_cast<std::uint8_t>(value >> 8));
        data.push_back(static_cast<std::uint8_t>(value & 0xFF));
      }
    }
    Bytes pdu{static_cast<std::uint8_t>(*function_), static_cast<std::uint8_t>(data.size())};
    pdu.insert(pdu.end(), data.begin(), data.end());
    add(Direction::Answer, pdu);
  }

  void add(Direction direction, const Bytes& pdu) {
    recording_.frames.push_back({.direction = direction, .bytes = modbus::rtu_frame(station_, pdu), .place = place_});
  }

  LineRecording& recording_;
  std::uint16_t base_;
  std::optional<Function> function_;
  std::uint16_t first_ = 0, count_ = 1;
  std::uint8_t station_ = 1;
  std::string place_;
  std::vector<std::uint16_t> values_;
  bool asked_ = false;
};

}  // namespace

void read_values_of_mbpoll(std::span<const std::string> lines, LineRecording& recording) {
  const std::uint16_t base = base_in(lines);
  MbpollReader reader(recording, base);
  std::size_t number = 0;
  for (const std::string& line : lines) reader.take(line, ++number);
  recording.notes.emplace_back(
      recording.frames.empty()
          ? "mbpoll prints frames only with its option -v; writes and 32-bit values are not rebuilt from what it prints "
            "without"
      : base == 0
          ? "mbpoll printed values and no frames: these are the frames that reads of them have; references count from 0, as "
            "one "
            "of them is 0"
          : "mbpoll printed values and no frames: these are the frames that reads of them have, if references count from 1; "
            "with its option -0 they count from 0: record with -v, too");
}

}  // namespace s7200::tools
