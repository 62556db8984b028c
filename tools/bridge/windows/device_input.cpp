#include "tools/bridge/device_input.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/windows/object_handle.hpp>
#include <utility>

namespace s7200::tools {
namespace {

namespace asio = boost::asio;

class EventInput final : public DeviceInput {
 public:
  EventInput(asio::io_context& context, const SerialDevice& device) : event_(context, copy_of(device.native())) {}

  void wait(std::function<void(bool)> done) override {
    event_.async_wait([done = std::move(done)](const boost::system::error_code& error) {
      if (error != asio::error::operation_aborted) done(!error);
    });
  }

 private:
  /// It closes what it waits for.
  static HANDLE copy_of(std::intptr_t event) {
    HANDLE copy = nullptr;
    DuplicateHandle(GetCurrentProcess(), reinterpret_cast<HANDLE>(event), GetCurrentProcess(), &copy, 0, FALSE,
                    DUPLICATE_SAME_ACCESS);
    return copy;
  }

  asio::windows::object_handle event_;
};

}  // namespace

std::unique_ptr<DeviceInput> wait_for_device(asio::io_context& context, const SerialDevice& device) {
  return std::make_unique<EventInput>(context, device);
}

}  // namespace s7200::tools
