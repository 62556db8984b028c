// Frames as packets of a capture file, for Wireshark.
#pragma once

#include <iosfwd>
#include <span>
#include <string>

#include "serial_sim/line/frame_splitter.hpp"

namespace s7200::serial {

/// A pcap file with times in nanoseconds since power-up; its link type is the first of those left to users, there is
/// none for Modbus RTU. Little endian everywhere. The stream is not owned.
/// Source: draft-ietf-opsawg-pcap, sections 4 and 5; draft-ietf-opsawg-pcaplinktype, LINKTYPE_USER0.
class PcapWriter {
 public:
  static constexpr std::uint32_t kLinkType = 147;  ///< LINKTYPE_USER0

  /// A longer packet is cut to this size; its full length is kept. The number is in the file's header and tells captures by
  /// s7200 from others.
  static constexpr std::uint32_t kLongestPacket = 7200;

  /// The file's header.
  static std::string beginning();

  explicit PcapWriter(std::ostream& out);

  /// Writes a packet. Packets come in the order of time.
  void packet(Time at, std::span<const std::uint8_t> bytes);

 private:
  std::ostream& out_;
};

/// One packet a frame, at the instant of its first start edge: what was on the line at the PLC's port, damaged as it was
/// there, whoever sent it. What ends a frame: FrameSplitter. Packets have no direction; requests are told from answers by
/// what is in them.
class PcapCapture final : public WireSink {
 public:
  explicit PcapCapture(std::ostream& out);

  void edge(Wire wire, Time at, bool mark, int driver) override { frames_.edge(wire, at, mark, driver); }
  void settled(Time until, const SerialFormat& port) override { frames_.settled(until, port); }
  void finish() override { frames_.finish(); }

 private:
  PcapWriter writer_;
  FrameSplitter frames_;
};

}  // namespace s7200::serial
