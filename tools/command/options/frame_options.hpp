// Frames on the command line: in hex, as text, or in a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "serial_sim/line/frame.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace s7200::tools {

class FrameOptions {
 public:
  void add_to(CLI::App& app);

  /// All frames of the command line and the file, in their order. Trouble if there is none, or one
  /// that is not a frame.
  Result<std::vector<serial::Frame>> read() const;

  /// Those in hex, as they were written.
  const std::vector<std::string>& in_hex() const { return frames_; }

 private:
  std::vector<std::string> frames_, texts_;
  std::string file_;
  bool crc_ = false;
  const CLI::App* app_ = nullptr;
  const CLI::Option *hex_ = nullptr, *text_ = nullptr;
};

}  // namespace s7200::tools
