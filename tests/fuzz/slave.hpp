// What fuzzers of a running slave share: their promises, the bytes of their input, and a slave that waits for its master.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/host/files/files.hpp"

namespace s7200 {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

/// What is beyond the end is 0.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }
  std::uint8_t byte() {
    const std::uint8_t first = empty() ? std::uint8_t{0} : bytes_[0];
    bytes_ = bytes_.subspan(empty() ? 0 : 1);
    return first;
  }
  std::uint32_t word() {
    const std::uint32_t high = byte();
    return high * 256U + byte();
  }
  Bytes bytes(std::size_t count) {
    Bytes all;
    while (count-- > 0 && !empty()) all.push_back(byte());
    return all;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

inline std::shared_ptr<const Program> program_at(const std::string& path, std::string_view cpu) {
  const auto bytes = tools::read_file(path);
  auto text = bytes ? read_source(*bytes, path) : std::nullopt;
  require(text.has_value(), "the program can be read");
  const CpuModel& model = *find_cpu(cpu);
  const auto result = check(std::move(text->parsed), model, default_times(model));
  require(result.program != nullptr, "the program has no errors");
  return result.program;
}

/// Runs until the slave waits for a request; the master then has the format of its port.
inline void get_ready(serial::Simulation& simulation) {
  simulation.power_up();
  require(simulation.run_until_ready(200 * kMillisecond, 10 * kSecond), "the slave gets ready");
  simulation.configure_master(simulation.cpu().state().port[0].format);
}

}  // namespace s7200
