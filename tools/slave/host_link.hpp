// Characters to and from a slave outside this process, over a serial device or a TCP connection.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/base/time.hpp"
#include "tools/host/host_time.hpp"
#include "tools/host/net/sockets.hpp"
#include "tools/host/serial_device.hpp"

namespace s7200::tools {

/// The link is closed when one of these throws: SlaveUnreachable, the other side is not there; SlaveLost, no longer there.
class HostLink {
 public:
  using Character = SerialDevice::Character;

  /// The token `stop` ends each wait early.
  explicit HostLink(StopToken stop) : stop_(stop) {}
  virtual ~HostLink() = default;
  HostLink(const HostLink&) = delete;
  HostLink& operator=(const HostLink&) = delete;

  /// Opens the link, or opens it anew.
  virtual void open() = 0;
  virtual void close() = 0;
  virtual bool is_open() const = 0;

  /// The name of the link: `/dev/ttyUSB0 9600 8E1`, `127.0.0.1:502`
  virtual std::string name() const = 0;

  /// 0 where characters take no time of their own.
  virtual Time character_time() const = 0;

  /// Drives the signal beside the data of a serial line: DTR. Returns false where there is none.
  virtual bool drive_sync(bool /*high*/) { return false; }

  /// Returns when what was written is on its way.
  virtual void drain() {}

  /// Appends the characters that have come in; never waits.
  virtual void read(std::vector<Character>& characters) = 0;

  /// Writes all bytes. A side that takes none for 5 s counts as gone.
  void write(std::span<const std::uint8_t> bytes);

  /// Waits for input, or the end of the connection, until that time of the host. Returns whether there is any.
  bool wait_for_input(Time until) const;

  /// A pause until that time of the host.
  void sleep_until(Time until) const;

  bool stop_requested() const { return stop_.stop_requested(); }

 protected:
  /// Whether there is something to read, or room to write, within that time; the end counts, reading or writing then tells.
  virtual bool has_input(std::chrono::nanoseconds at_most) const = 0;
  virtual bool has_room(std::chrono::nanoseconds at_most) const = 0;

  /// Writes some bytes. Returns how many were taken; 0 when none can be just now.
  virtual std::size_t write_some(std::span<const std::uint8_t> bytes) = 0;

  StopToken stop_;

 private:
  /// Whether `comes` says so before `until` and before a stop; it is asked again and again.
  bool wait_until(Time until, const std::function<bool(std::chrono::nanoseconds at_most)>& comes) const;
};

class SerialLink final : public HostLink {
 public:
  SerialLink(std::string path, const SerialFormat& format, StopToken stop);

  void open() override;
  void close() override { device_.reset(); }
  bool is_open() const override { return device_ != nullptr; }
  std::string name() const override;
  Time character_time() const override { return format_.character_time(); }
  bool drive_sync(bool high) override;
  void drain() override;
  void read(std::vector<Character>& characters) override;

 private:
  bool has_input(std::chrono::nanoseconds at_most) const override { return device_->wait_for_input(at_most); }
  bool has_room(std::chrono::nanoseconds at_most) const override { return device_->wait_for_room(at_most); }
  std::size_t write_some(std::span<const std::uint8_t> bytes) override;
  [[noreturn]] void gone(const std::string& why);

  std::string path_;
  SerialFormat format_;
  std::unique_ptr<SerialDevice> device_;
};

class TcpLink final : public HostLink {
 public:
  /// A name or address, and a port by number or name.
  TcpLink(std::string host, std::string port, StopToken stop);

  /// Tries each address of the host for 5 s.
  void open() override;
  void close() override { connection_.reset(); }
  bool is_open() const override { return connection_ != nullptr; }
  std::string name() const override;
  Time character_time() const override { return 0; }
  void read(std::vector<Character>& characters) override;

 private:
  bool has_input(std::chrono::nanoseconds at_most) const override { return connection_->wait_for_input(at_most); }
  bool has_room(std::chrono::nanoseconds at_most) const override { return connection_->wait_for_room(at_most); }
  std::size_t write_some(std::span<const std::uint8_t> bytes) override;
  [[noreturn]] void gone(const std::string& why);

  std::string host_, port_;
  std::unique_ptr<TcpConnection> connection_;
};

}  // namespace s7200::tools
