#include "tools/host/net/web_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Request = http::request<http::empty_body>;
using Answer = http::response<http::span_body<const char>>;
using Text = std::shared_ptr<const std::string>;

constexpr std::size_t kMostHeader = 8 << 10;
constexpr auto kTick = std::chrono::milliseconds(100), kFarewell = std::chrono::milliseconds(1000);

/// Only what comes from the same address, and nothing in the page itself: a name in a file that looks like markup can do
/// nothing. The worker compiles WebAssembly.
constexpr std::string_view kPolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' data: blob:; connect-src "
    "'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The hosts under which a browser of this computer knows it.
std::array<std::string, 2> hosts_of(const ListenAddress& address) {
  return {to_text(address), fmt::format("localhost:{}", address.port)};
}

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

/// What the server's thread works on; connections keep it alive.
class WebServer::Served : public std::enable_shared_from_this<Served> {
 public:
  Served(std::unique_ptr<TcpListener> listener, std::string token, std::vector<WebFile> files, Calls calls)
      : listener_(std::move(listener)),
        token_(std::move(token)),
        files_(std::move(files)),
        calls_(std::move(calls)),
        hosts_(hosts_of(listener_->address())) {}

  void start() {
    const bool six = listener_->address().host.find(':') != std::string::npos;
    acceptor_.assign(six ? tcp::v6() : tcp::v4(), static_cast<asio::detail::socket_type>(listener_->release()));
    accept();
    tick();
    thread_ = std::thread([this] { io_.run(); });
  }

  /// What waits for clients is still sent to those that read, and each is told that it is over.
  void stop() {
    asio::post(io_, [this] {
      acceptor_.close();
      end_when_all_have_heard(std::chrono::steady_clock::now() + kFarewell);
    });
    thread_.join();
    sockets_.clear();
  }

  std::string address() const { return fmt::format("http://{}/{}/", hosts_.front(), token_); }

  void send(std::optional<Client> client, std::string message);

 private:
  class Connection;
  class Socket;

  void tick() {
    timer_.expires_after(kTick);
    timer_.async_wait([this](const beast::error_code& error) {
      if (error) return;
      calls_.now_and_then();
      tick();
    });
  }

  void accept();
  void end_when_all_have_heard(std::chrono::steady_clock::time_point latest);

  void say(std::string_view why) const { calls_.said(fmt::format("a client was disconnected: {}", why)); }

  /// Why a request is not answered as it wants; empty if it may be.
  std::string why_not(const Request& request) const {
    const std::string_view host = view_of(request[http::field::host]), origin = view_of(request[http::field::origin]);
    if (std::ranges::find(hosts_, host) == hosts_.end())
      return fmt::format("it asked for the host '{}', and this is {}", stl::shortened(host), hosts_.front());
    const auto is_origin = [&](const std::string& own) { return origin == "http://" + own; };
    if (request.count(http::field::origin) != 0 && std::ranges::none_of(hosts_, is_origin))
      return fmt::format("a page from '{}' has sent it", stl::shortened(origin));
    return {};
  }

  /// What is wanted under the token; nothing if that is not there or wrong.
  std::optional<std::string_view> name_in(beast::string_view target) const {
    const std::string_view path = view_of(target).substr(0, view_of(target).find_first_of("?#"));
    const std::size_t end = path.find('/', 1);
    if (path.empty() || path[0] != '/' || end == std::string_view::npos) return {};
    if (!is_same_token(path.substr(1, end - 1), token_)) return {};
    return path.substr(end + 1);
  }

  const WebFile* file(std::string_view name) const {
    const auto found = std::ranges::find(files_, name, &WebFile::name);
    return found == files_.end() ? nullptr : &*found;
  }

  std::unique_ptr<TcpListener> listener_;
  std::string token_;
  std::vector<WebFile> files_;
  Calls calls_;
  std::array<std::string, 2> hosts_;
  std::size_t connections_ = 0;
  Client last_ = 0;
  asio::io_context io_{1};  // what waits in it looks at what stands above
  tcp::acceptor acceptor_{io_};
  asio::steady_timer timer_{io_};
  std::map<Client, std::shared_ptr<Socket>> sockets_{};
  std::thread thread_{};
};

