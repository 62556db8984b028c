#include "tools/recordings/left_out.hpp"

#include <fmt/format.h>

#include "interpreter/base/text.hpp"

namespace s7200::tools {

void LeftOut::not_understood(std::size_t number, std::string_view what) {
  add(number, fmt::format("'{}' is not understood", stl::shortened(what)));
}

void LeftOut::add(std::size_t number, std::string_view why) {
  if (++with_reason_ <= kMostNamed) named_.push_back(fmt::format("line {}: left out: {}", number, why));
}

void LeftOut::without_bytes(std::size_t number) {
  if (without_bytes_++ == 0) first_without_bytes_ = number;
}

void LeftOut::tell(LineRecording& recording) {
  for (std::string& note : named_) recording.notes.push_back(std::move(note));
  if (with_reason_ > kMostNamed)
    recording.notes.push_back(fmt::format("{} more lines were left out for such a reason", with_reason_ - kMostNamed));
  if (without_bytes_ == 0) return;
  const std::string more = without_bytes_ == 1 ? "" : fmt::format(", and {} more", without_bytes_ - 1);
  recording.notes.push_back(fmt::format("line {}: left out{}: no bytes in it", first_without_bytes_, more));
}

}  // namespace s7200::tools
