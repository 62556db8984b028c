// Slaves outside this process: Modbus RTU over a serial device or a TCP connection, and Modbus TCP.
#pragma once

#include <memory>

#include "tools/slave/host_link.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

/// The common part of slaves outside the simulation. Time is that of the host. Ctrl-C ends an exchange or a wait at once;
/// the characters received by then are the result. A link that broke is opened again by the next exchange.
class HostSlave : public Slave {
 public:
  void forget_unasked() override { make_ready(); }
  void wait(Time duration) override { link_->sleep_until(host_time() + duration); }
  Time now() const override { return host_time() - made_at_; }
  bool stop_requested() const override { return link_->stop_requested(); }
  std::string name() const override { return link_->name(); }
  std::string remark() const override { return remark_; }

 protected:
  /// Opens the link. Throws SlaveUnreachable.
  explicit HostSlave(std::unique_ptr<HostLink> link);

  /// A working link. What came in unasked is thrown away, and remarked.
  void make_ready();

  /// A working link, with what came in unasked.
  void open_again();

  /// Appends what came in before `until`. False when nothing did, or the link ended and something is there to be shown.
  bool take_in(std::vector<HostLink::Character>& characters, Time until);

  void remark(const std::string& text);

  std::unique_ptr<HostLink> link_;

 private:
  Time made_at_ = host_time();
  std::string remark_;
};

/// A stream of characters: Modbus RTU, or another protocol of a serial line.
///
/// Times: a serial device gets the request at once, so its characters end when their format says; of what it delivers only
/// the arrival is known, and a character has begun a character time before. USB adapters deliver up to 16 ms late. Over TCP
/// a character takes no time.
///
/// A host cannot see a silence of 3.5 characters. An answer that is complete has ended when nothing came for 20 ms (or 3.5
/// characters, if that is more), any other after 200 ms: an adapter or a gateway may deliver it in pieces. A silence in the
/// request is taken as it is.
class RtuSlave final : public HostSlave {
 public:
  static constexpr Time kSilence = 20 * kMillisecond;
  static constexpr Time kSilenceInside = 200 * kMillisecond;

  /// Opens the device. Throws SlaveUnreachable.
  RtuSlave(const std::string& device, const SerialFormat& format, IsComplete is_complete, StopToken stop);
  RtuSlave(const std::string& host, const std::string& port, IsComplete is_complete, StopToken stop);

  /// Runs an exchange. Throws std::invalid_argument for a byte with wrong parity.
  serial::Exchange exchange(const serial::Request& request) override;

  /// Receives a transmission. Characters that came while nothing was asked of the device count as one transmission that
  /// began with this call.
  serial::Exchange receive(const serial::Listening& listening) override;
  /// The silence that ended an answer is pause enough. After a request without answer slaves take it for over only then.
  Time pause() const override { return unanswered_ ? quiet_ : 0; }

 private:
  void send(const Bytes& bytes, Time gap);
  void collect(serial::Exchange& exchange, Time until, const std::optional<Time>& silence);
  Time silence_after(const serial::Exchange& exchange) const;

  IsComplete is_complete_;
  bool has_parity_ = false;
  Time shortest_silence_ = 0;
  Time quiet_ = 0;           ///< that slaves need to see the end of a request; not known over TCP
  bool unanswered_ = false;  ///< the last request
};

/// Modbus TCP (Modbus Messaging on TCP/IP, 3.1.3): the unit id is the station, the CRC is taken off the request and put on
/// the answer, so that exchanges look the same everywhere. The answer's time is that of its first byte. Answers to other
/// transactions are ignored, and remarked.
class ModbusTcpSlave final : public HostSlave {
 public:
  /// Connects to the host. Throws SlaveUnreachable.
  ModbusTcpSlave(const std::string& host, const std::string& port, StopToken stop);

  /// Runs an exchange. Throws std::invalid_argument for a frame without a right CRC, and for a byte with wrong parity.
  serial::Exchange exchange(const serial::Request& request) override;

  /// Modbus TCP has no line to listen to: throws std::invalid_argument.
  serial::Exchange receive(const serial::Listening& listening) override;
  Time pause() const override { return 0; }

 private:
  std::uint16_t transaction_ = 0;
};

}  // namespace s7200::tools
