#include "serial_sim/modbus/answer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/counted.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus {
namespace {

/// The data of a PDU in hex, without station, function and CRC.
using serial::to_hex;
using Data = std::span<const std::uint8_t>;

constexpr std::size_t kAroundData = 4;  // station, function, two bytes of CRC

Data data_of(std::span<const std::uint8_t> frame) { return frame.subspan(2, frame.size() - kAroundData); }

std::vector<std::uint16_t> words(Data bytes) {
  std::vector<std::uint16_t> values;
  for (std::size_t place = 0; place + 1 < bytes.size(); place += 2) values.push_back(load16(&bytes[place]));
  return values;
}

std::string wrong_length(std::size_t expected, std::size_t found) {
  return fmt::format("wrong length: {}, expected {}", counted(found, "data byte"), expected);
}

std::string not_repeated(Data answer) { return "does not repeat the request: " + to_hex(answer); }

/// The table's row of a request that is long enough for what the function carries.
const FunctionRow* row_of(std::span<const std::uint8_t> request) {
  const FunctionRow* row = request.size() < kAroundData ? nullptr : find_function(request[1]);
  if (row == nullptr) return nullptr;
  std::size_t needed = 0;
  switch (row->shape) {
    case Shape::ReadBits:
    case Shape::ReadRegisters:
    case Shape::WriteOne:
    case Shape::WriteBits:
    case Shape::WriteRegisters:
      needed = 4;
      break;
    case Shape::Diagnostics:
      needed = 2;
      break;
    case Shape::ReadFile:
    case Shape::WriteFile:
      needed = 1;
      break;
    case Shape::Status:
    case Shape::SlaveId:
      break;
  }
  return request.size() - kAroundData < needed ? nullptr : row;
}

/// Each check returns the error in the answer, or an empty text and the values in `result`.
std::string check_read(Data asked, Data answer, Shape shape, Answer& result) {
  const std::size_t count = load16(&asked[2]);
  const std::size_t bytes = shape == Shape::ReadBits ? (count + 7) / 8 : 2 * count;
  if (answer.empty()) return "there is no byte count";
  if (answer.size() != 1 + bytes) return wrong_length(bytes, answer.size() - 1);
  if (answer[0] != bytes) return fmt::format("wrong byte count: {}, expected {}", answer[0], bytes);
  if (shape == Shape::ReadRegisters) {
    result.values = words(answer.subspan(1));
    return {};
  }
  for (std::size_t bit = 0; bit < count; ++bit)
    result.values.push_back(static_cast<std::uint16_t>(answer[1 + bit / 8] >> bit % 8 & 1));
  return {};
}

/// Answers to writes repeat the first four data bytes of the request.
std::string check_write(Data asked, Data answer) {
  constexpr std::size_t kRepeated = 4;
  if (answer.size() != kRepeated) return wrong_length(kRepeated, answer.size());
  return std::equal(answer.begin(), answer.end(), asked.begin()) ? std::string() : not_repeated(answer);
}

std::string check_diagnostics(Data asked, Data answer, Answer& result) {
  if (answer.size() < 2) return wrong_length(asked.size(), answer.size());
  const std::uint16_t subfunction = load16(&asked[0]);
  if (load16(&answer[0]) != subfunction)
    return fmt::format("answer to subfunction {}, not {}", load16(&answer[0]), subfunction);
  const DiagnosticRow* row = find_diagnostics_subfunction(subfunction);
  if (row != nullptr && row->answer == DiagnosticRow::Answer::SameData && !std::ranges::equal(asked, answer))
    return not_repeated(answer);
  constexpr std::size_t kValue = 4;
  if (row != nullptr && row->answer == DiagnosticRow::Answer::Value && answer.size() != kValue)
    return wrong_length(kValue, answer.size());
  if (row != nullptr && row->answer == DiagnosticRow::Answer::None) return "this subfunction is never answered";
  result.values = words(answer.subspan(2));
  return {};
}

std::string check_slave_id(Data answer, Answer& result) {
  if (answer.empty()) return wrong_length(1, 0);
  if (answer[0] != answer.size() - 1) return fmt::format("wrong byte count: {}, expected {}", answer[0], answer.size() - 1);
  result.bytes.assign(answer.begin() + 1, answer.end());
  return {};
}

/// A byte count, then for each reference a length, its kind and what it refers to. Of a maker's own kinds it is not known in
/// which unit they count, so any length will do.
std::string check_file(Data asked, Data answer, Answer& result) {
  if (answer.empty()) return wrong_length(1, 0);
  if (answer[0] != answer.size() - 1) return fmt::format("wrong byte count: {}, expected {}", answer[0], answer.size() - 1);
  Data rest = answer.subspan(1);
  for (const Reference& reference : references_of(asked.subspan(1), false)) {
    if (rest.size() < 2 || rest[0] == 0 || rest[0] >= rest.size())
      return "a reference is missing or cut off: " + to_hex(answer);
    const Data record = rest.subspan(2, rest[0] - 1U);
    if (rest[1] != reference.type) return fmt::format("reference of kind 16#{:02X}, not 16#{:02X}", rest[1], reference.type);
    rest = rest.subspan(1U + rest[0]);
    if (reference.type != kFileReference) {
      result.bytes.insert(result.bytes.end(), record.begin(), record.end());
      continue;
    }
    if (record.size() != 2 * std::size_t{reference.count})
      return fmt::format("{} bytes of file {}, expected {}", record.size(), reference.file, 2 * reference.count);
    const auto values = words(record);
    result.values.insert(result.values.end(), values.begin(), values.end());
  }
  return rest.empty() ? std::string() : "more than was asked for: " + to_hex(rest);
}

std::string check_data(const FunctionRow& row, Data asked, Data answer, Answer& result) {
  switch (row.shape) {
    case Shape::ReadBits:
    case Shape::ReadRegisters:
      return check_read(asked, answer, row.shape, result);
    case Shape::WriteOne:
    case Shape::WriteBits:
    case Shape::WriteRegisters:
      return check_write(asked, answer);
    case Shape::Status:
      if (answer.size() != 1) return wrong_length(1, answer.size());
      result.bytes.assign(answer.begin(), answer.end());
      return {};
    case Shape::Diagnostics:
      return check_diagnostics(asked, answer, result);
    case Shape::SlaveId:
      return check_slave_id(answer, result);
    case Shape::ReadFile:
      return check_file(asked, answer, result);
    case Shape::WriteFile:
      return std::ranges::equal(asked, answer) ? std::string() : not_repeated(answer);
  }
  return {};
}

/// Register values as text: ` 16#1234 16#0000`
std::string words_text(std::span<const std::uint16_t> values) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  text.reserve(8 * values.size());
  for (const std::uint16_t value : values) {
    text += " 16#";
    for (int shift = 12; shift >= 0; shift -= 4) text += kDigits[value >> shift & 0xF];
  }
  return text;
}

