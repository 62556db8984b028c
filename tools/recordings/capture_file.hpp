// The packets of a capture: pcap (draft-ietf-opsawg-pcap) and pcapng (draft-ietf-opsawg-pcapng), in either order of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/time.hpp"

namespace s7200::tools {

/// Link types by their numbers in files (draft-ietf-opsawg-pcaplinktype). Raw IP has had others too.
namespace link_types {
inline constexpr int kEthernet = 1, kRawIp = 101, kRawIpOnce = 12, kRawIpOfOpenBsd = 14, kLinuxCooked = 113,
                     kLinuxCooked2 = 276, kIp4 = 228, kIp6 = 229, kLoopback = 0, kLoopbackOfOpenBsd = 108;
}  // namespace link_types

class CaptureFile {
 public:
  struct Packet {
    std::size_t number = 0;  ///< in the file, from 1
    std::int64_t seconds = 0;
    Time nanoseconds = 0;  ///< within the second
    int link_type = 0;
    std::span<const std::uint8_t> data{};  ///< of the bytes that the file was opened with
  };

  /// Reads what stands before the first packet. Trouble if it is not a capture. The bytes outlive it.
  static Result<CaptureFile> open(std::string_view bytes);

  /// The next packet. Nothing at the end, and when error() tells what is wrong.
  std::optional<Packet> next();

  /// Where and why the rest cannot be read; empty if there is nothing wrong.
  const std::string& error() const { return error_; }

  /// Whether all packets so far have a time; simple packets of pcapng have none.
  bool has_times() const { return has_times_; }

  /// The link types that the file has told so far.
  const std::set<int>& link_types() const { return link_types_; }

 private:
  struct Interface {
    int link_type = 0;
    std::uint32_t longest = 0;        ///< bytes of a packet; 0: any
    std::uint64_t units = 1'000'000;  ///< in a second
    std::int64_t offset = 0;          ///< seconds
  };

  explicit CaptureFile(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t number(std::size_t at, std::size_t count) const;
  std::uint32_t word(std::size_t at) const { return static_cast<std::uint32_t>(number(at, 4)); }
  Result<> open_pcap();
  std::optional<Packet> next_of_pcap();
  std::optional<Packet> next_of_pcapng();
  bool begin_section(std::size_t at, std::size_t length);
  bool add_interface(std::size_t at, std::size_t length);
  std::optional<Packet> packet_in(std::uint32_t type, std::size_t at, std::size_t length);
  std::optional<Packet> packet(const Interface& from, std::uint64_t time, std::size_t at, std::size_t count);
  std::nullopt_t fail(std::string_view what);

  std::string_view bytes_;
  bool is_pcapng_ = false, big_endian_ = false, has_times_ = true;
  bool old_lengths_ = false;  ///< of a pcap before 2.4: which of the two lengths comes first is not certain
  std::size_t at_ = 0, packets_ = 0;
  std::vector<Interface> interfaces_{};  ///< of the section; of a pcap the one that it has
  std::set<int> link_types_{};
  std::string error_{};
};

}  // namespace s7200::tools
