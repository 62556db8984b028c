#include "tools/bridge/device_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <optional>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/bridge/device_input.hpp"
#include "tools/host/serial_device.hpp"

namespace s7200::tools {
namespace {

namespace asio = boost::asio;
using serial::HostCharacter;

class DeviceBridge final : public Bridge {
 public:
  explicit DeviceBridge(const std::string& path) : path_(path) {}

  Result<> start(LiveLine& line, asio::io_context& context) override {
    line_ = &line;
    auto device = SerialDevice::open(path_, line.format());
    if (!device)
      return trouble("cannot use {} with {} baud {}: {}", path_, line.format().baud, character_text(line.format()),
                     device.why());
    device_.emplace(std::move(*device));
    input_ = wait_for_device(context, *device_);
    await_input();
    line.messages().serving(fmt::format("connected to {}", path_));
    return {};
  }

  void stop() override {
    input_.reset();
    device_.reset();
  }

  SerialFormat receive_format() const override { return device_->format(); }

  void received(std::span<const ReceivedCharacter> characters) override {
    for (const ReceivedCharacter& character : characters) {
      if (output_.size() == kMostUnwritten)
        ++overrun_;
      else
        output_.push_back(character.byte);
    }
    write();
  }

  void turn() override {
    follow_port();
    write();
    if (!awaiting_input_ && line_->has_room()) await_input();
  }

  std::string failure() const override { return failure_; }

  std::string summary() const override {
    return fmt::format("{}: {} bytes from it, {} to it{}{}", path_, in_, out_,
                       overrun_ ? fmt::format(", {} lost because it did not take them", overrun_) : "",
                       errors_ ? fmt::format(", {} came with errors", errors_) : "");
  }
  nlohmann::ordered_json json() const override {
    return {{"kind", "device"},  {"device", path_},     {"bytes_in", in_},
            {"bytes_out", out_}, {"overrun", overrun_}, {"with_errors", errors_}};
  }

 private:
  static constexpr std::size_t kMostUnwritten = 65'536;  // besides what the device itself holds

  void follow_port() {
    const SerialFormat wanted = line_->format();
    if (wanted == device_->format()) return;
    if (const auto done = device_->set(wanted); !done)
      fail(fmt::format("the program has set its port to {} baud {}: {}", wanted.baud, character_text(wanted), done.why()));
  }

  void await_input() {
    awaiting_input_ = true;
    input_->wait([this](bool there) {
      awaiting_input_ = false;
      if (!there) return;  // tried again in the next turn
      line_->catch_up();
      read();
      if (failure_.empty() && line_->has_room()) await_input();
    });
  }

  void read() {
    std::vector<SerialDevice::Character> characters;
    if (const auto done = device_->read(characters); !done) fail("the device is gone: " + done.why());
    const SerialFormat format = device_->format();
    const auto fault = format.parity == Parity::None ? HostCharacter::Fault::NoStopBit : HostCharacter::Fault::WrongParity;
    std::vector<HostCharacter> sent;
    for (const auto& [byte, error] : characters) {
      sent.push_back({byte, format, error ? fault : HostCharacter::Fault::None});
      errors_ += error ? 1 : 0;
    }
    in_ += sent.size();
    if (!sent.empty()) line_->send(sent);
  }

  /// Writes to the device. Bytes that it does not take now stay for the next turn. With --speed the line may bring more than
  /// it takes.
  void write() {
    while (!output_.empty() && failure_.empty()) {
      const auto count = device_->write(output_);
      if (!count) return fail("the device is gone: " + count.why());
      if (*count == 0) return;
      out_ += *count;
      output_.erase(output_.begin(), output_.begin() + static_cast<std::ptrdiff_t>(*count));
    }
  }

  void fail(const std::string& why) {
    if (failure_.empty()) failure_ = fmt::format("{}: {}", path_, why);
  }

  std::string path_, failure_;
  LiveLine* line_ = nullptr;
  std::optional<SerialDevice> device_;
  std::unique_ptr<DeviceInput> input_;
  std::vector<std::uint8_t> output_;
  bool awaiting_input_ = false;
  std::uint64_t in_ = 0, out_ = 0, overrun_ = 0, errors_ = 0;
};

}  // namespace

std::unique_ptr<Bridge> make_device_bridge(const std::string& path) { return std::make_unique<DeviceBridge>(path); }

}  // namespace s7200::tools
