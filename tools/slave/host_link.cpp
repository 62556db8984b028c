#include "tools/slave/host_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

#include "tools/slave/slave.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr Time kPatience = 5 * kSecond;      // with a side that does not take what is sent, or does not let us in
constexpr Time kSlice = 100 * kMillisecond;  // a stop is heard in between

}  // namespace

bool HostLink::wait_until(Time until, const std::function<bool(std::chrono::nanoseconds)>& comes) const {
  while (!stop_requested()) {
    const Time left = std::clamp(until - host_time(), Time{0}, kSlice);
    if (comes(std::chrono::nanoseconds(left))) return true;
    if (left == 0) return false;
  }
  return false;
}

void HostLink::sleep_until(Time until) const {
  wait_until(until, [](std::chrono::nanoseconds at_most) {
    std::this_thread::sleep_for(at_most);
    return false;
  });
}

bool HostLink::wait_for_input(Time until) const {
  return wait_until(until, [this](std::chrono::nanoseconds at_most) { return has_input(at_most); });
}

void HostLink::write(std::span<const std::uint8_t> bytes) {
  Time give_up = host_time() + kPatience;
  while (!bytes.empty() && !stop_requested()) {
    const std::size_t taken = write_some(bytes);
    bytes = bytes.subspan(taken);
    if (taken > 0) give_up = host_time() + kPatience;
    const auto room = [this](std::chrono::nanoseconds at_most) { return has_room(at_most); };
    if (!bytes.empty() && !wait_until(give_up, room) && !stop_requested()) {
      const std::string who = name();
      close();
      throw SlaveLost(fmt::format("{} takes nothing for {}", who, format_duration(kPatience)));
    }
  }
}

SerialLink::SerialLink(std::string path, const SerialFormat& format, StopToken stop)
    : HostLink(stop), path_(std::move(path)), format_(format) {}

void SerialLink::open() {
  close();
  auto device = SerialDevice::open(path_, format_);
  if (!device) throw SlaveUnreachable(fmt::format("cannot open {}: {}", path_, device.why()));
  device_ = std::make_unique<SerialDevice>(std::move(*device));
}

std::string SerialLink::name() const { return fmt::format("{} {} {}", path_, format_.baud, character_text(format_)); }

void SerialLink::gone(const std::string& why) {
  close();
  throw SlaveLost(fmt::format("{} is gone: {}", path_, why));
}

void SerialLink::read(std::vector<Character>& characters) {
  if (const auto done = device_->read(characters); !done) gone(done.why());
}

bool SerialLink::drive_sync(bool high) { return device_->drive_dtr(high); }

void SerialLink::drain() { device_->drain(); }

std::size_t SerialLink::write_some(std::span<const std::uint8_t> bytes) {
  const auto taken = device_->write(bytes);
  if (!taken) gone(taken.why());
  return *taken;
}

TcpLink::TcpLink(std::string host, std::string port, StopToken stop)
    : HostLink(stop), host_(std::move(host)), port_(std::move(port)) {}

std::string TcpLink::name() const {
  return host_.find(':') == std::string::npos ? fmt::format("{}:{}", host_, port_) : fmt::format("[{}]:{}", host_, port_);
}

void TcpLink::open() {
  close();
  auto connection = TcpConnection::open(host_, port_, std::chrono::nanoseconds(kPatience), stop_);
  if (!connection)
    throw SlaveUnreachable(connection.why().empty() ? fmt::format("{} was not reached before the interruption", name())
                                                    : fmt::format("cannot reach {}: {}", name(), connection.why()));
  connection_ = *std::move(connection);
}

void TcpLink::gone(const std::string& why) {
  close();
  throw SlaveLost(fmt::format("{} {}", name(), why));
}

void TcpLink::read(std::vector<Character>& characters) {
  std::array<std::uint8_t, 4096> bytes{};
  const auto count = connection_->read(bytes);
  if (!count) gone(count.why());
  for (std::size_t i = 0; i < *count; ++i) characters.push_back({bytes[i], false});
}

std::size_t TcpLink::write_some(std::span<const std::uint8_t> bytes) {
  const auto count = connection_->write(bytes);
  if (!count) gone(count.why());
  return *count;
}

}  // namespace s7200::tools
