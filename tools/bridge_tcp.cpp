#include "tools/bridge_tcp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <utility>

#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/modbus/gateway.hpp"
#include "serial_sim/modbus/line_turns.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "tools/bridge_server.hpp"

namespace s7200::tools {
namespace {

using Client = TcpServer::Client;
using serial::HostCharacter;

void put_on_line(LiveLine& line, std::span<const std::uint8_t> bytes) {
  const SerialFormat format = line.format();
  std::vector<HostCharacter> characters;
  for (const std::uint8_t byte : bytes) characters.push_back({.byte = byte, .format = format});
  if (!characters.empty()) line.send(characters);
}

/// What all three have in common: a server, and the line in the PLC's own format.
class TcpBridge : public Bridge, protected TcpServer::Protocol {
 public:
  TcpBridge(std::string_view kind, const ListenAddress& address) : kind_(kind), address_(address) {}

  bool start(LiveLine& line, boost::asio::io_context& context) override {
    line_ = &line;
    server_ = TcpServer::open(address_, *this, context);
    return server_ != nullptr;
  }

  void stop() override {
    if (server_) counts_ = server_->counts();
    server_.reset();
  }

  SerialFormat receive_format() const override { return line_->format(); }

  std::string summary() const override {
    return fmt::format("{}: {} client{}{}, {} bytes from them, {} to them{}", kind_, counts_.clients,
                       counts_.clients == 1 ? "" : "s",
                       counts_.refused ? fmt::format(", {} sent away for others", counts_.refused) : "", counts_.bytes_in,
                       counts_.bytes_out, more_summary());
  }

  nlohmann::ordered_json json() const override {
    nlohmann::ordered_json json{{"kind", kind_},
                                {"clients", counts_.clients},
                                {"sent_away", counts_.refused},
                                {"bytes_in", counts_.bytes_in},
                                {"bytes_out", counts_.bytes_out}};
    json.update(more_json());
    return json;
  }

 protected:
  virtual std::string more_summary() const { return {}; }
  virtual nlohmann::ordered_json more_json() const { return nlohmann::ordered_json::object(); }

  LiveLine& line() const { return *line_; }

  /// Nobody is asked until the first scan has ended and the line has been quiet since: only then a program has set up its
  /// port.
  modbus::LineTurns::Line line_state() {
    const serial::Simulation& simulation = line_->simulation();
    if (!up_since_ && simulation.cpu().state().scans > 0) up_since_ = line_->now();
    return {.now = line_->now(),
            .format = line_->format(),
            .sending = simulation.host_port().sending(),
            .receiving = simulation.host_port().character_due() != kNever,
            .quiet_since = up_since_ ? std::max(*up_since_, simulation.last_activity()) : line_->now(),
            .quiet_time = serial::Simulation::default_quiet(line_->format())};
  }

  TcpServer& server() const { return *server_; }

 private:
  std::string kind_;
  ListenAddress address_;
  LiveLine* line_ = nullptr;
  std::optional<Time> up_since_;
  std::unique_ptr<TcpServer> server_;
  TcpServer::Counts counts_;
};

class RawBridge final : public TcpBridge {
 public:
  explicit RawBridge(const ListenAddress& address) : TcpBridge("tcp", address) {}

  void received(std::span<const ReceivedCharacter> characters) override {
    std::vector<std::uint8_t> bytes;
    for (const ReceivedCharacter& character : characters) bytes.push_back(character.byte);
    server().send_to_all(bytes);
  }
  void turn() override { server().turn(); }

 private:
  /// After its last word a client has a second, of the line's time, to hear what comes of it.
  static constexpr Time kHearsOn = kSecond;

  void take(Client, std::span<const std::uint8_t> bytes) override {
    line().catch_up();
    put_on_line(line(), bytes);
  }
  void gone(Client) override {}
  bool wants_more(Client) const override { return line().has_room(); }
  bool expects_answer(Client) const override {
    const serial::Simulation& simulation = line().simulation();
    return simulation.host_port().sending() || !simulation.line_quiet_for(kHearsOn);
  }
  bool partial(Client) const override { return false; }
};

class RtuBridge final : public TcpBridge {
 public:
  RtuBridge(const ListenAddress& address, Time timeout) : TcpBridge("rtu-over-tcp", address), turns_(timeout) {}

  void received(std::span<const ReceivedCharacter> characters) override {
    for (const ReceivedCharacter& character : characters) turns_.received(character, line().format());
  }

  void turn() override {
    const auto now = Clock::now();
    for (auto& [client, part] : parts_) {
      ask_complete(client, part);
      if (!takes_more(client))
        part.heard = now;  // it is not read from: it need not have ended
      else if (!part.bytes.empty() && now - part.heard >= kFrameEnd)
        ask(client, part, part.bytes.size());
    }
    put_on_line(line(), turns_.turn(line_state()));
    for (const modbus::LineTurns::Outcome& outcome : turns_.take_outcomes()) {
      if (outcome.answer.empty()) continue;
      ++answers_;
      server().send(outcome.client, outcome.answer);
    }
    server().turn();
  }