/// A WebSocket. It lives as long as something is under way on it.
class WebServer::Served::Socket : public std::enable_shared_from_this<Socket> {
 public:
  Socket(Served& served, tcp::socket&& socket, Client number)
      : served_(served), stream_(std::move(socket)), number_(number) {}
  ~Socket() { --served_.connections_; }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void open(const Request& request) {
    stream_.set_option(websocket::stream_base::timeout{kMostSilence, 2 * kMostSilence, true});
    stream_.read_message_max(kMostMessage);
    stream_.text(true);
    stream_.async_accept(request, [self = shared_from_this()](const beast::error_code& error) {
      if (error) return;
      self->served_.sockets_[self->number_] = self;
      self->served_.calls_.joined(self->number_);
      self->read();
    });
  }

  void send(const Text& text) {
    if (gone_) return;
    waiting_bytes_ += text->size();
    if (waiting_bytes_ > kMostUnread) return end("it does not read what it is sent");
    waiting_.push_back(text);
    if (waiting_.size() == 1) write();
  }

  /// Once all is sent. A socket that is closed with unread messages in it takes back what its client has not read yet, so
  /// they are read until the client closes, too.
  void close_when_all_is_sent() {
    if (waiting_.empty() && !std::exchange(closing_, true))
      stream_.async_close(websocket::close_code::going_away, [self = shared_from_this()](const beast::error_code&) {});
  }

 private:
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](const beast::error_code& error, std::size_t) {
      if (error) return self->read_failed(error);
      std::string message = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      const std::string why = self->stream_.got_text() ? self->served_.calls_.came(self->number_, std::move(message))
                                                       : "its message is not text";
      if (!why.empty()) return self->end(why);
      self->read();
    });
  }

  void read_failed(const beast::error_code& error) {
    if (error == websocket::error::message_too_big || error == websocket::error::buffer_overflow)
      return end(fmt::format("its message has more than {} bytes", kMostMessage));
    if (error == beast::error::timeout) return end(fmt::format("it was silent for {} s", 2 * kMostSilence.count()));
    end("");
  }

  void write() {
    stream_.async_write(asio::buffer(*waiting_.front()),
                        [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                          if (error) return self->end("");
                          self->waiting_bytes_ -= self->waiting_.front()->size();
                          self->waiting_.pop_front();
                          if (!self->waiting_.empty()) self->write();
                        });
  }

  /// At once: one that does not read would not read a farewell.
  void end(std::string_view why) {
    if (std::exchange(gone_, true)) return;
    if (!why.empty()) served_.say(why);
    if (served_.sockets_.erase(number_) != 0) served_.calls_.left(number_);
    beast::get_lowest_layer(stream_).close();
  }

  Served& served_;
  websocket::stream<beast::tcp_stream> stream_;
  Client number_;
  beast::flat_buffer buffer_{};
  std::deque<Text> waiting_{};
  std::size_t waiting_bytes_ = 0;
  bool gone_ = false, closing_ = false;
};

