// Packets of captures that carry the bytes of a serial line themselves: frames of the link types for users, of SEL RTACs,
// and transfers of USB adapters.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// A packet of a USB capture that moved data over a device's endpoint.
struct UsbTransfer {
  std::uint32_t device = 0;  ///< bus and address: 16#00010005 is 1.5
  bool is_bulk = false, is_control = false;
  bool in = false;         ///< from the device to the host
  bool completed = false;  ///< otherwise the host has only asked for it
  std::span<const std::uint8_t> setup{}, data{};
};

/// An adapter as far as its packets say what it is.
struct UsbAdapter {
  std::string kind{};         ///< `FTDI`; empty: not known
  bool stores_data = false;   ///< a disk
  bool has_status = false;    ///< two bytes of status before what it received, as FTDI's have them
  bool may_be_status = true;  ///< all that it sent so far begins as those do
  struct Moved {
    Time at = 0;
    bool in = false;
    Bytes bytes{};
    std::string place{};
  };
  std::vector<Moved> moved{};
};

class SerialLinks {
 public:
  static bool carry(int link_type);

  void take(const std::string& place, Time at, int link_type, std::span<const std::uint8_t> packet);

  /// The file ends before its end: what comes after the last frame is missing.
  void cut_off() { ends_early_ = true; }

  /// Adds the frames. Trouble if several devices are captured and none is known to be the line.
  Result<> finish(LineRecording& recording);

 private:
  void take_rtac(const std::string& place, Time at, std::span<const std::uint8_t> packet);
  void take(const std::string& place, Time at, const UsbTransfer& transfer);

  std::vector<RecordedFrame> frames_;
  std::map<std::uint32_t, UsbAdapter> adapters_;
  std::vector<std::string> notes_;
  bool is_log_ = false, ends_early_ = false;
  std::size_t short_ = 0;  // packets that are shorter than their heads
};

}  // namespace s7200::tools
