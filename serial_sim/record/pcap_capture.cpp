#include "serial_sim/record/pcap_capture.hpp"

#include <algorithm>
#include <ostream>

namespace s7200::serial {
namespace {

constexpr std::uint32_t kNanoseconds = 0xA1B23C4D;
constexpr std::uint32_t kVersion = 2 | 4U << 16;  // 2.4: two fields of 16 bits

void add(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFF);
}

}  // namespace

std::string PcapWriter::beginning() {
  std::string header;
  for (const std::uint32_t field : {kNanoseconds, kVersion, 0U, 0U, kLongestPacket, kLinkType}) add(header, field);
  return header;
}

PcapWriter::PcapWriter(std::ostream& out) : out_(out) { out_ << beginning(); }

void PcapWriter::packet(Time at, std::span<const std::uint8_t> bytes) {
  const auto kept = bytes.first(std::min<std::size_t>(bytes.size(), kLongestPacket));
  std::string record;
  add(record, static_cast<std::uint32_t>(at / kSecond));
  add(record, static_cast<std::uint32_t>(at % kSecond));
  add(record, static_cast<std::uint32_t>(kept.size()));
  add(record, static_cast<std::uint32_t>(bytes.size()));
  record.append(kept.begin(), kept.end());
  out_ << record;
}

PcapCapture::PcapCapture(std::ostream& out)
    : writer_(out), frames_([this](const WireFrame& frame) {
        std::vector<std::uint8_t> bytes;
        for (const ReceivedCharacter& character : frame.characters) bytes.push_back(character.byte);
        writer_.packet(frame.start(), bytes);
      }) {}

}  // namespace s7200::serial
