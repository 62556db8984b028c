#include "tools/bridge/tcp_bridges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/counted.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/modbus/gateway.hpp"
#include "serial_sim/modbus/line_turns.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "tools/bridge/com_port.hpp"
#include "tools/bridge/tcp_server.hpp"
#include "tools/plan/bridge_kinds.hpp"

namespace s7200::tools {
namespace {

using Client = TcpServer::Client;
using serial::HostCharacter;

void put_on_line(LiveLine& line, std::span<const std::uint8_t> bytes, Client sender = 0) {
  const SerialFormat format = line.format();
  std::vector<HostCharacter> characters;
  for (const std::uint8_t byte : bytes) characters.push_back({.byte = byte, .format = format, .sender = sender});
  if (!characters.empty()) line.send(characters);
}

/// The common part of the TCP bridges: a server, and the line in the PLC's own format.
class TcpBridge : public Bridge, protected TcpServer::Protocol {
 public:
  TcpBridge(BridgeKind kind, const ListenAddress& address) : kind_(row_of(kind).word()), address_(address) {}

  Result<> start(LiveLine& line, boost::asio::io_context& context) override {
    line_ = &line;
    auto server = TcpServer::open(address_, *this, context, line.messages());
    if (!server) return server.trouble();
    server_ = *std::move(server);
    return {};
  }

  void stop() override {
    if (server_) counts_ = server_->counts();
    server_.reset();
  }

  SerialFormat receive_format() const override { return line_->format(); }

  std::string summary() const override {
    return fmt::format("{}: {}{}, {} bytes from them, {} to them{}{}", kind_, counted(counts_.clients, "client"),
                       counts_.refused ? fmt::format(", {} sent away for others", counts_.refused) : "", counts_.bytes_in,
                       counts_.bytes_out, counts_.dropped ? fmt::format(", {} dropped that they left", counts_.dropped) : "",
                       more_summary());
  }

  nlohmann::ordered_json json() const override {
    nlohmann::ordered_json json{{"kind", kind_},
                                {"clients", counts_.clients},
                                {"sent_away", counts_.refused},
                                {"bytes_in", counts_.bytes_in},
                                {"bytes_out", counts_.bytes_out},
                                {"bytes_dropped", counts_.dropped}};
    json.update(more_json());
    return json;
  }

 protected:
  virtual std::string more_summary() const { return {}; }
  virtual nlohmann::ordered_json more_json() const { return nlohmann::ordered_json::object(); }

  LiveLine& line() const { return *line_; }

  /// The state of the line. No slave is asked until the first scan has ended and the line has been quiet since: only then a
  /// program has set up its port.
  modbus::LineTurns::Line line_state() {
    if (!up_since_ && line_->program_is_up()) {
      up_since_ = line_->now();
      if (const std::string why = line_->why_no_modbus(); !why.empty())
        line_->messages().note(fmt::format("{} carries nothing but Modbus, and {}", kind_, why));
    }
    return {.now = line_->now(),
            .format = line_->format(),
            .sending = line_->host_port().sending(),
            .receiving = line_->host_port().character_due() != kNever,
            .quiet_since = up_since_ ? std::max(*up_since_, line_->last_activity()) : line_->now(),
            .quiet_time = serial::default_quiet(line_->format())};
  }

  TcpServer& server() const { return *server_; }

 private:
  std::string_view kind_;
  ListenAddress address_;
  LiveLine* line_ = nullptr;
  std::optional<Time> up_since_;
  std::unique_ptr<TcpServer> server_;
  TcpServer::Counts counts_;
};

class RawBridge final : public TcpBridge {
 public:
  explicit RawBridge(const ListenAddress& address) : TcpBridge(BridgeKind::Tcp, address) {}

  void received(std::span<const ReceivedCharacter> characters) override {
    std::vector<std::uint8_t> bytes;
    for (const ReceivedCharacter& character : characters) bytes.push_back(character.byte);
    server().send_to_all(bytes);
  }
  void turn() override { server().turn(); }

 private:
  /// How long a client can still hear answers after its last bytes: a second of the line's time.
  static constexpr Time kHearsOn = kSecond;

