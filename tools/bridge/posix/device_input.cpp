#include "tools/bridge/device_input.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <utility>

namespace s7200::tools {
namespace {

namespace asio = boost::asio;

class DescriptorInput final : public DeviceInput {
 public:
  DescriptorInput(asio::io_context& context, const SerialDevice& device)
      : descriptor_(context, static_cast<int>(device.native())) {}
  ~DescriptorInput() override { descriptor_.release(); }  // the device closes it
  DescriptorInput(const DescriptorInput&) = delete;
  DescriptorInput& operator=(const DescriptorInput&) = delete;

  void wait(std::function<void(bool)> done) override {
    descriptor_.async_wait(asio::posix::descriptor_base::wait_read,
                           [done = std::move(done)](const boost::system::error_code& error) {
                             if (error != asio::error::operation_aborted) done(!error);
                           });
  }

 private:
  asio::posix::stream_descriptor descriptor_;
};

}  // namespace

std::unique_ptr<DeviceInput> wait_for_device(asio::io_context& context, const SerialDevice& device) {
  return std::make_unique<DescriptorInput>(context, device);
}

}  // namespace s7200::tools
