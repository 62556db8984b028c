// A serial port with nothing on it.
#pragma once

#include "interpreter/base/serial_port.hpp"

namespace s7200::reference {

class SilentPort : public SerialPort {
 public:
  void configure(const SerialFormat&, Time) override {}
  void enable_receiver(bool, Time) override {}
  void send(std::uint8_t, Time) override {}
  void send_break(int, Time) override {}
};

}  // namespace s7200::reference
