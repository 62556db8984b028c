#include "tools/faces/dap/wire/framing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::tools::dap {

Result<std::string> FrameReader::next() {
  if (lost_ && !find_header()) return std::nullopt;
  if (const auto header = header_complete_ ? Result<>() : read_header(); !header) {
    lost_ = !header.why().empty();
    if (lost_) begin_message();
    return header.trouble();
  }
  if (buffer_.size() < *length_) return std::nullopt;
  std::string content = buffer_.substr(0, *length_);
  buffer_.erase(0, *length_);
  begin_message();
  return content;
}

void FrameReader::begin_message() {
  length_.reset();
  lines_ = header_bytes_ = 0;
  header_complete_ = false;
}

void FrameReader::reject(std::string_view content) {
  buffer_.insert(0, content);
  begin_message();
  lost_ = true;
}

/// Skips what is in front of it.
bool FrameReader::find_header() {
  constexpr std::string_view kName = "CONTENT-LENGTH:";
  const auto same = [](char c, char upper) { return stl::upper_case({&c, 1})[0] == upper; };
  const auto found = std::search(buffer_.begin(), buffer_.end(), kName.begin(), kName.end(), same);
  lost_ = found == buffer_.end();
  const std::size_t kept =
      lost_ ? std::min(buffer_.size(), kName.size() - 1) : static_cast<std::size_t>(buffer_.end() - found);
  buffer_.erase(0, buffer_.size() - kept);
  return !lost_;
}

/// As long as not all of it has come, there is trouble without a word.
Result<> FrameReader::read_header() {
  for (;;) {
    const std::size_t end = buffer_.find('\n');
    if (header_bytes_ + std::min(end, buffer_.size()) > kLongestHeader) {
      buffer_.erase(0, std::min(end, kLongestHeader));
      return trouble("the header of a message is longer than {} bytes", kLongestHeader);
    }
    if (end == std::string::npos) return Trouble{};
    const std::string line = buffer_.substr(0, end);
    buffer_.erase(0, end + 1);
    header_bytes_ += end + 1;
    if (!line.ends_with('\r')) return trouble("'{}' is not a line of a header, which ends with CR LF", stl::shortened(line));
    if (line.size() == 1) break;
    ++lines_;
    if (const auto done = read_line(std::string_view(line).substr(0, line.size() - 1)); !done) return done;
  }
  if (!length_) return Trouble{"a header without Content-Length"};
  header_complete_ = true;
  return {};
}

Result<> FrameReader::read_line(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos)
    return trouble("'{}' is not a line of a header: write for example Content-Length: 119", stl::shortened(line));
  if (stl::upper_case(line.substr(0, colon)) != "CONTENT-LENGTH") return {};
  const std::string_view number = stl::trim(line.substr(colon + 1));
  length_ = parse_decimal<std::size_t>(number);
  if (!length_) return trouble("'{}' is not the length of a message", stl::shortened(number));
  if (*length_ > kLongestBody) return trouble("a message of {} bytes is longer than {}", *length_, kLongestBody);
  return {};
}

std::string framed(std::string_view content) { return fmt::format("Content-Length: {}\r\n\r\n{}", content.size(), content); }

}  // namespace s7200::tools::dap
