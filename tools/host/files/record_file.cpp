#include "tools/host/files/record_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <streambuf>
#include <utility>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/host/files/write_all.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

constexpr std::array<std::pair<std::string_view, double>, 5> kSizes{
    {{"TB", 1e12}, {"GB", 1e9}, {"MB", 1e6}, {"KB", 1e3}, {"B", 1}}};

}  // namespace

std::string size_text(double bytes) {
  for (const auto& [unit, size] : kSizes)
    if (const double number = bytes / size; number >= 1)
      return number < 10 && size > 1 ? fmt::format("{:.2g} {}", number, unit) : fmt::format("{:.0f} {}", number, unit);
  return "0 B";
}

std::optional<std::uint64_t> parse_size(std::string_view text) {
  const std::string upper = stl::upper_case(std::string(stl::trim(text)));
  if (upper == "NONE") return kUnlimited;
  for (const auto& [unit, size] : kSizes) {
    if (!upper.ends_with(unit)) continue;
    const auto number = parse_decimal<double>(stl::trim(std::string_view(upper).substr(0, upper.size() - unit.size())));
    if (!number || !(*number * size >= 1 && *number * size < 1e18)) return {};
    return static_cast<std::uint64_t>(*number * size);
  }
  return {};
}

/// Writes to a descriptor until it takes no more: whole lines, so that whoever reads the file while it grows sees no half
/// ones. What has no line end in 64 KB is written as it comes. Beyond its limit it takes nothing.
class RecordFile::Buffer final : public std::streambuf {
 public:
  Buffer(int fd, std::uint64_t limit) : fd_(fd), limit_(limit) { setp(bytes_.data(), bytes_.data() + bytes_.size()); }

  /// 0 or why something could not be written.
  int error() const { return error_; }

  std::uint64_t size() const { return written_ + held().size(); }
  bool full() const { return full_; }

 protected:
  int_type overflow(int_type c) override {
    const std::size_t lines = held().rfind('\n') + 1;
    if (put(lines == 0 ? held().size() : lines) != 0) return traits_type::eof();
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    return sputc(traits_type::to_char_type(c));
  }

  int sync() override { return put(held().size()); }

 private:
  std::string_view held() const { return {pbase(), static_cast<std::size_t>(pptr() - pbase())}; }

  /// Writes the first of what is held, and goes on holding the rest.
  int put(std::size_t count) {
    const std::string_view fits = held().substr(0, std::min<std::uint64_t>(count, limit_ - written_));
    full_ |= fits.size() < count;
    const std::string_view lines = full_ ? fits.substr(0, fits.rfind('\n') + 1) : fits;
    if (error_ == 0) error_ = write_all(fd_, lines);
    written_ += lines.size();
    if (full_) return -1;
    const std::string_view rest = held().substr(count);
    std::copy(rest.begin(), rest.end(), bytes_.begin());
    setp(bytes_.data(), bytes_.data() + bytes_.size());
    pbump(static_cast<int>(rest.size()));
    return error_ == 0 ? 0 : -1;
  }

  int fd_;
  std::uint64_t limit_, written_ = 0;
  bool full_ = false;
  int error_ = 0;
  std::array<char, 65536> bytes_{};
};

RecordFile::RecordFile() = default;
RecordFile::~RecordFile() = default;

Result<> RecordFile::claim(WrittenFiles& files, std::string_view option, const std::string& path, FileKind kind) {
  destination_.path = path;
  if (path == "-") {
    standard_output_ = files.standard_output();
    if (!standard_output_) return trouble("{} -: there is no standard output to write to", option);
    return {};
  }
  kind.record = true;
  limit_ = files.record_limit();
  auto claimed = files.claim(option, path, std::move(kind), Replace::Own);
  if (!claimed) return claimed.trouble();
  destination_ = *std::move(claimed);
  return {};
}

/// A pipe without a reader that Ctrl-C ends is not a mistake: there is nothing to say but that it was interrupted.
Result<> RecordFile::check(int error) const {
  if (error == 0) return {};
  return error == EINTR ? Trouble{} : trouble("cannot write {}: {}", destination_.path, error_text(error));
}

Result<std::ostream&> RecordFile::open() {
  if (standard_output_) return *standard_output_;
  int error = 0;
  if (!destination_.stream)
    error = file_.create(destination_);
  else if (const int fd = file_system::open_stream(destination_.path); fd >= 0)
    file_.take(fd);
  else
    error = errno;
  if (const auto done = check(error); !done) return done.trouble();
  buffer_ = std::make_unique<Buffer>(file_.fd(), destination_.stream ? kUnlimited : limit_);
  stream_ = std::make_unique<std::ostream>(buffer_.get());
  return *stream_;
}

Result<> RecordFile::put() {
  if (!buffer_) return {};
  stream_->flush();
  if (const auto done = check(buffer_->error()); !done) return done.trouble();
  return destination_.stream ? Result<>() : check(file_.put(destination_));
}

void RecordFile::flush() {
  if (std::ostream* const out = standard_output_ ? standard_output_ : stream_.get()) out->flush();
}

std::optional<RecordSize> RecordFile::size() const {
  if (!buffer_ || destination_.stream) return {};
  return RecordSize{destination_.path, buffer_->size(), limit_, buffer_->full()};
}

Result<> RecordFile::close() {
  if (!buffer_) return {};
  stream_->flush();
  int error = buffer_->error();
  const bool full = buffer_->full();
  stream_.reset();
  buffer_.reset();
  if (const int at_close = file_.close(); error == 0) error = at_close;
  if (error != 0) return trouble("cannot write all of {}: {}", destination_.path, error_text(error));
  if (full)
    return trouble("{} has reached {} and ends there; --record-limit lets records grow further",
                   stl::printable(destination_.path), size_text(static_cast<double>(limit_)));
  return {};
}

}  // namespace s7200::tools
