#include "tools/bridge/pty_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <deque>
#include <optional>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/host/posix/pty.hpp"

namespace s7200::tools {
namespace {

namespace asio = boost::asio;

class PtyBridge final : public Bridge {
 public:
  PtyBridge(const std::string& link, const serial::LineSettings& options) : link_(link), options_(options) {}

  Result<> start(LiveLine& line, asio::io_context& context) override {
    line_ = &line;
    context_ = &context;
    auto pty = Pty::open(link_, line.format());
    if (!pty) return pty.trouble();
    pty_ = *std::move(pty);
    speaker_ = &pty_->latest();
    look();
    line.messages().serving(fmt::format("serving {}", link_));
    return {};
  }

  void stop() override {
    for (Far& far : fars_) far.near.release();  // the pty closes it
    fars_.clear();
    pty_.reset();
  }

  SerialFormat receive_format() const override { return format_of(speaker_->settings()); }

  /// Passes characters on as the serial drivers of Linux do (termios(3)): one with an error as it is, or with INPCK as 0, or
  /// with IGNPAR not at all. PARMRK cannot mark through a pty.
  void received(std::span<const ReceivedCharacter> characters) override {
    look();
    bool heard = false;
    // Whoever listens is known before anyone is told: one that has its answer may leave at once, and another may come.
    for (Far& far : fars_) heard |= take(far, characters);
    for (Far& far : fars_) write(far);
    if (!heard) unheard_ += characters.size();
    errors_ += static_cast<std::uint64_t>(std::ranges::count_if(
        characters, [](const ReceivedCharacter& character) { return character.parity_error || character.framing_error; }));
  }

  void turn() override {
    look();
    for (Far& far : fars_) {
      follow(far);
      write(far);
      await_input(far);
    }
  }

  std::string summary() const override {
    return fmt::format("{}: opened {}, {} bytes from it, {} to it{}{}{}{}", link_, counted(opened_, "time"), in_, out_,
                       unheard_ ? fmt::format(", {} while no program listened", unheard_) : "",
                       overrun_ ? fmt::format(", {} lost because no program read them", overrun_) : "",
                       errors_ ? fmt::format(", {} with errors", errors_) : "",
                       dropped_ ? fmt::format(", {} dropped that programs left", dropped_) : "");
  }

  nlohmann::ordered_json json() const override {
    return {{"kind", "pty"},       {"link", link_},          {"opened", opened_},
            {"bytes_in", in_},     {"bytes_out", out_},      {"unheard", unheard_},
            {"overrun", overrun_}, {"with_errors", errors_}, {"bytes_dropped", dropped_}};
  }

 private:
  static constexpr std::size_t kMostUnread = 65'536;  // besides what the pty itself holds; a real port holds less

  /// The longest time for which a program's bytes are still sent after it has left; a real port (closing_wait, setserial(8))
  /// lets the program wait for 30 s and drops the rest too.
  static constexpr Time kLinger = 10 * kSecond;

  /// A port of the pty, and the program that has it open.
  struct Far {
    Far(asio::io_context& context, const Pty::Port& of) : port(of), near(context, of.fd()) { near.non_blocking(true); }

    const Pty::Port& port;
    asio::posix::stream_descriptor near;
    std::array<std::uint8_t, 1024> input{};
    std::vector<std::uint8_t> output;
    std::uint64_t reader = 0;  // whose output that is
    bool awaiting_input = false;
    std::uint64_t session = 0;       // whose characters are on the line
    std::optional<Time> left_since;  // with something left to send
    bool given_up = false;           // that is dropped by now
  };

  SerialFormat format_of(const PtySettings& settings) const {
    SerialFormat format = line_->program_format();
    if (settings.baud != 0) format.baud = settings.baud;
    if (settings.parity) format.parity = *settings.parity;
    format.stop_bits = settings.stop_bits;
    return options_.over(format);
  }