/// One request, and its answer.
class WebServer::Served::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Served& served, tcp::socket&& socket) : served_(served), stream_(std::move(socket)) {
    parser_.header_limit(kMostHeader);
    parser_.body_limit(0);
  }
  ~Connection() {
    if (!upgraded_) --served_.connections_;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start() {
    stream_.expires_after(kMostSilence);
    http::async_read_header(
        stream_, buffer_, parser_, [self = shared_from_this()](const beast::error_code& error, std::size_t) {
          if (error == http::error::end_of_stream) return;
          if (error == beast::error::timeout) return self->served_.say("it was silent before its request was there");
          if (error) return self->served_.say(fmt::format("it did not begin with a request of HTTP: {}", error.message()));
          self->handle();
        });
  }

 private:
  void handle() {
    const Request& request = parser_.get();
    if (const std::string why = served_.why_not(request); !why.empty()) return refuse(http::status::forbidden, why);
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return refuse(http::status::method_not_allowed, "its method is not GET");
    const auto name = served_.name_in(request.target());
    if (!name) return refuse_without_token(view_of(request.target()));
    if (*name == kSocket && websocket::is_upgrade(request)) return upgrade();
    const WebFile* const file = served_.file(*name);
    if (!file) return answer(http::status::not_found, "text/plain", "there is no such file here\n");
    answer(http::status::ok, file->type, file->bytes);
  }

  void upgrade() {
    stream_.expires_never();
    upgraded_ = true;
    std::make_shared<Socket>(served_, stream_.release_socket(), ++served_.last_)->open(parser_.get());
  }

  void refuse(http::status status, const std::string& why) {
    served_.say(why);
    text_ = why + '\n';
    answer(status, "text/plain; charset=utf-8", text_);
  }

  /// Browsers ask for an icon at the top by themselves.
  void refuse_without_token(std::string_view target) {
    constexpr std::string_view kWrong = "the address has no token, or a wrong one; the server prints the right address";
    if (target == "/favicon.ico") return answer(http::status::not_found, "text/plain", "");
    refuse(http::status::not_found, std::string(kWrong));
  }

  void answer(http::status status, std::string_view type, std::string_view bytes) {
    const Request& request = parser_.get();
    answer_ = Answer(status, request.version());
    const auto set = [&](auto field, std::string_view value) {
      answer_.set(field, beast::string_view(value.data(), value.size()));
    };
    set(http::field::content_type, type);
    set("Content-Security-Policy", kPolicy);
    set("X-Content-Type-Options", "nosniff");
    set("Referrer-Policy", "no-referrer");
    set("Cross-Origin-Opener-Policy", "same-origin");
    set("Cross-Origin-Resource-Policy", "same-origin");
    set(http::field::cache_control, "no-store");
    answer_.keep_alive(false);
    answer_.content_length(bytes.size());
    if (request.method() != http::verb::head) answer_.body() = {bytes.data(), bytes.size()};
    stream_.expires_after(kMostSilence);
    http::async_write(stream_, answer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
    });
  }

  Served& served_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kMostHeader};
  http::request_parser<http::empty_body> parser_{};
  Answer answer_{};
  std::string text_{};
  bool upgraded_ = false;
};

void WebServer::Served::send(std::optional<Client> client, std::string message) {
  asio::post(io_, [this, client, text = std::make_shared<const std::string>(std::move(message))] {
    if (client) {
      const auto found = sockets_.find(*client);
      if (found != sockets_.end()) found->second->send(text);
      return;
    }
    const auto all = sockets_;  // one that has to go is taken away
    for (const auto& [number, socket] : all) socket->send(text);
  });
}

void WebServer::Served::accept() {
  acceptor_.async_accept([this](const beast::error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error && connections_ < kMostConnections) {
      ++connections_;
      socket.set_option(tcp::no_delay(true));
      std::make_shared<Connection>(*this, std::move(socket))->start();
    } else if (!error) {
      say(fmt::format("there are {} connections already", kMostConnections));
    }
    accept();
  });
}

void WebServer::Served::end_when_all_have_heard(std::chrono::steady_clock::time_point latest) {
  constexpr auto kSoon = std::chrono::milliseconds(5);
  for (const auto& [number, socket] : sockets_) socket->close_when_all_is_sent();
  if (sockets_.empty() || std::chrono::steady_clock::now() > latest) return io_.stop();
  timer_.expires_after(kSoon);
  timer_.async_wait([this, latest](const beast::error_code&) { end_when_all_have_heard(latest); });
}

WebServer::WebServer(std::unique_ptr<TcpListener> listener, std::string token, std::vector<WebFile> files, Calls calls)
    : served_(std::make_shared<Served>(std::move(listener), std::move(token), std::move(files), std::move(calls))) {
  served_->start();
}

WebServer::~WebServer() { served_->stop(); }

std::string WebServer::address() const { return served_->address(); }

void WebServer::send(Client client, std::string message) { served_->send(client, std::move(message)); }

void WebServer::send_to_all(std::string message) { served_->send({}, std::move(message)); }

}  // namespace s7200::tools
