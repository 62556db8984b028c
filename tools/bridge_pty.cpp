#include "tools/bridge_pty.hpp"

#include <fmt/format.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cstring>
#include <deque>

#include "interpreter/stl/text.hpp"
#include "tools/pty.hpp"
#include "tools/terminal.hpp"

namespace s7200::tools {
namespace {

namespace asio = boost::asio;

class PtyBridge final : public Bridge {
 public:
  PtyBridge(const std::string& link, const LineOptions& options) : link_(link), options_(options) {}

  bool start(LiveLine& line, asio::io_context& context) override {
    line_ = &line;
    std::string why;
    pty_ = Pty::open(link_, line.format(), why);
    if (!pty_) {
      print_error(why);
      return false;
    }
    near_.emplace(context, pty_->fd());
    near_->non_blocking(true);
    watch_.emplace(context, pty_->watch());
    await_input();
    await_clients();
    fmt::print(stderr, "serving {} ({})\n", stl::printable(link_), pty_->path());
    return true;
  }

  void stop() override {
    if (near_) near_->release();  // the pty closes it
    near_.reset();
    if (watch_) watch_->release();
    watch_.reset();
    if (pty_) opened_ = pty_->opened_ever();
    pty_.reset();
  }

  SerialFormat receive_format() const override { return format_of(pty_->settings()); }

  /// As the serial drivers of Linux hand characters over (termios(3)): one with an error as it is, or with INPCK as 0, or
  /// with IGNPAR not at all. PARMRK cannot mark through a pty.
  void received(std::span<const ReceivedCharacter> characters) override {
    pty_->look();
    const PtySettings settings = pty_->settings();
    for (const ReceivedCharacter& character : characters) {
      const bool error = character.parity_error || character.framing_error;
      if (error) ++errors_;
      if (pty_->open_now() == 0 || settings.baud == 0)
        ++unheard_;
      else if (output_.size() == kMostUnread)
        ++overrun_;
      else if (!(error && settings.checks_parity && settings.ignores_errors))
        output_.push_back(error && settings.checks_parity ? 0 : character.byte);
    }
    write();
  }

  void turn() override {
    pty_->look();
    if (pty_->open_now() == 0) output_.clear();
    write();
    if (!awaiting_input_ && line_->has_room()) await_input();
  }

  std::string summary() const override {
    return fmt::format("{}: opened {} times, {} bytes from it, {} to it{}{}{}", link_, opened_, in_, out_,
                       unheard_ ? fmt::format(", {} while nobody listened", unheard_) : "",
                       overrun_ ? fmt::format(", {} lost because nobody read", overrun_) : "",
                       errors_ ? fmt::format(", {} with errors", errors_) : "");
  }

  nlohmann::ordered_json json() const override {
    return {{"kind", "pty"},     {"link", link_},       {"opened", opened_},   {"bytes_in", in_},
            {"bytes_out", out_}, {"unheard", unheard_}, {"overrun", overrun_}, {"with_errors", errors_}};
  }

 private:
  static constexpr std::size_t kMostUnread = 65'536;  // besides what the pty itself holds; a real port holds less

  SerialFormat format_of(const PtySettings& settings) const {
    SerialFormat format = line_->simulation().cpu().state().port[0].format;
    if (settings.baud != 0) format.baud = settings.baud;
    if (settings.parity) format.parity = *settings.parity;
    format.stop_bits = settings.stop_bits;
    return options_.format_over(format);
  }

  void await_input() {
    awaiting_input_ = true;
    near_->async_read_some(asio::buffer(input_), [this](const boost::system::error_code& error, std::size_t count) {
      awaiting_input_ = false;
      if (error) return;  // tried again in the next turn
      line_->catch_up();
      put_on_line(std::span(input_).first(count));
      if (line_->has_room()) await_input();
    });
  }

  /// At once, so that one who comes right behind the last one finds the port as it should be.
  void await_clients() {
    watch_->async_wait(asio::posix::descriptor_base::wait_read, [this](const boost::system::error_code& error) {
      if (error) return;
      pty_->look();
      await_clients();
    });
  }

  void put_on_line(std::span<const std::uint8_t> bytes) {
    const PtySettings settings = pty_->settings();
    if (settings.baud == 0) return;
    in_ += bytes.size();
    std::vector<serial::HostCharacter> characters;
    for (const std::uint8_t byte : bytes) characters.push_back({.byte = byte, .format = format_of(settings)});
    line_->send(characters);
  }

  /// What the far side does not take now stays for the next turn.
  void write() {
    while (!output_.empty()) {
      boost::system::error_code error;
      const std::size_t count = near_->write_some(asio::buffer(output_), error);
      if (error || count == 0) return;
      out_ += count;
      output_.erase(output_.begin(), output_.begin() + static_cast<std::ptrdiff_t>(count));
    }
  }

  std::string link_;
  LineOptions options_;
  LiveLine* line_ = nullptr;
  std::unique_ptr<Pty> pty_;
  std::optional<asio::posix::stream_descriptor> near_, watch_;
  std::array<std::uint8_t, 1024> input_{};
  std::vector<std::uint8_t> output_;
  bool awaiting_input_ = false;
  std::uint64_t opened_ = 0, in_ = 0, out_ = 0, unheard_ = 0, overrun_ = 0, errors_ = 0;
};

}  // namespace

std::unique_ptr<Bridge> make_pty_bridge(const std::string& link, const LineOptions& line) {
  return std::make_unique<PtyBridge>(link, line);
}

}  // namespace s7200::tools
