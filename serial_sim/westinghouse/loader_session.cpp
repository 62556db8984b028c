#include "serial_sim/westinghouse/loader_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/line/frame.hpp"

namespace s7200::westinghouse {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr int kArguments = 3, kDataStep = 4;
constexpr std::array<std::uint8_t, 2> kAcknowledge{kDle, kAck}, kRefusal{kDle, kNak}, kEndOfData{kDle, kEtx};

bool begins_with(Data text, Data beginning) {
  return text.size() >= beginning.size() && std::ranges::equal(text.first(beginning.size()), beginning);
}

/// The answers that are the same in every session, by step. The data of an answer stands between the fourth and the fifth.
Bytes fixed_answer(int step) {
  switch (step) {
    case 0:
      return {kDle, kAck};
    case 1:
      return {kStx};
    case 2:
      return {kHeader, kDle, kEtx};
    case kArguments:
      return {kDle, kAck, kStx};
    default:
      return {};
  }
}

}  // namespace

bool has_data(LoaderOpcode opcode) { return opcode != LoaderOpcode::Write; }

LoaderOperation loader_read(std::uint16_t first, std::size_t count) {
  const std::size_t last = first + count - 1;
  return {LoaderOpcode::Read, {high_byte(first), low_byte(first), high_byte(last), low_byte(last)}, kReadHead + count};
}

LoaderOperation loader_write(std::uint16_t first, std::span<const std::uint8_t> data) {
  LoaderOperation operation{LoaderOpcode::Write, {high_byte(first), low_byte(first)}, 0};
  operation.arguments.insert(operation.arguments.end(), data.begin(), data.end());
  return operation;
}

LoaderOperation loader_pointers() {
  constexpr std::size_t kPointers = 8;
  return {LoaderOpcode::Pointers, {}, kReadHead + 2 * kPointers};
}

LoaderOperation loader_block(std::uint8_t number) {
  constexpr std::size_t kBlockInfo = 13;
  return {LoaderOpcode::Block, {kDataBlocks, number}, kBlockInfo};
}

LoaderOperation loader_directory() { return {LoaderOpcode::Directory, {kDataBlocks}, 1 + kMostLoaderBytes}; }

Bytes stuffed(Data bytes) {
  Bytes all;
  for (const std::uint8_t byte : bytes) {
    if (byte == kDle) all.push_back(kDle);
    all.push_back(byte);
  }
  return all;
}

Bytes LoaderSteps::first() {
  step_ = 0;
  return {kStx};
}

std::optional<Bytes> LoaderSteps::next(Data response) {
  Bytes data;
  const auto length = answer_to(step_, response, data);
  if (!length || *length != response.size() || step_ + 1 == steps()) return {};
  ++step_;
  if (step_ == 1) return Bytes{static_cast<std::uint8_t>(operation_.opcode)};
  Bytes request{kDle, kAck};
  if (step_ == kArguments) {
    const Bytes arguments = stuffed(operation_.arguments);
    request.insert(request.end(), arguments.begin(), arguments.end());
    request.insert(request.end(), {kDle, kEot});
  }
  return request;
}

std::optional<std::size_t> LoaderSteps::take_data(Data response, Bytes& data) const {
  std::size_t place = 0;
  while (place < response.size()) {
    const Data rest = response.subspan(place);
    const bool whole = dle_ == Dle::Doubled || data.size() == operation_.data;
    if (whole && begins_with(rest, kEndOfData)) return place + kEndOfData.size();
    const bool doubled = dle_ == Dle::Doubled && rest[0] == kDle;
    if (doubled && (rest.size() < 2 || rest[1] != kDle)) return {};
    data.push_back(rest[0]);
    place += doubled ? 2 : 1;
  }
  return {};
}

std::optional<std::size_t> LoaderSteps::answer_to(int step, Data response, Bytes& data) const {
  const bool with_data = has_data(operation_.opcode);
  if (with_data && step == kDataStep) return take_data(response, data);
  Bytes expected = fixed_answer(step);
  if (with_data && step == kDataStep + 1) expected = {kStx};
  if (step == steps() - 2) expected = {kEnd, kDle, kEtx};
  if (!begins_with(response, expected)) return {};
  return expected.size();
}

serial::Answer LoaderSteps::judge(Data response) const {
  serial::Answer answer;
  if (response.empty()) return answer;
  answer.verdict = serial::Verdict::Wrong;
  Data rest = response;
  for (int step = 0; step + 1 < steps(); ++step) {
    Bytes data;
    const auto length = answer_to(step, rest, data);
    if (!length && begins_with(rest, kRefusal)) {
      answer.verdict = serial::Verdict::Exception;
      answer.exception = kNak;
      return answer;
    }
    if (!length) {
      answer.fault = rest.empty()
                         ? fmt::format("no answer at step {} of {}", step + 1, steps() - 1)
                         : fmt::format("step {} of {} does not fit: {}", step + 1, steps() - 1, serial::to_hex(rest));
      return answer;
    }
    if (has_data(operation_.opcode) && step == kDataStep) answer.bytes = std::move(data);
    rest = rest.subspan(*length);
  }
  if (answer.bytes.size() != operation_.data) {
    answer.fault = fmt::format("{} bytes of data, expected {}", answer.bytes.size(), operation_.data);
    answer.bytes.clear();
  } else if (!rest.empty()) {
    answer.fault = "more after the end of the session: " + serial::to_hex(rest);
  } else {
    answer.verdict = serial::Verdict::Right;
  }
  return answer;
}

bool is_whole_step(Data response) {
  if (response.empty()) return false;
  constexpr std::array<std::uint8_t, 3> kBeforeData{kDle, kAck, kStx};
  if (std::ranges::equal(response, kAcknowledge) || std::ranges::equal(response, kRefusal) ||
      std::ranges::equal(response, kBeforeData) || (response.size() == 1 && response[0] == kStx))
    return true;
  return response.size() > 2 && std::ranges::equal(response.last(2), kEndOfData);
}

}  // namespace s7200::westinghouse
