#include "tools/recordings/capture_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/recordings/forms.hpp"

namespace s7200::tools {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kSectionMagic = "\x0A\x0D\x0D\x0A"sv;
constexpr std::uint64_t kNano = 1'000'000'000;

/// The beginnings of a pcap, the first bytes of which tell the order of its bytes and the unit of its times.
struct PcapMagic {
  std::string_view bytes;
  bool big_endian;
  std::uint64_t units;  ///< in a second
};
constexpr std::array<PcapMagic, 4> kPcapMagics{{{"\xA1\xB2\xC3\xD4"sv, true, 1'000'000},
                                                {"\xD4\xC3\xB2\xA1"sv, false, 1'000'000},
                                                {"\xA1\xB2\x3C\x4D"sv, true, kNano},
                                                {"\x4D\x3C\xB2\xA1"sv, false, kNano}}};

const PcapMagic* pcap_magic(std::string_view bytes) {
  const auto found = std::ranges::find_if(kPcapMagics, [bytes](const PcapMagic& m) { return bytes.starts_with(m.bytes); });
  return found == kPcapMagics.end() ? nullptr : &*found;
}

/// if_tsresol: a power of 10, or of 2 with the highest bit set. 0 if 64 bits do not hold it.
std::uint64_t units_of(std::uint8_t resolution) {
  const unsigned exponent = resolution & 0x7FU;
  if ((resolution & 0x80) != 0) return exponent < 64 ? std::uint64_t{1} << exponent : 0;
  std::uint64_t units = exponent <= 19 ? 1 : 0;
  for (unsigned i = 0; i < exponent && units != 0; ++i) units *= 10;
  return units;
}

/// The part of a second that so many units are.
Time part_of_second(std::uint64_t count, std::uint64_t units) {
  if (units <= kNano) return static_cast<Time>(count * kNano / units);
  return static_cast<Time>(static_cast<double>(count) / static_cast<double>(units) * static_cast<double>(kNano));
}

}  // namespace

bool looks_like_pcap(std::string_view bytes) { return bytes.starts_with(kSectionMagic) || pcap_magic(bytes) != nullptr; }

Result<CaptureFile> CaptureFile::open(std::string_view bytes) {
  CaptureFile file(bytes);
  file.is_pcapng_ = bytes.starts_with(kSectionMagic);
  if (!file.is_pcapng_)
    if (const auto done = file.open_pcap(); !done) return done.trouble();
  return file;
}

std::uint64_t CaptureFile::number(std::size_t at, std::size_t count) const {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = value << 8 | static_cast<std::uint8_t>(bytes_[at + (big_endian_ ? i : count - 1 - i)]);
  return value;
}

std::nullopt_t CaptureFile::fail(std::string_view what) {
  error_ = packets_ == 0 ? fmt::format("the file cannot be read: {}", what)
                         : fmt::format("after packet {} the file cannot be read: {}", packets_, what);
  return std::nullopt;
}

std::optional<CaptureFile::Packet> CaptureFile::next() {
  if (!error_.empty() || at_ == bytes_.size()) return {};
  return is_pcapng_ ? next_of_pcapng() : next_of_pcap();
}

std::optional<CaptureFile::Packet> CaptureFile::packet(const Interface& from, std::uint64_t time, std::size_t at,
                                                       std::size_t count) {
  return Packet{.number = ++packets_,
                .seconds = static_cast<std::int64_t>(time / from.units) + from.offset,
                .nanoseconds = part_of_second(time % from.units, from.units),
                .link_type = from.link_type,
                .data = {reinterpret_cast<const std::uint8_t*>(bytes_.data()) + at, count}};
}

// --- pcap ---

Result<> CaptureFile::open_pcap() {
  constexpr std::size_t kHead = 24;
  constexpr std::uint32_t kLinkType = 0x03FFFFFF;  // above it stands how long a check sum is
  const PcapMagic* const magic = pcap_magic(bytes_);
  if (!magic) return Trouble{"it does not begin as a capture"};
  if (bytes_.size() < kHead) return Trouble{"it is cut off in its head"};
  big_endian_ = magic->big_endian;
  const std::uint64_t major = number(4, 2), minor = number(6, 2);
  if (major != 2) return trouble("it is of version {}.{} of pcap, and 2 is the one that is read", major, minor);
  old_lengths_ = minor < 4;
  interfaces_ = {{.link_type = static_cast<int>(word(20) & kLinkType), .units = magic->units}};
  link_types_ = {interfaces_[0].link_type};
  at_ = kHead;
  return {};
}

