#include "tools/bridge/pty_bridge.hpp"

#include <fmt/format.h>

#include "interpreter/base/result.hpp"

namespace s7200::tools {
namespace {

/// Windows has no ptys: what would stand here says what does the same there.
class NoPtyBridge final : public Bridge {
 public:
  explicit NoPtyBridge(const std::string& link) : link_(link) {}

  Result<> start(LiveLine&, boost::asio::io_context&) override {
    return trouble(
        "cannot serve {}: Windows has no ptys. Use --tcp, --rfc2217 or --modbus-tcp with a master that speaks TCP; or a "
        "pair "
        "of virtual COM ports, the master on one of them and --device on the other",
        link_);
  }
  void stop() override {}
  SerialFormat receive_format() const override { return {}; }
  void received(std::span<const ReceivedCharacter>) override {}
  void turn() override {}
  std::string summary() const override { return link_ + ": not served"; }
  nlohmann::ordered_json json() const override { return {{"kind", "pty"}, {"link", link_}}; }

 private:
  std::string link_;
};

}  // namespace

std::unique_ptr<Bridge> make_pty_bridge(const std::string& link, const serial::LineSettings&) {
  return std::make_unique<NoPtyBridge>(link);
}

}  // namespace s7200::tools
