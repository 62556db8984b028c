// Messages on a stream: `Content-Length: 119`, an empty line, and as many bytes of JSON. Lines end with CR LF.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"

namespace s7200::tools::dap {

/// Takes a stream apart, however it is cut.
class FrameReader {
 public:
  static constexpr std::size_t kLongestHeader = 4096, kLongestBody = 16 << 20;  // bytes

  void add(std::string_view bytes) { buffer_ += bytes; }

  /// The content of the next message; nothing if it is not complete yet. Trouble if what came cannot become a message:
  /// all up to the next `Content-Length:` is skipped then.
  Result<std::string> next();

  /// What next() gave was no message: its length may have been wrong, so the next header is looked for in it too.
  void reject(std::string_view content);

  /// Whether a part of a message has come.
  bool is_amid() const { return !lost_ && (!buffer_.empty() || length_ || lines_ != 0); }

 private:
  Result<> read_header();
  Result<> read_line(std::string_view line);
  void begin_message();
  bool find_header();

  std::string buffer_;
  bool lost_ = false;  ///< looks for the next header
  std::optional<std::size_t> length_;
  std::size_t lines_ = 0;  ///< of the header, read
  std::size_t header_bytes_ = 0;
  bool header_complete_ = false;
};

std::string framed(std::string_view content);

}  // namespace s7200::tools::dap