std::optional<CaptureFile::Packet> CaptureFile::next_of_pcap() {
  constexpr std::size_t kHead = 16;
  if (bytes_.size() - at_ < kHead) return fail("it is cut off");
  std::size_t count = word(at_ + 8);
  if (old_lengths_) count = std::min<std::size_t>(count, word(at_ + 12));
  const std::size_t data = at_ + kHead;
  if (count > bytes_.size() - data) return fail("it is cut off");
  const std::uint64_t fraction = word(at_ + 4);
  const std::uint64_t time = word(at_) * interfaces_[0].units + fraction;
  at_ = data + count;
  return packet(interfaces_[0], time, data, count);
}

// --- pcapng: blocks, each with its type, its length, its body and its length again ---

std::optional<CaptureFile::Packet> CaptureFile::next_of_pcapng() {
  constexpr std::uint32_t kSection = 0x0A0D0D0A, kInterface = 1, kOldPacket = 2, kSimplePacket = 3, kPacket = 6;
  constexpr std::size_t kAround = 12, kHead = 8;
  while (at_ < bytes_.size()) {
    const std::size_t left = bytes_.size() - at_;
    if (left < kAround) return fail("it is cut off");
    const bool begins = bytes_.substr(at_).starts_with(kSectionMagic);
    if (begins && left < kAround + 4) return fail("it is cut off");
    if (begins) big_endian_ = bytes_[at_ + kHead] == '\x1A';
    const std::uint32_t type = word(at_);
    const std::size_t length = word(at_ + 4);
    if (length < kAround || length % 4 != 0) return fail(fmt::format("a block says that it has {} bytes", length));
    if (length > left) return fail("it is cut off");
    if (word(at_ + length - 4) != length) return fail("a block does not say the same length at both its ends");
    const std::size_t body = at_ + kHead, body_length = length - kAround;
    at_ += length;
    if (type == kSection && !begin_section(body, body_length)) return {};
    if (type == kInterface && !add_interface(body, body_length)) return {};
    if (type == kPacket || type == kOldPacket || type == kSimplePacket) return packet_in(type, body, body_length);
  }
  return {};
}

bool CaptureFile::begin_section(std::size_t at, std::size_t length) {
  constexpr std::uint32_t kOrder = 0x1A2B3C4D;
  constexpr std::size_t kBody = 16;
  interfaces_.clear();
  if (length < kBody || word(at) != kOrder) return fail("the head of a section is not one of pcapng"), false;
  if (number(at + 4, 2) != 1) return fail(fmt::format("it is of version {} of pcapng", number(at + 4, 2))), false;
  return true;
}

bool CaptureFile::add_interface(std::size_t at, std::size_t length) {
  constexpr std::size_t kBody = 8, kOptionHead = 4;
  constexpr std::uint64_t kEnd = 0, kResolution = 9, kOffset = 14;
  if (length < kBody) return fail("an interface is too short"), false;
  Interface added{.link_type = static_cast<int>(number(at, 2)), .longest = word(at + 4)};
  for (std::size_t option = at + kBody; option + kOptionHead <= at + length;) {
    const std::uint64_t code = number(option, 2);
    const std::size_t size = number(option + 2, 2), value = option + kOptionHead;
    if (code == kEnd || value + size > at + length) break;
    if (code == kResolution && size == 1) added.units = units_of(static_cast<std::uint8_t>(bytes_[value]));
    if (code == kOffset && size == 8) added.offset = static_cast<std::int64_t>(number(value, 8));
    option = value + (size + 3) / 4 * 4;
  }
  if (added.units == 0) return fail("an interface has a unit of time that is too small"), false;
  interfaces_.push_back(added);
  link_types_.insert(added.link_type);
  return true;
}

std::optional<CaptureFile::Packet> CaptureFile::packet_in(std::uint32_t type, std::size_t at, std::size_t length) {
  constexpr std::uint32_t kSimplePacket = 3, kPacket = 6;
  const std::size_t head = type == kSimplePacket ? 4 : 20;
  if (length < head) return fail("a packet is too short");
  const std::uint64_t interface_number = type == kSimplePacket ? 0 : type == kPacket ? word(at) : number(at, 2);
  if (interface_number >= interfaces_.size())
    return fail(fmt::format("a packet is of interface {}, which it does not have", interface_number));
  const Interface& from = interfaces_[interface_number];
  if (type == kSimplePacket) {
    has_times_ = false;
    std::size_t count = std::min<std::size_t>(word(at), length - head);
    if (from.longest != 0) count = std::min<std::size_t>(count, from.longest);
    return packet(from, 0, at + head, count);
  }
  const std::size_t count = word(at + 12);
  if (count > length - head) return fail("a packet is longer than its block");
  return packet(from, std::uint64_t{word(at + 4)} << 32 | word(at + 8), at + head, count);
}

}  // namespace s7200::tools
