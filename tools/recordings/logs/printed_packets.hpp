// Packets that tcpdump and tshark print in hex. They are put into a pcap, which has a reader.
#pragma once

#include <span>
#include <string>

#include "interpreter/base/result.hpp"
#include "tools/recordings/recording.hpp"

namespace s7200::tools {

struct PrintedPacket {
  Time at = 0;
  std::size_t number = 0;  ///< of its line
  Bytes bytes{};
};

/// Whether bytes are an IP packet with or without the head of Ethernet, or of Linux's device for all interfaces.
bool has_ip_head(const Bytes& packet);

/// Reads packets as a pcap with them. Trouble if one is not there to its end; `instead` is how to
/// record it whole.
Result<LineRecording> read_printed_packets(std::span<const PrintedPacket> packets, std::string_view instead,
                                           const ReadingChoices& choices);

}  // namespace s7200::tools
