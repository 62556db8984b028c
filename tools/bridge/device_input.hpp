// A loop that waits until a serial device has something to read.
#pragma once

#include <functional>
#include <memory>

#include "tools/host/serial_device.hpp"

namespace boost::asio {
class io_context;
}

namespace s7200::tools {

class DeviceInput {
 public:
  virtual ~DeviceInput() = default;

  /// Calls `done` once, in the loop, with false if waiting failed; not at all after the end of this object.
  virtual void wait(std::function<void(bool there)> done) = 0;
};

/// Both outlive it.
std::unique_ptr<DeviceInput> wait_for_device(boost::asio::io_context& context, const SerialDevice& device);

}  // namespace s7200::tools