std::string registers_text(std::span<const std::uint16_t> values) {
  return counted(values.size(), "register") + ":" + words_text(values);
}

/// Bits as text, the first bit first, in groups of four.
std::string bits_text(std::span<const std::uint16_t> values) {
  std::string text;
  for (std::size_t bit = 0; bit < values.size(); ++bit) {
    if (bit > 0 && bit % 4 == 0) text += ' ';
    text += values[bit] != 0 ? '1' : '0';
  }
  return text;
}

std::string slave_id_text(const Bytes& bytes) {
  if (bytes.empty()) return "slave id: empty";
  std::string text = fmt::format("slave id 16#{:02X}", bytes[0]);
  if (bytes.size() > 1)
    text += bytes[1] == 0xFF ? ", running"
            : bytes[1] == 0  ? ", stopped"
                             : fmt::format(", run indicator 16#{:02X}", bytes[1]);
  if (bytes.size() > 2) text += ", further data " + to_hex(std::span(bytes).subspan(2));
  return text;
}

std::string diagnostics_text(Data asked, const Answer& answer) {
  const std::uint16_t subfunction = load16(&asked[0]);
  const DiagnosticRow* row = find_diagnostics_subfunction(subfunction);
  std::string text = row != nullptr ? std::string(row->name) : fmt::format("subfunction {}", subfunction);
  if (row != nullptr && row->answer == DiagnosticRow::Answer::Value) return fmt::format("{}: {}", text, answer.values[0]);
  if (!answer.values.empty()) text += ":" + words_text(answer.values);
  return text + (row != nullptr && row->answer == DiagnosticRow::Answer::SameData ? " returned" : "");
}

std::string file_text(Data asked, const Answer& answer) {
  std::string text;
  std::span<const std::uint16_t> values = answer.values;
  for (const Reference& reference : references_of(asked.subspan(1), false)) {
    if (reference.type != kFileReference)
      return fmt::format("references of kind 16#{:02X}: {}", reference.type, to_hex(answer.bytes));
    text += fmt::format("{}file {} from {} on, {}", text.empty() ? "" : "; ", reference.file, reference.record,
                        registers_text(values.first(reference.count)));
    values = values.subspan(reference.count);
  }
  return text;
}

/// The name of what a function reads or writes at an address.
std::string place_text(Function function, unsigned address, Numbering numbering) {
  const auto row = std::ranges::find_if(areas(), [&](const AreaRow& area) {
    return area.read == function || area.write_one == function || area.write_many == function;
  });
  const bool named = numbering == Numbering::Notation && row != std::end(areas());
  const std::string name = named ? notation({row->area, static_cast<std::uint16_t>(address)}) : std::string();
  return name.empty() ? std::to_string(address) : name;
}

std::string written_text(Function function, Data asked, Numbering numbering) {
  const std::string first = place_text(function, load16(&asked[0]), numbering);
  const std::uint16_t second = load16(&asked[2]);
  switch (function) {
    case Function::WriteCoil:
      return fmt::format("coil {} written: {}", first, second == 0 ? 0 : 1);
    case Function::WriteRegister:
      return fmt::format("register {} written: 16#{:04X}", first, second);
    case Function::WriteCoils:
      return fmt::format("{} written from {} on", counted(second, "coil"), first);
    default:
      return fmt::format("{} written from {} on", counted(second, "register"), first);
  }
}

