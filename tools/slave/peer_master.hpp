// A master on a simulated line where no S7-200 is asked.
#pragma once

#include <string>

#include "serial_sim/system/system.hpp"

namespace s7200::tools {

class PeerMaster {
 public:
  /// The system and the station are not owned. The master talks in this format from now on.
  PeerMaster(serial::System& system, serial::RequesterStation& station, const SerialFormat& format);

  /// Runs an exchange; after Ctrl-C the result is its part so far. Throws std::invalid_argument for a byte with wrong parity
  /// in a format without parity.
  serial::Exchange exchange(const serial::Request& request);
  serial::Exchange receive(const serial::Listening& listening);

  SerialFormat format() const { return station_.uart().state().format; }
  Time pause() const;
  const std::string& remark() const { return remark_; }

 private:
  serial::Exchange finish();

  serial::System& system_;
  serial::RequesterStation& station_;
  std::string remark_;
};

}  // namespace s7200::tools
