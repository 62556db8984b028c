#include "serial_sim/westinghouse/loader_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/line/frame.hpp"

namespace s7200::westinghouse {
namespace {

using Data = std::span<const std::uint8_t>;

}  // namespace

LoaderStep after(LoaderStep step, bool with_data) {
  if (step == LoaderStep::ArgumentsHeard && !with_data) return LoaderStep::EndWanted;
  return static_cast<LoaderStep>(static_cast<unsigned>(step) + 1);
}

Bytes fixed(LoaderStep step) {
  switch (step) {
    case LoaderStep::Begin:
    case LoaderStep::Ready:
    case LoaderStep::EndReady:
      return {kStx};
    case LoaderStep::HeaderHeard:
      return {kHeader, kDle, kEtx};
    case LoaderStep::ArgumentsHeard:
      return {kDle, kAck, kStx};
    case LoaderStep::End:
      return {kEnd, kDle, kEtx};
    case LoaderStep::Opcode:
    case LoaderStep::DataSent:
      return {};
    default:
      return {kDle, kAck};
  }
}

bool has_data(LoaderOpcode opcode) { return opcode != LoaderOpcode::Write; }

bool is_loader_opcode(std::uint8_t byte) {
  switch (static_cast<LoaderOpcode>(byte)) {
    case LoaderOpcode::Write:
    case LoaderOpcode::Read:
    case LoaderOpcode::Pointers:
    case LoaderOpcode::Block:
    case LoaderOpcode::Directory:
      return true;
  }
  return false;
}

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
  return {LoaderOpcode::Pointers, {}, kReadHead + 2 * kPointers, true};
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

Bytes unstuffed(Data bytes) {
  Bytes plain;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    plain.push_back(bytes[at]);
    if (bytes[at] == kDle && at + 1 < bytes.size() && bytes[at + 1] == kDle) ++at;
  }
  return plain;
}

bool begins_with(Data text, Data beginning) {
  return text.size() >= beginning.size() && std::ranges::equal(text.first(beginning.size()), beginning);
}

Bytes LoaderSteps::first() {
  step_ = LoaderStep::Begin;
  return fixed(step_);
}

std::optional<Bytes> LoaderSteps::next(Data response) {
  if (!answered()) return {};
  Bytes data;
  const LoaderStep answer = after(step_);
  const auto length = length_of(answer, response, data);
  if (!length || *length != response.size()) return {};
  step_ = after(answer);
  if (step_ == LoaderStep::Opcode) return Bytes{static_cast<std::uint8_t>(operation_.opcode)};
  Bytes request = fixed(step_);
  if (step_ == LoaderStep::Arguments) {
    const Bytes arguments = stuffed(operation_.arguments);
    request.insert(request.end(), arguments.begin(), arguments.end());
    request.insert(request.end(), kEndOfArguments.begin(), kEndOfArguments.end());
  }
  return request;
}

bool LoaderSteps::has_all(std::size_t bytes) const {
  return bytes == operation_.data || (operation_.more_may_follow && bytes > operation_.data);
}

std::optional<std::size_t> LoaderSteps::take_data(Data response, Bytes& data) const {
  std::size_t place = 0;
  while (place < response.size()) {
    const Data rest = response.subspan(place);
    const bool whole = dle_ == Dle::Doubled || has_all(data.size());
    if (whole && begins_with(rest, kEndOfData)) return place + kEndOfData.size();
    const bool doubled = dle_ == Dle::Doubled && rest[0] == kDle;
    if (doubled && (rest.size() < 2 || rest[1] != kDle)) return {};
    data.push_back(rest[0]);
    place += doubled ? 2 : 1;
  }
  return {};
}

std::optional<std::size_t> LoaderSteps::length_of(LoaderStep step, Data response, Bytes& data) const {
  if (step == LoaderStep::DataSent) return take_data(response, data);
  const Bytes expected = fixed(step);
  return begins_with(response, expected) ? std::optional(expected.size()) : std::nullopt;
}

serial::Answer LoaderSteps::judge(Data response) const {
  serial::Answer answer;
  if (response.empty()) return answer;
  answer.verdict = serial::Verdict::Wrong;
  Data rest = response;
  LoaderStep asked = LoaderStep::Begin;
  for (int number = 1; number <= answers(); ++number) {
    Bytes data;
    const LoaderStep step = after(asked);
    const auto length = length_of(step, rest, data);
    if (!length && begins_with(rest, kRefusal)) {
      answer.verdict = serial::Verdict::Exception;
      answer.exception = kNak;
      return answer;
    }
    if (!length) {
      answer.fault = rest.empty() ? fmt::format("no answer at step {} of {}", number, answers())
                                  : fmt::format("step {} of {} does not fit: {}", number, answers(), serial::to_hex(rest));
      return answer;
    }
    if (step == LoaderStep::DataSent) answer.bytes = std::move(data);
    rest = rest.subspan(*length);
    asked = after(step);
  }
  if (!has_all(answer.bytes.size())) {
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
  if (std::ranges::equal(response, kRefusal)) return true;
  for (const LoaderStep step : {LoaderStep::BeginHeard, LoaderStep::Ready, LoaderStep::ArgumentsHeard})
    if (std::ranges::equal(response, fixed(step))) return true;
  return response.size() > kEndOfData.size() && std::ranges::equal(response.last(kEndOfData.size()), kEndOfData);
}

}  // namespace s7200::westinghouse
