// How true real time is: `bridge_bench [EXCHANGES]`, from build/release on an idle computer.
//
// A program on the far side of a pty asks our slave. What it sees, from writing its request to its first byte of the answer,
// is compared with what the simulation says: from the request's first start edge to the middle of the answer's first stop
// bit. The difference is what the computer adds; how much it varies is the jitter. A part of it is the pty's, whose bytes
// Linux passes on in a kernel thread of ordinary priority: so it is also said how late each answer was when s7200 handed it
// over.
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <thread>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/result.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tests/support/source_path.hpp"
#include "tools/bridge/live_run.hpp"
#include "tools/bridge/pty_bridge.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/interruption.hpp"

namespace {

using namespace s7200;
using Clock = std::chrono::steady_clock;

Time nanoseconds(Clock::duration duration) { return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count(); }

/// Start of the first character received, and end of the first one sent after it.
class Moments final : public TraceSink {
 public:
  void record(const TraceRecord& record) override {
    const std::lock_guard lock(mutex_);
    if (record.kind == TraceKind::CharacterReceived && asked_ == 0) asked_ = record.since;
    if (record.kind == TraceKind::CharacterSent && asked_ != 0 && answered_ == 0) answered_ = record.at;
  }
  bool wants_scans() const override { return false; }

  /// Simulated latency of the exchange that is over.
  Time take(const SerialFormat& format) {
    const std::lock_guard lock(mutex_);
    const Time latency = answered_ - format.half_bits(1) - asked_;
    asked_ = answered_ = 0;
    return latency;
  }

 private:
  std::mutex mutex_;
  Time asked_ = 0, answered_ = 0;
};

/// A bridge that notes how late the first character of each answer was handed to it.
class Timed final : public tools::Bridge {
 public:
  explicit Timed(std::unique_ptr<Bridge> bridge) : bridge_(std::move(bridge)) {}

  Result<> start(tools::LiveLine& line, boost::asio::io_context& context) override {
    const auto started = bridge_->start(line, context);
    begin_ = line.now();
    moment_ = Clock::now();
    return started;
  }
  void received(std::span<const ReceivedCharacter> characters) override {
    const Time due = characters[0].end - begin_;
    if (due - last_ > 10 * kMillisecond) late_.push_back(nanoseconds(Clock::now() - moment_) - due);
    last_ = due;
    bridge_->received(characters);
  }
  void stop() override { bridge_->stop(); }
  SerialFormat receive_format() const override { return bridge_->receive_format(); }
  void turn() override { bridge_->turn(); }
  Time due() const override { return bridge_->due(); }
  std::string failure() const override { return bridge_->failure(); }
  std::string summary() const override { return bridge_->summary(); }
  nlohmann::ordered_json json() const override { return bridge_->json(); }

  std::vector<Time> late() const { return late_; }

 private:
  std::unique_ptr<Bridge> bridge_;
  Time begin_ = 0, last_ = 0;
  Clock::time_point moment_;
  std::vector<Time> late_;
};

void print(std::string_view what, std::vector<Time> times) {
  std::sort(times.begin(), times.end());
  const auto at = [&](double part) {
    return times.empty()
               ? 0.0
               : static_cast<double>(times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))]) / 1e6;
  };
  fmt::print("{}, in ms: least {:.3f}, median {:.3f}, p99 {:.3f}, most {:.3f}; jitter (p99 over least) {:.3f}\n", what,
             at(0), at(0.5), at(0.99), at(1), at(0.99) - at(0));
}

std::size_t read_some(int fd, int timeout_ms) {
  pollfd ready{fd, POLLIN, 0};
  char bytes[64];
  if (poll(&ready, 1, timeout_ms) != 1) return 0;
  const ssize_t count = read(fd, bytes, sizeof bytes);
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) / 1e6; };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void measure(const std::string& link, int exchanges, Moments& moments) {
  const int fd = open(link.c_str(), O_RDWR | O_NOCTTY);
  if (fd < 0) std::abort();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));

  const auto begin = Clock::now();
  const double before = cpu_seconds();
  std::this_thread::sleep_for(std::chrono::seconds(5));
  fmt::print("idle: {:.2f} % of a core\n",
             100e9 * (cpu_seconds() - before) / static_cast<double>(nanoseconds(Clock::now() - begin)));

  const auto request = modbus::rtu_frame(1, modbus::read_holding_registers(0, 2));
  std::vector<Time> added;
  for (int i = 0; i < exchanges; ++i) {
    const auto written = Clock::now();
    if (write(fd, request.data(), request.size()) != static_cast<ssize_t>(request.size())) std::abort();
    std::size_t count = read_some(fd, 2000);
    const auto first = Clock::now();
    while (count < 9 && count != 0) {
      const std::size_t more = read_some(fd, 2000);
      if (more == 0) break;
      count += more;
    }
    const Time latency = moments.take(SerialFormat{});
    if (count == 9) added.push_back(nanoseconds(first - written) - latency);
    std::this_thread::sleep_for(std::chrono::microseconds(25'000 + 371 * (i % 40)));  // at any moment of the scan
  }
  close(fd);
  fmt::print("{} of {} exchanges answered\n", added.size(), exchanges);
  print("the computer adds to the simulated latency", added);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace s7200::tools;
  const int exchanges = argc > 1 ? std::atoi(argv[1]) : 1000;
  const std::string path = test::source_path("stl_programs/modbus_slave.stl");
  const auto text = tools::read_file(path);
  const CpuModel& model = *find_cpu("214");
  const auto program = check_text(*text, path, model, default_times(model)).program;
  const std::string link =
      (std::filesystem::temp_directory_path() / fmt::format("s7200_bridge_bench_{}", getpid())).string();

  serial::Simulation simulation(program);
  Moments moments;
  simulation.cpu().set_sink(&moments);
  simulation.power_up();
  catch_interruption();
  Timed bridge(make_pty_bridge(link, {}));
  std::atomic<bool> done = false;
  std::thread client([&] {
    while (!std::filesystem::exists(link) && !done) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (!done) measure(link, exchanges, moments);
    std::raise(SIGINT);
  });
  LiveRun live(simulation, {}, &bridge);
  if (const auto started = live.start(); !started) fmt::print(stderr, "{}\n", started.why());
  live.run_until(kNever);
  done = true;
  client.join();
  print("answers are handed over late by", bridge.late());
  fmt::print("drift {}, worst lag {}\n", format_duration(live.pace().drift), format_duration(live.pace().worst_lag));
  return 0;
}