  Time due() const override { return turns_.due(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kFrameEnd{20};
  static constexpr std::size_t kMostOpen = 4;

  struct Part {
    modbus::Bytes bytes;
    Clock::time_point heard;
  };

  void take(Client client, std::span<const std::uint8_t> bytes) override {
    line().catch_up();
    Part& part = parts_[client];
    part.bytes.insert(part.bytes.end(), bytes.begin(), bytes.end());
    part.heard = Clock::now();
    ask_complete(client, part);
  }

  bool takes_more(Client client) const { return turns_.open(client) < kMostOpen; }

  /// What is too long to become a frame goes out as it is.
  void ask_complete(Client client, Part& part) {
    while (takes_more(client)) {
      std::size_t size = modbus::first_request(part.bytes);
      if (size == 0 && part.bytes.size() > modbus::kLongestRtuFrame) size = part.bytes.size();
      if (size == 0) return;
      ask(client, part, size);
    }
  }

  /// One that sends again has stopped waiting, also when both frames came at once: RTU does not say which answer belongs to
  /// which request, so that an answer to the earlier one would be taken for the later one's. Broadcasts are not waited for.
  void ask(Client client, Part& part, std::size_t size) {
    ++frames_;
    given_up_ += turns_.stop_waiting(client);
    const auto end = part.bytes.begin() + static_cast<std::ptrdiff_t>(size);
    modbus::Bytes frame(part.bytes.begin(), end);
    part.bytes.erase(part.bytes.begin(), end);
    const bool broadcast = frame[0] == modbus::kBroadcast;
    turns_.ask(client, {.frame = std::move(frame), .wants_answer = !broadcast});
  }

  void gone(Client client) override {
    parts_.erase(client);
    turns_.forget(client);
  }
  bool wants_more(Client client) const override { return takes_more(client); }
  bool expects_answer(Client client) const override {
    const auto part = parts_.find(client);
    return turns_.open(client) != 0 || (part != parts_.end() && !part->second.bytes.empty());
  }
  bool partial(Client) const override { return false; }  // 20 ms make it a frame

  std::string more_summary() const override {
    return fmt::format("; {} frames, {} answered{}", frames_, answers_,
                       given_up_ ? fmt::format(", {} given up for another", given_up_) : "");
  }
  nlohmann::ordered_json more_json() const override {
    return {{"frames", frames_}, {"answered", answers_}, {"given_up", given_up_}};
  }

  modbus::LineTurns turns_;
  std::map<Client, Part> parts_;
  std::uint64_t frames_ = 0, answers_ = 0, given_up_ = 0;
};

class GatewayBridge final : public TcpBridge {
 public:
  GatewayBridge(const ListenAddress& address, Time timeout) : TcpBridge("modbus-tcp", address), gateway_(timeout) {}

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
    gateway_.take(client, bytes);
  }
  void gone(Client client) override { gateway_.forget(client); }
  std::string error(Client client) const override {
    const std::string error = gateway_.error(client);
    return error.empty() ? error : "this is no Modbus TCP: " + error;
  }
  bool wants_more(Client client) const override { return gateway_.wants_more(client); }
  bool expects_answer(Client client) const override { return gateway_.open(client) != 0; }
  bool partial(Client client) const override { return gateway_.partial(client); }

  std::string more_summary() const override {
    const auto& counts = gateway_.counts();
    return fmt::format(
        "; {} requests, {} answered, {} broadcast, {} without answer, {} with a damaged one, {} to no station",
        counts.requests, counts.answers, counts.broadcasts, counts.silent, counts.damaged, counts.no_path);
  }
  nlohmann::ordered_json more_json() const override {
    const auto& counts = gateway_.counts();
    return {{"requests", counts.requests}, {"answered", counts.answers}, {"broadcast", counts.broadcasts},
            {"silent", counts.silent},     {"damaged", counts.damaged},  {"no_station", counts.no_path}};
  }

  modbus::Gateway gateway_;
};

}  // namespace

std::unique_ptr<Bridge> make_tcp_bridge(const ListenAddress& address) { return std::make_unique<RawBridge>(address); }

std::unique_ptr<Bridge> make_rtu_over_tcp_bridge(const ListenAddress& address, Time timeout) {
  return std::make_unique<RtuBridge>(address, timeout);
}

std::unique_ptr<Bridge> make_modbus_tcp_bridge(const ListenAddress& address, Time timeout) {
  return std::make_unique<GatewayBridge>(address, timeout);
}

}  // namespace s7200::tools
