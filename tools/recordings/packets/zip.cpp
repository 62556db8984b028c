#include "tools/recordings/packets/zip.hpp"

#include <fmt/format.h>
#define ZLIB_CONST  // its input is const
#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

using namespace std::string_view_literals;

// Records of an archive, by their signatures, and their lengths without what varies.
constexpr std::string_view kEnd = "PK\5\6"sv, kDirectoryHeader = "PK\1\2"sv, kFileHeader = "PK\3\4"sv;
constexpr std::size_t kEndLength = 22, kDirectoryHeaderLength = 46, kFileHeaderLength = 30;

/// A little-endian number of `length` bytes in a record that is long enough.
std::uint32_t number_at(std::string_view record, std::size_t at, std::size_t length) {
  std::uint32_t number = 0;
  for (std::size_t i = length; i-- > 0;) number = number << 8 | static_cast<std::uint8_t>(record[at + i]);
  return number;
}

std::size_t size_at(std::string_view record, std::size_t at) { return number_at(record, at, 4); }
std::size_t length_at(std::string_view record, std::size_t at) { return number_at(record, at, 2); }

/// The bytes from a place on; none if it is outside.
std::string_view from(std::string_view bytes, std::size_t at) { return bytes.substr(std::min(at, bytes.size())); }

bool is_record(std::string_view bytes, std::string_view signature, std::size_t length) {
  return bytes.size() >= length && bytes.starts_with(signature);
}

/// zlib's state while a file is inflated.
class Inflater {
 public:
  explicit Inflater(std::string_view packed) {
    stream_->next_in = reinterpret_cast<const Bytef*>(packed.data());
    stream_->avail_in = static_cast<uInt>(packed.size());
    constexpr int kWithoutHeader = -MAX_WBITS;
    good_ = inflateInit2(stream_.get(), kWithoutHeader) == Z_OK;
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(stream_.get()); }

  /// The next bytes; none at the end, and none if good() is false.
  std::string_view next() {
    if (!good_ || ended_) return {};
    stream_->next_out = reinterpret_cast<Bytef*>(piece_.data());
    stream_->avail_out = static_cast<uInt>(piece_.size());
    const int state = inflate(stream_.get(), Z_NO_FLUSH);
    ended_ = state == Z_STREAM_END;
    const std::size_t count = piece_.size() - stream_->avail_out;
    good_ = ended_ || (state == Z_OK && count > 0);
    return {piece_.data(), count};
  }

  bool good() const { return good_; }

 private:
  std::unique_ptr<z_stream> stream_ = std::make_unique<z_stream>();  // zlib keeps its address
  std::array<char, 1 << 16> piece_{};
  bool good_ = false, ended_ = false;
};

}  // namespace

Result<Zip> Zip::open(std::string_view bytes) {
  Zip zip;
  zip.bytes_ = bytes;
  const std::size_t at = bytes.rfind(kEnd);  // only a comment can follow
  const std::string_view end = at == std::string_view::npos ? std::string_view{} : bytes.substr(at);
  if (end.size() < kEndLength) return Trouble{"the zip cannot be read: it is cut off"};
  std::string_view directory = from(bytes, size_at(end, 16));
  for (std::size_t left = length_at(end, 10); left > 0; --left) {
    const bool header = is_record(directory, kDirectoryHeader, kDirectoryHeaderLength);
    const std::size_t name = header ? length_at(directory, 28) : 0;
    if (!header || directory.size() < kDirectoryHeaderLength + name)
      return Trouble{"the zip cannot be read: its directory is damaged"};
    zip.entries_.emplace(directory.substr(kDirectoryHeaderLength, name), directory);
    directory = from(directory, kDirectoryHeaderLength + name + length_at(directory, 30) + length_at(directory, 32));
  }
  return zip;
}

/// The entry of a header; nothing for a file that is encrypted, packed in another way or outside the archive.
std::optional<Zip::Entry> Zip::entry_at(std::string_view header) const {
  constexpr std::uint32_t kEncrypted = 1, kStored = 0, kDeflated = 8;
  const std::size_t method = length_at(header, 10);
  if ((length_at(header, 8) & kEncrypted) != 0 || (method != kStored && method != kDeflated)) return {};
  const std::string_view file = from(bytes_, size_at(header, 42));
  if (!is_record(file, kFileHeader, kFileHeaderLength)) return {};
  const std::string_view data = from(file, kFileHeaderLength + length_at(file, 26) + length_at(file, 28));
  const std::size_t packed = size_at(header, 20);
  if (data.size() < packed) return {};
  return Entry{data.substr(0, packed), number_at(header, 16, 4), method == kDeflated};
}

Result<> Zip::read(std::string_view name, const std::function<bool(std::string_view piece)>& tell) const {
  const auto found = entries_.find(name);
  const auto entry = found == entries_.end() ? std::nullopt : entry_at(found->second);
  uLong checksum = crc32(0, nullptr, 0);
  const auto pass_on = [&](std::string_view piece) {
    checksum = crc32(checksum, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(piece.size()));
    return tell(piece);
  };
  bool whole = entry.has_value();
  if (entry && entry->deflated) {
    const auto inflater = std::make_unique<Inflater>(entry->packed);
    for (auto piece = inflater->next(); !piece.empty(); piece = inflater->next())
      if (!pass_on(piece)) return Trouble{};
    whole = inflater->good();
  } else if (entry && !pass_on(entry->packed)) {
    return Trouble{};
  }
  if (whole && checksum == entry->checksum) return {};
  return trouble("'{}' in it cannot be read", stl::shortened(name));
}

}  // namespace s7200::tools