std::string right_text(const FunctionRow& row, Data asked, const Answer& answer, Numbering numbering) {
  switch (row.shape) {
    case Shape::ReadBits: {
      const unsigned first = load16(&asked[0]);
      const std::size_t count = answer.values.size();
      if (count == 0) return fmt::format("no {}s", row.object);
      const auto place = [&](std::size_t bit) {
        return place_text(row.function, first + static_cast<unsigned>(bit), numbering);
      };
      if (count == 1) return fmt::format("{} {}: {}", row.object, place(0), bits_text(answer.values));
      return fmt::format("{}s {}…{}: {}", row.object, place(0), place(count - 1), bits_text(answer.values));
    }
    case Shape::ReadRegisters:
      return registers_text(answer.values);
    case Shape::WriteOne:
    case Shape::WriteBits:
    case Shape::WriteRegisters:
      return written_text(row.function, asked, numbering);
    case Shape::Status: {
      std::vector<std::uint16_t> bits;
      for (int bit = 0; bit < 8; ++bit) bits.push_back(static_cast<std::uint16_t>(answer.bytes[0] >> bit & 1));
      return fmt::format("exception status 0…7: {}", bits_text(bits));
    }
    case Shape::Diagnostics:
      return diagnostics_text(asked, answer);
    case Shape::SlaveId:
      return slave_id_text(answer.bytes);
    case Shape::ReadFile:
      return file_text(asked, answer);
    case Shape::WriteFile:
      return counted(references_of(asked.subspan(1), true).size(), "reference") + " written";
  }
  return {};
}

}  // namespace

bool is_request(std::span<const std::uint8_t> frame) {
  constexpr std::size_t kRead = kAroundData + 4;           // address, count
  constexpr std::size_t kAroundWritten = kAroundData + 5;  // and a byte count
  const FunctionRow* const row = frame.size() >= kRead && crc_ok(frame) ? find_function(frame[1]) : nullptr;
  if (row == nullptr) return false;
  const std::size_t count = load16(&frame[4]);
  if (count == 0 || count > row->most) return false;
  switch (row->shape) {
    case Shape::ReadBits:
      return frame.size() == kRead && frame[2] != 3;  // else an answer with three bytes of bits
    case Shape::ReadRegisters:
      return frame.size() == kRead;
    case Shape::WriteBits:
      return frame.size() == kAroundWritten + (count + 7) / 8 && frame[6] == (count + 7) / 8;
    case Shape::WriteRegisters:
      return frame.size() == kAroundWritten + 2 * count && frame[6] == 2 * count;
    default:
      return false;
  }
}

Answer check_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response) {
  Answer answer;
  if (response.empty()) return answer;
  answer.verdict = Verdict::Wrong;
  const auto wrong = [&](std::string fault) {
    answer.fault = std::move(fault);
    if (is_request(response))
      answer.fault += std::ranges::equal(request, response) ? ": your own request has come back, an echo"
                                                            : ": a request, so somebody else is a master, too";
    return answer;
  };
  if (response.size() < kAroundData) return wrong("too short for an answer: " + to_hex(response));
  if (!crc_ok(response)) return wrong("wrong CRC");
  if (request.size() < 2) return wrong("answer to no request: " + to_hex(response));
  if (response[0] != request[0]) return wrong(fmt::format("answer of station {}, not {}", response[0], request[0]));

  const std::uint8_t function = request[1];
  const Data data = data_of(response);
  if (response[1] == (function | kExceptionFlag) && response[1] != function) {
    if (data.size() != 1) return wrong(wrong_length(1, data.size()));
    answer.verdict = Verdict::Exception;
    answer.exception = data[0];
    return answer;
  }
  if (response[1] != function) return wrong(fmt::format("answer to function {}, not {}", response[1], function));
  const FunctionRow* row = row_of(request);
  if (row == nullptr)
    answer.bytes.assign(data.begin(), data.end());
  else if (std::string fault = check_data(*row, data_of(request), data, answer); !fault.empty())
    return wrong(std::move(fault));
  answer.verdict = Verdict::Right;
  return answer;
}

std::string describe(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response, Numbering numbering) {
  const Answer answer = check_answer(request, response);
  switch (answer.verdict) {
    case Verdict::Silent:
      return "no answer";
    case Verdict::Wrong:
      return answer.fault;
    case Verdict::Exception:
      return fmt::format("exception {}: {}", answer.exception, exception_name(answer.exception));
    case Verdict::Right:
      break;
  }
  const FunctionRow* row = row_of(request);
  if (row == nullptr) return fmt::format("function {}: {}", request[1], to_hex(answer.bytes));
  return right_text(*row, data_of(request), answer, numbering);
}

}  // namespace s7200::modbus
