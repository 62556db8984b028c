#include "tools/host/files/record_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <streambuf>
#include <utility>

#include "tools/host/files/write_all.hpp"

namespace s7200::tools {

/// Writes to a descriptor until it takes no more: whole lines, so that whoever reads the file while it grows sees no half
/// ones. What has no line end in 64 KB is written as it comes.
class RecordFile::Buffer final : public std::streambuf {
 public:
  explicit Buffer(int fd) : fd_(fd) { setp(bytes_.data(), bytes_.data() + bytes_.size()); }

  /// 0 or why something could not be written.
  int error() const { return error_; }

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
    if (error_ == 0) error_ = write_all(fd_, held().substr(0, count));
    const std::string_view rest = held().substr(count);
    std::copy(rest.begin(), rest.end(), bytes_.begin());
    setp(bytes_.data(), bytes_.data() + bytes_.size());
    pbump(static_cast<int>(rest.size()));
    return error_ == 0 ? 0 : -1;
  }

  int fd_;
  int error_ = 0;
  std::array<char, 65536> bytes_{};
};

RecordFile::RecordFile() = default;
RecordFile::~RecordFile() = default;

bool RecordFile::claim(WrittenFiles& files, std::string_view option, const std::string& path, FileKind kind,
                       std::string& why) {
  destination_.path = path;
  if (path == "-") {
    standard_output_ = files.standard_output();
    if (!standard_output_) why = fmt::format("{} -: there is no standard output to write to", option);
    return standard_output_ != nullptr;
  }
  kind.record = true;
  auto claimed = files.claim(option, path, std::move(kind), Replace::Own, why);
  if (claimed) destination_ = std::move(*claimed);
  return claimed.has_value();
}

/// A pipe without a reader that Ctrl-C ends is not a mistake: there is nothing to say but that it was interrupted.
bool RecordFile::check(int error, std::string& why) const {
  if (error != 0) why = error == EINTR ? "" : fmt::format("cannot write {}: {}", destination_.path, error_text(error));
  return error == 0;
}

std::ostream* RecordFile::open(std::string& why) {
  if (standard_output_) return standard_output_;
  int error = 0;
  if (!destination_.stream)
    error = file_.create(destination_);
  else if (const int fd = file_system::open_stream(destination_.path); fd >= 0)
    file_.take(fd);
  else
    error = errno;
  if (!check(error, why)) return nullptr;
  buffer_ = std::make_unique<Buffer>(file_.fd());
  stream_ = std::make_unique<std::ostream>(buffer_.get());
  return stream_.get();
}

bool RecordFile::put(std::string& why) {
  if (!buffer_) return true;
  stream_->flush();
  if (!check(buffer_->error(), why)) return false;
  return destination_.stream || check(file_.put(destination_), why);
}

void RecordFile::flush() {
  if (std::ostream* const out = standard_output_ ? standard_output_ : stream_.get()) out->flush();
}

bool RecordFile::close(std::string& why) {
  if (!buffer_) return true;
  stream_->flush();
  int error = buffer_->error();
  stream_.reset();
  buffer_.reset();
  if (const int at_close = file_.close(); error == 0) error = at_close;
  if (error != 0) why = fmt::format("cannot write all of {}: {}", destination_.path, error_text(error));
  return error == 0;
}

}  // namespace s7200::tools