  void take(Client client, std::span<const std::uint8_t> bytes) override {
    line().catch_up();
    put_on_line(line(), bytes, client);
  }
  std::size_t gone(Client client) override { return line().drop(client); }
  bool wants_more(Client client) const override { return line().has_room(client); }
  bool unsent(Client client) const override { return line().waiting(client) != 0; }
  bool expects_answer(Client) const override {
    return line().host_port().sending() || line().now() - line().last_activity() < kHearsOn;
  }
  bool partial(Client) const override { return false; }
};

class Rfc2217Bridge final : public TcpBridge {
 public:
  Rfc2217Bridge(const ListenAddress& address, const serial::LineSettings& options)
      : TcpBridge(BridgeKind::Rfc2217, address), options_(options) {}

  SerialFormat receive_format() const override {
    const auto speaker = ports_.find(speaker_);
    return speaker == ports_.end() ? line().format() : format_of(speaker->second);
  }

  void received(std::span<const ReceivedCharacter> characters) override {
    for (auto& [client, port] : ports_) server().send(client, port.received(characters));
  }
  void turn() override { server().turn(); }

 private:
  static constexpr Time kHearsOn = kSecond;  // after the client's last bytes, as with --tcp

  SerialFormat format_of(const ComPort& port) const { return options_.over(port.format()); }

  void came(Client client) override {
    const auto character = [this, client](std::uint8_t byte) { put(client, {.byte = byte}); };
    const auto begin_break = [this, client] {
      ++breaks_;
      held_since_[client] = line().now();
      put(client, {.fault = HostCharacter::Fault::Break});
    };
    ports_.try_emplace(client, ComPort::Port{.format = [this] { return line().program_format(); },
                                             .character = character,
                                             .begin_break = begin_break,
                                             .end_break = [this, client] { end_break(client); },
                                             .purge = [this, client] { purged_ += line().drop(client); }});
    speaker_ = client;
  }

  void put(Client client, HostCharacter character) {
    character.format = format_of(ports_.at(client));
    character.sender = client;
    line().send(std::span(&character, 1));
  }

  void end_break(Client client) {
    if (const auto held = held_since_.extract(client)) line().end_break(client, line().now() - held.mapped());
  }

  void take(Client client, std::span<const std::uint8_t> bytes) override {
    line().catch_up();
    speaker_ = client;
    server().send(client, ports_.at(client).take(bytes));
  }
  std::size_t gone(Client client) override {
    ports_.erase(client);
    end_break(client);
    return line().drop(client);
  }
  std::string error(Client client) const override {
    const auto port = ports_.find(client);
    return port == ports_.end() ? "" : port->second.error();
  }
  bool wants_more(Client client) const override { return line().has_room(client); }
  bool unsent(Client client) const override { return line().waiting(client) != 0; }
  bool expects_answer(Client) const override {
    return line().host_port().sending() || line().now() - line().last_activity() < kHearsOn;
  }
  bool partial(Client) const override { return false; }

  std::string more_summary() const override {
    return fmt::format("{}{}", breaks_ ? "; " + counted(breaks_, "break") : "",
                       purged_ ? fmt::format("; {} bytes purged by them", purged_) : "");
  }
  nlohmann::ordered_json more_json() const override { return {{"breaks", breaks_}, {"bytes_purged", purged_}}; }

  serial::LineSettings options_;
  std::map<Client, ComPort> ports_;
  std::map<Client, Time> held_since_;  // breaks that their clients have not ended
  Client speaker_ = 0;                 // in whose format the line is heard
  std::uint64_t breaks_ = 0, purged_ = 0;
};

class RtuBridge final : public TcpBridge {
 public:
  bool carries_ppi() const override { return false; }
  RtuBridge(const ListenAddress& address, Time timeout) : TcpBridge(BridgeKind::RtuOverTcp, address), turns_(timeout) {}

  void received(std::span<const ReceivedCharacter> characters) override {
    for (const ReceivedCharacter& character : characters) turns_.received(character, line().format());
  }

