#include "tools/bridge_server.hpp"

#include <fmt/format.h>
#include <netinet/tcp.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include "tools/terminal.hpp"

namespace s7200::tools {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Error = boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr int kMostNotes = 20;

void keep_alive(tcp::socket& socket) {
  Error ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  const auto set = [&](int option, int value) {
    setsockopt(socket.native_handle(), IPPROTO_TCP, option, &value, sizeof value);
  };
  set(TCP_KEEPIDLE, 30);
  set(TCP_KEEPINTVL, 10);
  set(TCP_KEEPCNT, 3);
  set(TCP_USER_TIMEOUT, 60'000);
}

struct Connection {
  Connection(tcp::socket s, std::string n) : socket(std::move(s)), name(std::move(n)) {}

  tcp::socket socket;
  std::string name;
  std::array<std::uint8_t, 1024> input{};
  std::vector<std::uint8_t> unread, writing;  // by the client: what waits, and what has been given to the system
  bool reading = false;
  Clock::time_point heard = Clock::now(), listening_since{};  // the latter of the read that is under way
  std::optional<Clock::time_point> last_word;
};

/// Every handler holds its connection: what is closed and forgotten here dies with its last handler.
class Server final : public TcpServer {
 public:
  Server(Protocol& protocol, asio::io_context& context) : protocol_(protocol), acceptor_(context) {}

  bool listen(const ListenAddress& address) {
    Error error;
    const tcp::endpoint endpoint(asio::ip::make_address(address.host, error), address.port);
    if (!error) acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error) {
      print_error(fmt::format("cannot listen on {}: {}", to_text(address), error.message()));
      return false;
    }
    fmt::print(stderr, "listening on {}\n", to_text({address.host, acceptor_.local_endpoint().port()}));
    accept();
    return true;
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
    for (const Client client : clients()) {
      const auto connection = connections_.at(client);
      const std::string error = protocol_.error(client);
      if (!error.empty() && !connection->last_word) connection->last_word = Clock::now();
      if (connection->last_word) {
        const bool unwritten = !connection->unread.empty() || !connection->writing.empty();
        const bool served = !unwritten && !protocol_.expects_answer(client);
        if (served || is_over(*connection->last_word, kLinger)) close(client, error);
      } else if (connection->reading && protocol_.partial(client) && is_over(connection->listening_since, kMostPartial)) {
        close(client, fmt::format("it began a message and did not go on for {} s", kMostPartial));
      } else {
        read(client, connection);
      }
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
        note(fmt::format("cannot accept a client: {}", error.message()));
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
    keep_alive(socket);
    const auto connection =
        std::make_shared<Connection>(std::move(socket), to_text({from.address().to_string(), from.port()}));
    const Client client = ++counts_.clients;
    connections_.emplace(client, connection);
    read(client, connection);
  }

  static bool is_over(Clock::time_point since, int seconds) { return Clock::now() - since > std::chrono::seconds(seconds); }

  bool is_open(Client client) const { return connections_.count(client) != 0; }

  void read(Client client, const ConnectionPtr& connection) {
    const bool lets_us_wait = connection->unread.size() > kMostUnread / 2;
    if (connection->reading || connection->last_word || lets_us_wait || !protocol_.wants_more(client)) return;
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
    if (error) connection->last_word = connection->heard;
    counts_.bytes_in += count;
    if (count == 0) return;
    protocol_.take(client, std::span(connection->input).first(count));
    if (is_open(client)) read(client, connection);
  }

  void write(Client client, const ConnectionPtr& connection) {
    connection->writing.swap(connection->unread);
    asio::async_write(connection->socket, asio::buffer(connection->writing),
                      [this, client, connection](const Error& error, std::size_t count) {
                        if (error == asio::error::operation_aborted) return;
                        connection->writing.clear();
                        counts_.bytes_out += count;
                        if (!is_open(client)) return;
                        if (error) return close(client, "");
                        if (!connection->unread.empty()) write(client, connection);
                      });
  }

  /// `why` is said where the client is to blame, or we.
  void close(Client client, const std::string& why) {
    const auto found = connections_.find(client);
    if (!why.empty()) note(fmt::format("client {} was disconnected: {}", found->second->name, why));
    Error ignored;
    found->second->socket.close(ignored);
    connections_.erase(found);
    protocol_.gone(client);
  }

  void note(const std::string& text) {
    if (notes_++ < kMostNotes) fmt::print(stderr, "s7200: note: {}\n", text);
    if (notes_ == kMostNotes) fmt::print(stderr, "s7200: note: no more notes about clients from here on\n");
  }

  Protocol& protocol_;
  tcp::acceptor acceptor_;
  std::map<Client, ConnectionPtr> connections_;
  bool accepting_ = false;
  Clock::time_point accept_again_{};
  int notes_ = 0;
  Counts counts_;
};

}  // namespace

std::unique_ptr<TcpServer> TcpServer::open(const ListenAddress& address, Protocol& protocol, asio::io_context& context) {
  auto server = std::make_unique<Server>(protocol, context);
  if (!server->listen(address)) return nullptr;
  return server;
}

}  // namespace s7200::tools
