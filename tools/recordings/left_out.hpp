// Lines of a recording that became no frame, and what is said of them.
#pragma once

#include <cstddef>
#include <string_view>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

class LeftOut {
 public:
  /// `what`: the words of line `number` that are not understood.
  void not_understood(std::size_t number, std::string_view what);
  /// `why`: `8 bytes, 4 below it`. The first ten lines with a reason of their own are named, the others counted.
  void add(std::size_t number, std::string_view why);
  void without_bytes(std::size_t number);

  /// The notes come after those of `recording`.
  void tell(LineRecording& recording);

 private:
  static constexpr std::size_t kMostNamed = 10;

  std::vector<std::string> named_;
  std::size_t with_reason_ = 0, first_without_bytes_ = 0, without_bytes_ = 0;
};

}  // namespace s7200::tools
