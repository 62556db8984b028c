#include "tools/scenario/steps/random_traffic.hpp"

#include <fmt/format.h>

#include <random>

#include "serial_sim/modbus/request.hpp"
#include "tools/scenario/steps/exchange.hpp"

namespace s7200::tools {
namespace {

/// Requests that are mostly fine.
class TrafficMaker {
 public:
  TrafficMaker(std::uint32_t seed, std::uint8_t station) : random_(seed), station_(station) {}

  serial::Frame next() {
    const unsigned kind = below(30);
    const std::uint8_t station = kind == 0 ? 0 : kind == 1 ? static_cast<std::uint8_t>(station_ + 1) : station_;
    Bytes frame = modbus::rtu_frame(station, damaged(pdu()));
    if (kind == 2) frame[below(static_cast<unsigned>(frame.size()))] ^= static_cast<std::uint8_t>(1U << below(8));
    if (kind == 3) frame.resize(1 + below(static_cast<unsigned>(frame.size() - 1)));
    return serial::to_frame(frame);
  }

 private:
  unsigned below(unsigned limit) { return static_cast<unsigned>(random_() % limit); }
  std::uint16_t word() { return static_cast<std::uint16_t>(random_()); }

  /// Near the begin, near a limit, or anywhere.
  std::uint16_t first() {
    static constexpr unsigned kLimits[] = {16, 64, 1000, 32768, 65535};
    const unsigned kind = below(10);
    if (kind == 0) return word();
    if (kind == 1) return static_cast<std::uint16_t>(kLimits[below(5)] - 2 + below(4));
    return static_cast<std::uint16_t>(below(kind < 6 ? 16 : 64));
  }
  std::uint16_t count(unsigned limit) {
    const unsigned kind = below(12);
    if (kind == 0) return word();
    if (kind == 1) return static_cast<std::uint16_t>(limit - 1 + below(3));
    if (kind == 2) return 0;
    return static_cast<std::uint16_t>(1 + below(20));
  }

  Bytes pdu() {
    switch (below(9)) {
      case 0:
        return modbus::read_coils(first(), count(2000));
      case 1:
        return modbus::read_inputs(first(), count(2000));
      case 2:
        return modbus::read_holding_registers(first(), count(125));
      case 3:
        return modbus::read_input_registers(first(), count(125));
      case 4: {
        Bytes coil = modbus::write_coil(first(), below(2) != 0);
        if (below(8) == 0) coil[4] = static_cast<std::uint8_t>(word());
        return coil;
      }
      case 5:
        return modbus::write_register(first(), word());
      case 6: {
        std::vector<bool> coils(1 + below(32));
        for (std::size_t i = 0; i < coils.size(); ++i) coils[i] = below(2) != 0;
        return modbus::write_coils(first(), coils);
      }
      case 7: {
        std::vector<std::uint16_t> values(below(20) == 0 ? 120 + below(4) : 1 + below(12));
        for (std::uint16_t& value : values) value = word();
        return modbus::write_registers(first(), values);
      }
      default:
        return {static_cast<std::uint8_t>(below(256)), 0, 0, 0, 1};
    }
  }

  Bytes damaged(Bytes pdu) {
    const unsigned kind = below(40);
    if (kind == 0) pdu.push_back(0);
    if (kind == 1 && pdu.size() > 1) pdu.pop_back();
    if (kind == 2 && pdu.size() > 5) pdu[5] = static_cast<std::uint8_t>(word());
    return pdu;
  }

  std::mt19937 random_;
  std::uint8_t station_;
};

}  // namespace

void RandomTraffic::act(Run& run) const {
  TrafficMaker make(seed, station);
  for (std::size_t i = 0; i < exchanges && run.goes_on(); ++i) {
    run.begin_turn(i);
    ExchangeStep exchange;
    exchange.request = make.next();
    exchange.act(run);
  }
}

bool RandomTraffic::write(TranscriptWriter& writer) const { return ExchangeStep().write(writer); }

Scenario random_traffic(std::size_t exchanges, std::uint32_t seed, std::uint8_t station) {
  Scenario scenario;
  scenario.name = fmt::format("{} random requests, seed {}", exchanges, seed);
  scenario.source = std::make_shared<stl::SourceLines>(stl::SourceLines{.name = "random traffic", .text = {}});
  scenario.line.timeout = kSecond;  // through TCP the longest frames take 0.3 s each way before an answer is seen
  auto traffic = std::make_shared<RandomTraffic>();
  traffic->exchanges = exchanges;
  traffic->seed = seed;
  traffic->station = station;
  scenario.steps.push_back({.action = std::move(traffic)});
  return scenario;
}

}  // namespace s7200::tools
