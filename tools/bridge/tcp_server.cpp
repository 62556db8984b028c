#include "tools/bridge/tcp_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/host/net/server_rules.hpp"
#include "tools/host/net/sockets.hpp"

namespace s7200::tools {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Error = boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr int kMostNotes = 20;

NativeSocket native(tcp::socket& socket) { return static_cast<NativeSocket>(socket.native_handle()); }

void prepare(tcp::socket& socket) {
  Error ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  keep_alive(native(socket));
}

struct Connection {
  Connection(tcp::socket s, std::string n) : socket(std::move(s)), name(std::move(n)) {}

  tcp::socket socket;
  std::string name;
  std::array<std::uint8_t, 1024> input{};
  std::vector<std::uint8_t> unread, writing;  // by the client: what waits, and what has been given to the system
  bool reading = false, begun = false;        ///< a read is under way; something has come
  Clock::time_point heard = Clock::now(), listening_since{};  // the latter of the read that is under way
  std::optional<Clock::time_point> last_word;                 ///< when it was seen to have said that, or what makes no sense
  bool ended = false;                                         ///< nothing more is read from it
  Clock::time_point served{};                                 ///< when something went out for it last
};

/// Serves connections. Every handler holds its connection: one that is closed and forgotten here dies with its last handler.
class Server final : public TcpServer {
 public:
  Server(Protocol& protocol, asio::io_context& context, const LiveMessages& messages)
      : protocol_(protocol), messages_(messages), acceptor_(context) {}

  Result<> listen(const ListenAddress& address) {
    Error error;
    const tcp::endpoint endpoint(asio::ip::make_address(address.host, error), address.port);
    if (!error) acceptor_.open(endpoint.protocol(), error);
    if (!error) allow_next_listener(static_cast<NativeSocket>(acceptor_.native_handle()));
    if (!error) acceptor_.set_option(asio::socket_base::receive_buffer_size(kReceiveBuffer), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error) return trouble("cannot listen on {}: {}", to_text(address), socket_error_text(error.value()));
    messages_.serving(fmt::format("listening on {}", to_text({address.host, acceptor_.local_endpoint().port()})));
    accept();
    return {};
  }

  void send(Client client, std::span<const std::uint8_t> bytes) override {
    const auto found = connections_.find(client);
    if (found == connections_.end()) return;
    const auto connection = found->second;
    if (connection->unread.size() + bytes.size() > kMostUnread) return close(client, "it does not read");
    connection->unread.insert(connection->unread.end(), bytes.begin(), bytes.end());
    if (connection->writing.empty()) write(client, connection);
  }

  void send_to_all(std::span<const std::uint8_t> bytes) override {
    for (const Client client : clients()) send(client, bytes);
  }

  void turn() override {
    if (!accepting_ && Clock::now() >= accept_again_) accept();
    look_for_the_departed();
    for (const Client client : clients()) {
      const auto connection = connections_.at(client);
      const std::string error = protocol_.error(client);
      if (!error.empty()) {
        said_last_word(*connection);
        connection->ended = true;
      }
      if (connection->ended && protocol_.unsent(client)) connection->served = Clock::now();
      const bool unwritten = !connection->unread.empty() || !connection->writing.empty();
      const bool has_its_answers = connection->ended && !unwritten && !protocol_.expects_answer(client);
      if (connection->last_word && (has_its_answers || is_over(connection->served, kLinger)))
        close(client, error);
      else if (connection->reading && protocol_.partial(client) && is_over(connection->listening_since, kMostPartial))
        close(client, fmt::format("it began a message and did not go on for {} s", kMostPartial));
      else
        read(client, connection);
    }
  }

  const Counts& counts() const override { return counts_; }

 private:
  using ConnectionPtr = std::shared_ptr<Connection>;

  /// A copy, because whatever is done to one may end it.
  std::vector<Client> clients() const {
    std::vector<Client> all;
    all.reserve(connections_.size());
    for (const auto& entry : connections_) all.push_back(entry.first);
    return all;
  }

  void accept() {
    accepting_ = true;
    acceptor_.async_accept([this](const Error& error, tcp::socket socket) {
      accepting_ = false;
      if (error == asio::error::operation_aborted) return;
      if (error) {  // no descriptors left, say: a moment later there may be some
        note(fmt::format("cannot accept a client: {}", socket_error_text(error.value())));
        accept_again_ = Clock::now() + std::chrono::milliseconds(100);
        return;
      }
      greet(std::move(socket));
      accept();
    });
  }