  void look() {
    pty_->look();
    const std::uint64_t opened = pty_->opened_ever();
    if (std::exchange(opened_, opened) != opened) speaker_ = &pty_->latest();
    while (fars_.size() < pty_->port_count()) await_input(fars_.emplace_back(*context_, pty_->port(fars_.size())));
  }

  /// Makes the characters ready for a program that has the port open. Returns false if there is none.
  bool take(Far& far, std::span<const ReceivedCharacter> characters) {
    const PtySettings settings = far.port.settings();
    if (far.port.open_now() == 0 || settings.baud == 0) return false;
    if (const std::uint64_t session = far.port.session(); far.reader != session) {
      far.output.clear();
      far.reader = session;
    }
    for (const ReceivedCharacter& character : characters) {
      const bool error = character.parity_error || character.framing_error;
      if (far.output.size() == kMostUnread)
        ++overrun_;
      else if (!(error && settings.checks_parity && settings.ignores_errors))
        far.output.push_back(error && settings.checks_parity ? 0 : character.byte);
    }
    return true;
  }

  /// Sends the rest of a program's bytes after it has left.
  void follow(Far& far) {
    const bool left = far.port.open_now() == 0;
    if (left) far.output.clear();
    if (!left || (far.port.unread() == 0 && line_->waiting(far.session) == 0)) {
      far.left_since.reset();
      far.given_up = false;
      return;
    }
    if (!far.left_since) far.left_since = line_->now();
    if (line_->now() - *far.left_since < kLinger) return;
    far.given_up = true;
    dropped_ += line_->drop(far.session);
  }

  void await_input(Far& far) {
    if (far.awaiting_input || !(far.given_up || line_->has_room(far.session))) return;
    far.awaiting_input = true;
    far.near.async_read_some(asio::buffer(far.input),
                             [this, &far](const boost::system::error_code& error, std::size_t count) {
                               if (error == asio::error::operation_aborted) return;
                               far.awaiting_input = false;
                               if (error) return;  // tried again in the next turn
                               line_->catch_up();
                               if (far.given_up)
                                 dropped_ += count;
                               else
                                 put_on_line(far, std::span(far.input).first(count));
                               await_input(far);
                             });
  }

  void put_on_line(Far& far, std::span<const std::uint8_t> bytes) {
    const PtySettings settings = far.port.settings();
    if (settings.baud == 0) return;
    look();
    far.session = far.port.session();
    speaker_ = &far.port;
    in_ += bytes.size();
    std::vector<serial::HostCharacter> characters;
    for (const std::uint8_t byte : bytes)
      characters.push_back({.byte = byte, .format = format_of(settings), .sender = far.session});
    line_->send(characters);
  }

  /// Writes to the far side. Bytes that it does not take now stay for the next turn.
  void write(Far& far) {
    if (far.reader != far.port.session()) far.output.clear();
    while (!far.output.empty()) {
      boost::system::error_code error;
      const std::size_t count = far.near.write_some(asio::buffer(far.output), error);
      if (error || count == 0) return;
      out_ += count;
      far.output.erase(far.output.begin(), far.output.begin() + static_cast<std::ptrdiff_t>(count));
    }
  }

  std::string link_;
  serial::LineSettings options_;
  LiveLine* line_ = nullptr;
  asio::io_context* context_ = nullptr;
  std::unique_ptr<Pty> pty_;
  const Pty::Port* speaker_ = nullptr;  // in whose format the line is heard: who wrote last, or has come since
  std::deque<Far> fars_;                // in the order of the ports
  std::uint64_t opened_ = 0, in_ = 0, out_ = 0, unheard_ = 0, overrun_ = 0, errors_ = 0, dropped_ = 0;
};

}  // namespace

std::unique_ptr<Bridge> make_pty_bridge(const std::string& link, const serial::LineSettings& line) {
  return std::make_unique<PtyBridge>(link, line);
}

}  // namespace s7200::tools