  void turn() override {
    const auto now = Clock::now();
    for (auto& [client, part] : parts_) {
      if (!takes_more(client))
        part.heard = now;  // it is not read from: it need not have ended
      else
        end_of_pause(client, part, now - part.heard);
    }
    put_on_line(line(), turns_.turn(line_state()));
    for (const modbus::LineTurns::Outcome& outcome : turns_.take_outcomes()) {
      if (outcome.answer.empty()) continue;
      ++answers_;
      server().send(outcome.client, outcome.answer);
    }
    for (auto& [client, part] : parts_) ask_complete(client, part);  // before more is read
    server().turn();
  }

  Time due() const override { return turns_.due(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kFrameEnd{20}, kGivenUp{1000};
  static constexpr std::size_t kMostOpen = 4;

  /// The state of a client's next frame.
  struct Part {
    Bytes bytes;
    std::size_t after_pause = 0;  ///< where that begins which came after the last pause
    Clock::time_point heard;
  };

  void take(Client client, std::span<const std::uint8_t> bytes) override {
    line().catch_up();
    Part& part = parts_[client];
    const auto now = Clock::now();
    if (now - part.heard >= kFrameEnd) part.after_pause = part.bytes.size();
    part.bytes.insert(part.bytes.end(), bytes.begin(), bytes.end());
    part.heard = now;
    ask_complete(client, part);
  }

  bool takes_more(Client client) const { return turns_.open(client) < kMostOpen; }

  /// Asks complete frames. Bytes too many for a frame are sent as they are. A whole frame after a pause shows that the bytes
  /// before it never become one.
  void ask_complete(Client client, Part& part) {
    while (takes_more(client)) {
      std::size_t size = modbus::first_request(part.bytes);
      if (size == 0 && part.after_pause != 0 &&
          modbus::first_request(std::span(part.bytes).subspan(part.after_pause)) != 0) {
        give_up(part, part.after_pause);
        continue;
      }
      if (size == 0 && part.bytes.size() > modbus::kLongestRtuFrame) size = part.bytes.size();
      if (size == 0) return;
      ask(client, part, size);
    }
  }

  /// A frame with a wrong CRC goes out as it is, once its length or, if that is not known, a long pause says that it is
  /// whole. A part of a frame would take as much of the line's time as a frame: it waits here, and is given up in the end.
  void end_of_pause(Client client, Part& part, Clock::duration pause) {
    if (part.bytes.empty() || pause < kFrameEnd) return;
    const modbus::Extent extent = modbus::extent_of_request(part.bytes);
    if (extent == modbus::Extent::Whole || (extent == modbus::Extent::Unknown && pause >= kGivenUp))
      ask(client, part, part.bytes.size());
    else if (pause >= kGivenUp)
      give_up(part, part.bytes.size());
  }

  Bytes take_from(Part& part, std::size_t size) {
    const auto end = part.bytes.begin() + static_cast<std::ptrdiff_t>(size);
    Bytes bytes(part.bytes.begin(), end);
    part.bytes.erase(part.bytes.begin(), end);
    part.after_pause -= std::min(part.after_pause, size);
    return bytes;
  }

  void give_up(Part& part, std::size_t size) {
    take_from(part, size);
    ++incomplete_;
  }

  /// Asks a frame. A client that sends again has stopped waiting, also when both frames came at once: RTU does not say which
  /// answer belongs to which request, so that an answer to the earlier one would be taken for the later one's. Broadcasts
  /// are not waited for.
  void ask(Client client, Part& part, std::size_t size) {
    ++frames_;
    given_up_ += turns_.stop_waiting(client);
    Bytes frame = take_from(part, size);
    const bool broadcast = frame[0] == modbus::kBroadcast;
    turns_.ask(client, {.frame = std::move(frame), .wants_answer = !broadcast});
  }

  std::size_t gone(Client client) override {
    std::size_t dropped = turns_.waiting(client);
    if (const auto part = parts_.extract(client)) dropped += part.mapped().bytes.size();
    turns_.forget(client);
    return dropped;
  }
  bool wants_more(Client client) const override { return takes_more(client); }
  bool unsent(Client client) const override { return turns_.unsent(client); }
  bool expects_answer(Client client) const override {
    const auto part = parts_.find(client);
    return turns_.open(client) != 0 || (part != parts_.end() && !part->second.bytes.empty());
  }
  bool partial(Client) const override { return false; }  // that is given up by itself

  std::string more_summary() const override {
    return fmt::format("; {} frames, {} answered{}{}", frames_, answers_,
                       given_up_ ? fmt::format(", {} given up for another", given_up_) : "",
                       incomplete_ ? fmt::format(", {} never came in full", incomplete_) : "");
  }
  nlohmann::ordered_json more_json() const override {
    return {{"frames", frames_}, {"answered", answers_}, {"given_up", given_up_}, {"incomplete", incomplete_}};
  }

  modbus::LineTurns turns_;
  std::map<Client, Part> parts_;
  std::uint64_t frames_ = 0, answers_ = 0, given_up_ = 0, incomplete_ = 0;
};

class GatewayBridge final : public TcpBridge {
 public:
  bool carries_ppi() const override { return false; }
  GatewayBridge(const ListenAddress& address, Time timeout) : TcpBridge(BridgeKind::ModbusTcp, address), gateway_(timeout) {}

  void received(std::span<const ReceivedCharacter> characters) override {
    for (const ReceivedCharacter& character : characters) gateway_.received(character, line().format());
  }

  void turn() override {
    put_on_line(line(), gateway_.turn(line_state()));
    for (const modbus::Gateway::Answer& answer : gateway_.take_answers()) server().send(answer.client, answer.bytes);
    server().turn();
  }

  Time due() const override { return gateway_.due(); }

 private:
  void take(Client client, std::span<const std::uint8_t> bytes) override {
    line().catch_up();
    if (modbus::first_request(bytes) != 0) speaks_rtu_.insert(client);
    gateway_.take(client, bytes);
  }
  std::size_t gone(Client client) override {
    const std::size_t dropped = gateway_.waiting(client);
    speaks_rtu_.erase(client);
    gateway_.forget(client);
    return dropped;
  }
  bool unsent(Client client) const override { return gateway_.unsent(client); }
  std::string error(Client client) const override {
    const std::string error = gateway_.error(client);
    if (error.empty()) return error;
    return fmt::format("this is not Modbus TCP: {}{}", error,
                       speaks_rtu_.contains(client) ? "; it is Modbus RTU, for which there is --rtu-over-tcp" : "");
  }
  bool wants_more(Client client) const override { return gateway_.wants_more(client); }
  bool expects_answer(Client client) const override { return gateway_.open(client) != 0; }
  bool partial(Client client) const override { return gateway_.partial(client); }

  std::string more_summary() const override {
    const auto& counts = gateway_.counts();
    return fmt::format("; {}, {} answered, {} broadcast, {} without answer, {} with a damaged one, {} to no station",
                       counted(counts.requests, "request"), counts.answers, counts.broadcasts, counts.silent, counts.damaged,
                       counts.no_path);
  }
  nlohmann::ordered_json more_json() const override {
    const auto& counts = gateway_.counts();
    return {{"requests", counts.requests}, {"answered", counts.answers}, {"broadcast", counts.broadcasts},
            {"silent", counts.silent},     {"damaged", counts.damaged},  {"no_station", counts.no_path}};
  }

  modbus::Gateway gateway_;
  std::set<Client> speaks_rtu_;  // by a frame of theirs with a right CRC
};

}  // namespace

std::unique_ptr<Bridge> make_tcp_bridge(const ListenAddress& address) { return std::make_unique<RawBridge>(address); }

std::unique_ptr<Bridge> make_rfc2217_bridge(const ListenAddress& address, const serial::LineSettings& line) {
  return std::make_unique<Rfc2217Bridge>(address, line);
}

std::unique_ptr<Bridge> make_rtu_over_tcp_bridge(const ListenAddress& address, Time timeout) {
  return std::make_unique<RtuBridge>(address, timeout);
}

std::unique_ptr<Bridge> make_modbus_tcp_bridge(const ListenAddress& address, Time timeout) {
  return std::make_unique<GatewayBridge>(address, timeout);
}

}  // namespace s7200::tools