  void greet(tcp::socket socket) {
    Error error;
    const tcp::endpoint from = socket.remote_endpoint(error);
    if (error) return;  // it has already gone
    if (connections_.size() == kMostClients) {
      const auto silent_longest =
          std::min_element(connections_.begin(), connections_.end(),
                           [](const auto& a, const auto& b) { return a.second->heard < b.second->heard; });
      ++counts_.refused;
      close(silent_longest->first, fmt::format("there are {} clients, and it was silent longest", kMostClients));
    }
    socket.non_blocking(true, error);
    prepare(socket);
    const auto connection =
        std::make_shared<Connection>(std::move(socket), to_text({from.address().to_string(), from.port()}));
    const Client client = ++counts_.clients;
    connections_.emplace(client, connection);
    protocol_.came(client);
    read(client, connection);
  }

  static bool is_over(Clock::time_point since, int seconds) { return Clock::now() - since > std::chrono::seconds(seconds); }

  bool is_open(Client client) const { return connections_.count(client) != 0; }

  static void said_last_word(Connection& connection) {
    if (connection.last_word) return;
    connection.last_word = connection.served = Clock::now();
  }

  /// While a client is read from, its end is seen there.
  void look_for_the_departed() {
    const bool look_closer = is_over(looked_closer_, 1);
    if (look_closer) looked_closer_ = Clock::now();
    for (const Client client : clients()) {
      const auto connection = connections_.at(client);
      if (connection->reading || connection->ended) continue;
      const NativeSocket socket = native(connection->socket);
      const Peer peer = look_at_peer(socket);
      if (peer == Peer::Gone)
        close(client, "");
      else if (const auto left = look_closer ? left_behind(socket) : std::nullopt)
        close(client, "", *left);
      else if (peer == Peer::SaidLastWord)
        said_last_word(*connection);
    }
  }

  void read(Client client, const ConnectionPtr& connection) {
    const bool lets_us_wait = connection->unread.size() > kMostUnread / 2;
    if (connection->reading || connection->ended || lets_us_wait || !protocol_.wants_more(client)) return;
    connection->reading = true;
    connection->listening_since = Clock::now();
    connection->socket.async_read_some(asio::buffer(connection->input),
                                       [this, client, connection](const Error& error, std::size_t count) {
                                         if (error == asio::error::operation_aborted) return;
                                         connection->reading = false;
                                         if (is_open(client)) take(client, connection, error, count);
                                       });
  }

  void take(Client client, const ConnectionPtr& connection, const Error& error, std::size_t count) {
    if (error && error != asio::error::eof) return close(client, "");
    connection->heard = Clock::now();
    if (error) {
      said_last_word(*connection);
      connection->ended = true;
    }
    counts_.bytes_in += count;
    if (count == 0) return;
    const std::string_view come(reinterpret_cast<const char*>(connection->input.data()), count);
    if (!std::exchange(connection->begun, true) && is_web_request(come)) return close(client, std::string(kWebRequest));
    protocol_.take(client, std::span(connection->input).first(count));
    if (is_open(client)) read(client, connection);
  }

  void write(Client client, const ConnectionPtr& connection) {
    connection->writing.swap(connection->unread);
    asio::async_write(connection->socket, asio::buffer(connection->writing),
                      [this, client, connection](const Error& error, std::size_t count) {
                        if (error == asio::error::operation_aborted) return;
                        connection->writing.clear();
                        connection->served = Clock::now();
                        counts_.bytes_out += count;
                        if (!is_open(client)) return;
                        if (error) return close(client, "");
                        if (!connection->unread.empty()) write(client, connection);
                      });
  }

  /// Closes a connection. `why` is told if the client is to blame, or the server. `unsent`: bytes that its system has not
  /// even sent yet.
  void close(Client client, const std::string& why, std::size_t unsent = 0) {
    const auto connection = connections_.extract(client).mapped();
    if (!why.empty()) note(fmt::format("client {} was disconnected: {}", connection->name, why));
    Error ignored;
    const std::size_t unread = connection->reading ? 0 : connection->socket.available(ignored);
    const std::size_t dropped = unread + unsent + protocol_.gone(client);
    counts_.dropped += dropped;
    if (dropped != 0)
      note(fmt::format("{} bytes that client {} sent before it left are dropped", dropped, connection->name));
    connection->socket.close(ignored);
  }

  void note(const std::string& text) {
    if (notes_++ < kMostNotes) messages_.note(text);
    if (notes_ == kMostNotes) messages_.note("no more notes about clients from here on");
  }

  Protocol& protocol_;
  const LiveMessages& messages_;
  tcp::acceptor acceptor_;
  std::map<Client, ConnectionPtr> connections_;
  bool accepting_ = false;
  Clock::time_point looked_closer_{};
  Clock::time_point accept_again_{};
  int notes_ = 0;
  Counts counts_;
};

}  // namespace

Result<std::unique_ptr<TcpServer>> TcpServer::open(const ListenAddress& address, Protocol& protocol,
                                                   asio::io_context& context, const LiveMessages& messages) {
  auto server = std::make_unique<Server>(protocol, context, messages);
  if (const auto done = server->listen(address); !done) return done.trouble();
  return server;
}

}  // namespace s7200::tools
