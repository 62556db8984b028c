// A bridge: what joins the simulated line to a pty, a socket or a device of this computer.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "interpreter/base/result.hpp"
#include "serial_sim/peers/host_port.hpp"

namespace boost::asio {
class io_context;
}

namespace s7200::tools {

/// Takes messages while a run goes on, a line each.
struct LiveMessages {
  using Say = std::function<void(const std::string& text)>;
  Say serving = [](const std::string&) {};  ///< `listening on 127.0.0.1:5020`: clients may come now
  Say note = [](const std::string&) {};     ///< something has happened that the engineer should know
};

/// The simulation, as a bridge sees it: always at the present when it is asked.
class LiveLine {
 public:
  virtual ~LiveLine() = default;

  /// Brings the simulation to the present moment: to be called when something has come in, before it is put on the line.
  virtual void catch_up() = 0;

  /// Puts characters on the line from now on.
  virtual void send(std::span<const serial::HostCharacter> characters) = 0;

  /// Drops the characters of `sender` that are waiting to be sent. Returns how many there were.
  virtual std::size_t drop(std::uint64_t sender) = 0;

  /// The open break of `sender` has been held for `lasts`, as HostPort::end_break() has it.
  virtual void end_break(std::uint64_t sender, Time lasts) = 0;

  /// The format that the program has set its port to, with the options' settings in place of its own.
  virtual SerialFormat format() const = 0;

  virtual const LiveMessages& messages() const = 0;
  virtual Time now() const = 0;

  /// The end of the line where the bridge stands.
  virtual const serial::HostPort& host_port() const = 0;

  /// The format that the program sets its port to, Freeport mode or not.
  virtual SerialFormat program_format() const = 0;

  /// Whether the program's first scan has ended: before that it has hardly set its port.
  virtual bool program_is_up() const = 0;

  /// Why no station on the line answers Modbus, with the programs as they are now; empty if one may.
  virtual std::string why_no_modbus() const = 0;

  /// End of the last character that anyone sent or heard.
  virtual Time last_activity() const = 0;

  /// More than this is not put into the queue of the line, nor more of one sender if there are several: whoever writes
  /// faster than the line sends has to wait. It is about a second of one at 9600 baud.
  static constexpr std::size_t kMostWaiting = 4096, kMostOfOne = 1024;
  bool has_room() const { return host_port().waiting() < kMostWaiting; }
  bool has_room(std::uint64_t sender) const { return has_room() && waiting(sender) < kMostOfOne; }
  std::size_t waiting(std::uint64_t sender) const { return host_port().waiting(sender); }
};

class Bridge {
 public:
  virtual ~Bridge() = default;

  /// Starts to serve, and says where. Trouble if it cannot. `line` and `context` outlive the bridge's
  /// handlers.
  virtual Result<> start(LiveLine& line, boost::asio::io_context& context) = 0;

  /// Stops serving. `context` and the other arguments of start() may go then; the summary stays.
  virtual void stop() = 0;

  /// Whether it carries any characters, PPI too, and not only frames of Modbus.
  virtual bool carries_ppi() const { return true; }

  /// The format in which characters from the line are received.
  virtual SerialFormat receive_format() const = 0;

  /// Is told of characters from the line.
  virtual void received(std::span<const ReceivedCharacter> characters) = 0;

  /// Comes after each stretch of simulation, and then not later than due().
  virtual void turn() = 0;
  virtual Time due() const { return kNever; }

  /// Why it cannot go on; empty as long as it can.
  virtual std::string failure() const { return {}; }

  /// The end of the run, in one line for people and for machines.
  virtual std::string summary() const = 0;
  virtual nlohmann::ordered_json json() const = 0;
};

}  // namespace s7200::tools
