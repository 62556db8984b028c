// What the wire costs: characters and exchanges a second of the host, without a PLC.
#include <benchmark/benchmark.h>

#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/requester.hpp"

namespace s7200::serial {
namespace {

constexpr EventOwner kSlaveUart{0}, kMasterUart{1}, kMaster{2};

/// Characters without a gap, both receivers on (the sender hears itself too).
void characters(benchmark::State& bench) {
  Line line;
  EventQueue queue;
  Uart sender(line, queue, kSlaveUart, 0);
  Uart receiver(line, queue, kMasterUart, 1);
  Time at = 0;
  std::uint8_t byte = 0;
  for (auto _ : bench) {
    sender.send(byte, at);
    while (queue.next() != kNever) {
      const Event event = queue.pop();
      const Uart::Report report = (event.owner == kSlaveUart ? sender : receiver).handle(event);
      if (report.received) benchmark::DoNotOptimize(byte = static_cast<std::uint8_t>(report.received->byte + 1));
      if (report.sent) at = *report.sent;
    }
  }
  bench.SetItemsProcessed(bench.iterations());
}
BENCHMARK(characters);

/// A request of 8 characters and an answer of 25, half duplex.
void exchanges(benchmark::State& bench) {
  Line line;
  EventQueue queue;
  Uart slave(line, queue, kSlaveUart, 0);
  Uart master_uart(line, queue, kMasterUart, 1);
  Requester master(master_uart, queue, kMaster);
  const Request request{.frame = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 10)))};
  Time now = 0;
  for (auto _ : bench) {
    int heard = 0;
    std::uint8_t answered = 0;
    master.start(request, now);
    while (master.busy()) {
      const Event event = queue.pop();
      now = event.at;
      if (event.owner == kMaster) {
        master.handle(event);
      } else if (event.owner == kMasterUart) {
        master.on(master_uart.handle(event));
      } else {
        const Uart::Report report = slave.handle(event);
        const bool answer_begins = report.received && ++heard == 8;
        if (answer_begins) slave.enable_receiver(false, now + kMillisecond);
        if (answer_begins || (report.sent && answered < 25)) {
          slave.send(answered++, answer_begins ? now + kMillisecond : now);
        } else if (report.sent) {
          slave.enable_receiver(true, now);
        }
      }
    }
    if (master.exchange().response.size() != 25) bench.SkipWithError("no answer");
  }
  bench.SetItemsProcessed(bench.iterations());
}
BENCHMARK(exchanges);

}  // namespace
}  // namespace s7200::serial
