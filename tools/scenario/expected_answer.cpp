#include "tools/scenario/expected_answer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "serial_sim/modbus/answer.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

bool matches(const std::vector<BytePattern>& pattern, const Bytes& bytes) {
  return std::equal(pattern.begin(), pattern.end(), bytes.begin(), bytes.end(),
                    [](const BytePattern& p, std::uint8_t byte) { return !p || *p == byte; });
}

Bytes with_crc(Bytes bytes) {
  modbus::add_crc(bytes);
  return bytes;
}

Bytes exception_answer(const Bytes& request, std::uint8_t code) {
  if (request.size() < 2) return {};
  return with_crc({request[0], static_cast<std::uint8_t>(request[1] | 0x80), code});
}

/// Answers to writes are the head of the request.
std::optional<Bytes> write_answer(const Bytes& request) {
  constexpr std::size_t kHead = 6;
  const bool writes =
      request.size() >= kHead && (request[1] == 5 || request[1] == 6 || request[1] == 15 || request[1] == 16);
  if (!writes) return {};
  return with_crc({request.begin(), request.begin() + kHead});
}

bool has_values(const Expected& expected, const std::vector<std::uint16_t>& found) {
  return std::equal(expected.values.begin(), expected.values.end(), found.begin(), found.end(),
                    [](const auto& e, std::uint16_t f) { return !e || *e == f; });
}

/// The CRC that belongs to a pattern without one; unknown if it has a byte that may be any.
void add_crc(std::vector<BytePattern>& pattern) {
  Bytes bytes;
  for (const BytePattern& p : pattern)
    if (p) bytes.push_back(*p);
  const bool known = bytes.size() == pattern.size();
  modbus::add_crc(bytes);
  for (std::size_t i = 2; i > 0; --i) pattern.push_back(known ? BytePattern(bytes[bytes.size() - i]) : std::nullopt);
}

/// The bytes of a list of registers or bits in an answer to `request`.
std::vector<BytePattern> values_answer(const Expected& expected, const Bytes& request) {
  std::vector<BytePattern> pattern{request[0], request[1]};
  if (request[1] >= 3) {
    pattern.push_back(static_cast<std::uint8_t>(2 * expected.values.size()));
    for (const auto& value : expected.values) {
      pattern.push_back(value ? BytePattern(static_cast<std::uint8_t>(*value >> 8)) : std::nullopt);
      pattern.push_back(value ? BytePattern(static_cast<std::uint8_t>(*value & 0xFF)) : std::nullopt);
    }
  } else {
    const std::size_t bytes = (expected.values.size() + 7) / 8;
    pattern.push_back(static_cast<std::uint8_t>(bytes));
    pattern.resize(3 + bytes, BytePattern(std::uint8_t{0}));
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
      BytePattern& byte = pattern[3 + i / 8];
      if (!expected.values[i]) byte.reset();
      if (byte && *expected.values[i]) byte = static_cast<std::uint8_t>(*byte | 1U << i % 8);
    }
  }
  add_crc(pattern);
  return pattern;
}

std::string values_text(const std::vector<std::optional<std::uint16_t>>& values) {
  constexpr std::size_t kShown = 8;
  std::string text = values.size() == 1 ? "the value" : "the values";
  const bool bits = std::all_of(values.begin(), values.end(), [](const auto& value) { return value.value_or(0) <= 1; });
  for (std::size_t i = 0; i < std::min(kShown, values.size()); ++i)
    text += !values[i] ? " .." : bits ? fmt::format(" {}", *values[i]) : fmt::format(" 16#{:04X}", *values[i]);
  return values.size() > kShown ? fmt::format("{} … {} in all", text, values.size()) : text;
}

}  // namespace

bool fulfilled(const Expected& expected, bool has_crc, const Bytes& request, const Bytes& response) {
  const modbus::Answer answer = modbus::check_answer(request, response);
  switch (expected.kind) {
    case Expected::Kind::Silence:
      return response.empty();
    case Expected::Kind::Any:
      return !response.empty() && (!has_crc || modbus::crc_ok(response));
    case Expected::Kind::Frame:
      if (!has_crc) return matches(expected.frame, response);
      return modbus::crc_ok(response) && matches(expected.frame, {response.begin(), response.end() - 2});
    case Expected::Kind::Echo:
      return response == request;
    case Expected::Kind::Exception:
      return answer.verdict == modbus::Verdict::Exception && answer.exception == expected.exception;
    case Expected::Kind::Values:
      return answer.verdict == modbus::Verdict::Right && has_values(expected, answer.values);
    case Expected::Kind::Accepted:
      return answer.verdict == modbus::Verdict::Right;
    case Expected::Kind::Refused:
      return answer.verdict == modbus::Verdict::Exception;
  }
  return false;
}

std::vector<BytePattern> bytes_expected(const Expected& expected, bool has_crc, const Bytes& request) {
  switch (expected.kind) {
    case Expected::Kind::Frame: {
      std::vector<BytePattern> pattern = expected.frame;
      if (has_crc) add_crc(pattern);
      return pattern;
    }
    case Expected::Kind::Echo:
      return pattern_of(request);
    case Expected::Kind::Exception:
      return pattern_of(exception_answer(request, expected.exception));
    case Expected::Kind::Values:
      if (request.size() >= 2 && request[1] >= 1 && request[1] <= 4) return values_answer(expected, request);
      return {};
    case Expected::Kind::Accepted:
      if (const auto written = write_answer(request)) return pattern_of(*written);
      return {};
    default:
      return {};
  }
}

std::string in_words(const Expected& expected, const Bytes& request) {
  switch (expected.kind) {
    case Expected::Kind::Silence:
      return request.empty() ? "nothing" : "no answer";
    case Expected::Kind::Any:
      return request.empty() ? "a transmission" : "an answer";
    case Expected::Kind::Frame:
      return quoted_text(expected.frame);
    case Expected::Kind::Echo:
      return "the request again";
    case Expected::Kind::Exception:
      return modbus::describe(request, exception_answer(request, expected.exception));
    case Expected::Kind::Values:
      return values_text(expected.values);
    case Expected::Kind::Accepted:
      return "what was asked for";
    case Expected::Kind::Refused:
      return "an exception";
  }
  return "";
}

}  // namespace s7200::tools
