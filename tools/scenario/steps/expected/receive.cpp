#include "tools/scenario/steps/expected/receive.hpp"

#include <stdexcept>

#include "tools/scenario/reading/answer_reader.hpp"

namespace s7200::tools {

void ReceiveStep::read(const StepSource& source) {
  using Kind = Expected::Kind;
  has_crc = source.values.truth(source.beside("crc"));
  read_reception(source);
  at = source.values.window(source.beside("at"), source.scenario.tolerance);
  auto what = read_expected(source.values, source.is);
  if (!what) return;
  if (what->kind != Kind::Any && what->kind != Kind::Silence && what->kind != Kind::Frame)
    source.values.wrong(source.is, "'receive' waits for what no one asked for: any, silence, hex or {text: ...}",
                        "an answer to a request stands in 'expect:'");
  expected.push_back(std::move(*what));
}

void ReceiveStep::act(Run& run) const {
  serial::Listening listening{.timeout = timeout.value_or(run.scenario().line.timeout)};
  if (listen) listening.silence = listen->in(run.format());
  if (run.plant()) run.plant()->begin_reception();
  serial::Exchange exchange;
  try {
    exchange = run.slave().receive(listening);
  } catch (const std::invalid_argument&) {
    return run.skip_step();  // a way on which nothing comes unasked
  } catch (const SlaveLost& error) {
    return run.lose_slave(error.what());
  }
  if (!exchange.response.empty()) run.before.end = exchange.response_end;
  if (run.plant()) run.plant()->end_exchange();
  run.keep(exchange);
  const SerialFormat line = run.format();
  judge(run, exchange, line, listening.timeout);
  if (at && !run.in_simulation()) run.leave_times_unjudged();
  if (!at || !run.in_simulation() || exchange.response.empty() || at->has(exchange.response_start, line)) return;
  run.add_exchange({.what = "begin",
                    .expected = in_words(*at, line),
                    .found = format_duration(exchange.response_start, 6),
                    .exchange = exchange});
}

bool ReceiveStep::write(TranscriptWriter& writer) const {
  if (!writer.seen()) return false;
  const serial::Exchange& seen = *writer.seen();
  writer.step("receive: " + what_came({}, seen.response_bytes()));
  write_how_to_listen(writer);
  if (seen.response.empty()) return true;
  writer.last_end = seen.response_end;
  write_how_it_came(writer, seen);
  if (writer.live())
    writer.beside("latency: " + exact(*latency_of(seen)));
  else
    writer.beside("at: " + exact(seen.response_start));
  return true;
}

std::shared_ptr<const StepAction> read_receive(const StepSource& source) {
  auto step = std::make_shared<ReceiveStep>();
  step->read(source);
  return step;
}

}  // namespace s7200::tools
