#include "interpreter/base/ppi_frame.hpp"

#include <cassert>
#include <numeric>

namespace s7200::ppi {
namespace {

enum Delimiter : std::uint8_t { kSd1 = 0x10, kSd2 = 0x68, kSd3 = 0xA2, kToken = 0xDC, kEnd = 0x16 };

constexpr std::size_t kHeadOfSd2 = 4, kTail = 2;  // 68 LE LE 68, and FCS 16
constexpr std::size_t kAddressing = 3;            // DA SA FC

std::uint8_t check_sum(std::span<const std::uint8_t> body) {
  return static_cast<std::uint8_t>(std::accumulate(body.begin(), body.end(), 0U));
}

}  // namespace

std::optional<std::size_t> frame_length(std::span<const std::uint8_t> begin) {
  if (begin.empty()) return {};
  switch (begin[0]) {
    case kAccepted:
      return 1;
    case kToken:
      return 3;
    case kSd1:
      return 1 + kAddressing + kTail;
    case kSd3:
      return 1 + kAddressing + 8 + kTail;
    case kSd2:
      if (begin.size() < kHeadOfSd2) return {};
      if (begin[1] != begin[2] || begin[3] != kSd2 || begin[1] < kAddressing || begin[1] > kLongestBody) return 0;
      return kHeadOfSd2 + begin[1] + kTail;
    default:
      return 0;
  }
}

std::optional<Body> body_of(std::span<const std::uint8_t> frame) {
  if (frame.size() < 1 + kAddressing + kTail) return {};
  const std::size_t head = frame[0] == kSd2 ? kHeadOfSd2 : 1;
  if (frame.size() < head + kAddressing + kTail) return {};
  const auto body = frame.subspan(head, frame.size() - head - kTail);
  if (frame.back() != kEnd || frame[frame.size() - kTail] != check_sum(body)) return {};
  return Body{body[0], body[1], body[2], body.subspan(kAddressing)};
}

Bytes to_frame(const Body& body) {
  assert(body.data.size() <= kLongestData);
  Bytes bytes{body.destination, body.source, body.function};
  bytes.insert(bytes.end(), body.data.begin(), body.data.end());
  const auto length = static_cast<std::uint8_t>(bytes.size());
  Bytes frame = body.data.empty() ? Bytes{kSd1} : Bytes{kSd2, length, length, kSd2};
  frame.insert(frame.end(), bytes.begin(), bytes.end());
  frame.insert(frame.end(), {check_sum(bytes), kEnd});
  return frame;
}

}  // namespace s7200::ppi
