#include "serial_sim/pc_protocol/answer.hpp"

#include <fmt/format.h>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/pc_protocol/command.hpp"

namespace s7200::pc_protocol {
namespace {

constexpr std::uint8_t kAnswerStart = 'g';
constexpr std::size_t kStatus = 1, kAnswerData = 2, kAnswerDataLength = 16;

bool is_refusal(Status status) { return status == Status::WrongCheckCode || status == Status::NotLegal; }

/// The error in the form of an answer; empty if there is none.
std::string fault_of_form(std::span<const std::uint8_t> response, std::uint8_t end_character) {
  if (response[0] != kAnswerStart)
    return fmt::format("begins with 16#{:02X}, not with g: {}", response[0], serial::to_hex(response));
  if (response.size() != kAnswerLength)
    return fmt::format("wrong length: {} bytes, expected {}", response.size(), kAnswerLength);
  if (response.back() != end_character)
    return fmt::format("end character 16#{:02X}, expected 16#{:02X}", response.back(), end_character);
  const std::uint8_t status = response[kStatus];
  if (status < static_cast<std::uint8_t>(Status::ReadDone) || status > static_cast<std::uint8_t>(Status::NotLegal))
    return fmt::format("status {}: there are 1 to 4", status);
  return {};
}

/// Takes the data of a read into `bytes`, or returns what is wrong with it.
std::string take_data(std::span<const std::uint8_t> response, Bytes& bytes) {
  const auto characters = response.subspan(kAnswerData, kAnswerDataLength);
  const auto code = from_digits(response.subspan(kAnswerData + kAnswerDataLength, 2));
  auto data = from_digits(characters);
  if (!data || !code) return "data or check code are not hex digits";
  if (code->front() != check_code(characters)) return "wrong check code";
  bytes = std::move(*data);
  return {};
}

}  // namespace

std::string_view refusal_name(std::uint16_t status) {
  switch (static_cast<Status>(status)) {
    case Status::WrongCheckCode:
      return "check code wrong";
    case Status::NotLegal:
      return "command not legal";
    default:
      return "unknown status";
  }
}

serial::Answer check_answer(std::span<const std::uint8_t> command, std::span<const std::uint8_t> response,
                            std::uint8_t end_character) {
  serial::Answer answer;
  if (response.empty()) return answer;
  answer.verdict = serial::Verdict::Wrong;
  answer.fault = fault_of_form(response, end_character);
  if (!answer.fault.empty()) return answer;
  const auto status = static_cast<Status>(response[kStatus]);
  if (is_refusal(status)) {
    answer.verdict = serial::Verdict::Exception;
    answer.exception = response[kStatus];
    return answer;
  }
  const auto asked = parse_command(command);
  const Status expected = asked && asked->type == Type::Write ? Status::WriteDone : Status::ReadDone;
  if (asked && status != expected) {
    answer.fault = fmt::format("status {} to a {}", response[kStatus], asked->type == Type::Read ? "read" : "write");
    return answer;
  }
  if (status == Status::ReadDone) answer.fault = take_data(response, answer.bytes);
  if (answer.fault.empty()) answer.verdict = serial::Verdict::Right;
  return answer;
}

}  // namespace s7200::pc_protocol
