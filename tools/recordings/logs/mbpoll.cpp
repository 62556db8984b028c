// The values that mbpoll prints of its polls without its option -v; it prints no frames then.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"

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

/// The exceptions as libmodbus words them, in `Read coils failed: Illegal data address`.
struct Refusal {
  std::string_view words;
  std::uint8_t code;
};
constexpr std::array kRefusals{Refusal{"Illegal function", 1},
                               Refusal{"Illegal data address", 2},
                               Refusal{"Illegal data value", 3},
                               Refusal{"Slave device or server failure", 4},
                               Refusal{"Acknowledge", 5},
                               Refusal{"Slave device or server is busy", 6},
                               Refusal{"Negative acknowledge", 7},
                               Refusal{"Memory parity error", 8},
                               Refusal{"Gateway path unavailable", 10},
                               Refusal{"Target device failed to respond", 11}};
constexpr std::string_view kFailed = " failed: ", kTimedOut = "Connection timed out";

constexpr std::uint16_t kMostValues = 125;  // that mbpoll reads at once

/// The number that follows `name` in a line.
std::optional<std::uint16_t> number_after(std::string_view line, std::string_view name) {
  const std::size_t at = line.find(name);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = line.substr(at + name.size());
  return parse_decimal<std::uint16_t>(rest.substr(0, std::min(rest.find_first_not_of("0123456789"), rest.size())));
}

/// A printed value: `[11]: 	4660`, `[11]: 	0x1234`, `[12]: 	65535 (-1)`
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

/// modpoll says the station in the line with the references, and not where it begins to poll.
constexpr std::string_view kStart = "start reference = ", kStation = "address = ", kPolls = "-- Polling slave";

class MbpollReader {
 public:
  MbpollReader(LineRecording& recording, bool from_zero) : recording_(recording), from_zero_(from_zero) {}

  /// Whether the references of a run counted from `base`.
  bool took(std::uint16_t base) const { return taken_[base]; }

  void take(std::string_view line, std::size_t number) {
    if (line.starts_with("Data type")) return take_type(line);
    if (const auto first = number_after(line, kStart)) {
      first_ = *first;
      base_ = from_zero_ || first_ == 0 ? 0 : 1;
      count_ = number_after(line, "count = ").value_or(1);
      station_ = static_cast<std::uint8_t>(number_after(line, kStation).value_or(station_));
    } else if (line.starts_with(kPolls)) {
      ask(static_cast<std::uint8_t>(number_after(line, fmt::format("{} ", kPolls)).value_or(station_)), number);
    } else if (const auto value = value_in(line)) {
      take_value(*value);
    } else if (const std::size_t failed = line.find(kFailed); asked_ && failed != std::string_view::npos) {
      take_failure(stl::trim(line.substr(failed + kFailed.size())));
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
    taken_[base_] = true;
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

  void take_failure(std::string_view words) {
    asked_ = false;
    const auto refusal = std::ranges::find(kRefusals, words, &Refusal::words);
    if (refusal != kRefusals.end())
      add(Direction::Answer,
          {static_cast<std::uint8_t>(static_cast<int>(*function_) | modbus::kExceptionFlag), refusal->code});
    else if (words != kTimedOut)
      recording_.frames.pop_back();  // what came was wrong, and is not said
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
  bool from_zero_;
  std::uint16_t base_ = 1;  ///< of the run: what its references count from
  std::array<bool, 2> taken_{};
  std::optional<Function> function_;
  std::uint16_t first_ = 0, count_ = 1;
  std::uint8_t station_ = 1;
  std::string place_;
  std::vector<std::uint16_t> values_;
  bool asked_ = false;
};

}  // namespace

void read_values_of_mbpoll(std::string_view bytes, const ReadingChoices& choices, LineRecording& recording) {
  MbpollReader reader(recording, choices.mbpoll_from_zero);
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) reader.take(line, ++number);
  if (recording.frames.empty()) {
    recording.notes.emplace_back(
        "mbpoll prints frames only with its option -v; writes and 32-bit values are not rebuilt from what it prints "
        "without");
    return;
  }
  std::string note = "mbpoll printed values and no frames: these are the frames that reads of them have";
  if (reader.took(0) && !choices.mbpoll_from_zero) note += "; references of a run that starts at 0 count from 0";
  if (reader.took(1))
    note += fmt::format("; {}references count from 1: if they count from 0, as with mbpoll's option -0, say --mbpoll-0",
                        reader.took(0) ? "other " : "");
  recording.notes.push_back(std::move(note));
}

}  // namespace s7200::tools
