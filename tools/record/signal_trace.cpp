#include "tools/record/signal_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

#include "interpreter/base/text/csv.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

int bits_of_signal(const Signal& signal) {
  if (signal.kind != Signal::Kind::Memory || signal.place.width == Width::Bit) return 1;
  return 8 * static_cast<int>(bytes_of(signal.place.width));
}

bool is_real(const Signal& signal) { return signal.kind == Signal::Kind::Memory && signal.place.real; }

/// A short name of printable characters for each number, as readers expect it.
std::string code_of(std::size_t number) {
  constexpr std::size_t kFirst = '!', kCharacters = '~' - kFirst + 1;
  std::string code;
  do code += static_cast<char>(kFirst + number % kCharacters);
  while ((number /= kCharacters) > 0);
  return code;
}

/// A name without what would end it.
std::string in_one_word(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '$'; }, '_');
  return name;
}

}  // namespace

SignalTrace::SignalTrace(TraceWanted wanted) : TraceWriter(wanted.detail), wanted_(std::move(wanted)) {
  settled_.fill(kNever);
  for (const Signal& signal : wanted_.signals) {
    const bool memory = signal.kind == Signal::Kind::Memory, level = signal.kind == Signal::Kind::Level;
    if (!memory) change(0, shown_.size(), level ? 1 : 0);
    shown_.push_back({signal});
    of_memory_ |= memory;
    of_levels_ |= level;
    if (level) settled_[signal.port] = 0;
  }
  known_.resize(shown_.size());
}

void SignalTrace::record(const TraceRecord& record) {
  const bool begins = record.kind == TraceKind::ServiceBegin;
  if (begins || record.kind == TraceKind::ServiceEnd)
    for (std::size_t i = 0; i < shown_.size(); ++i)
      if (const Signal& signal = shown_[i].signal;
          signal.kind == Signal::Kind::Interrupt && signal.routine == record.routine)
        change(std::max(at_, record.at), i, begins ? 1 : 0);
  look(record.at);
}

void SignalTrace::look(Time at) {
  const State* const state = wanted_.state ? wanted_.state() : nullptr;
  at_ = std::max(at_, at);  // a record may be about something that began before an instruction that is over
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const Signal& signal = shown_[i].signal;
    if (!state || signal.kind != Signal::Kind::Memory) continue;
    const std::uint32_t bits = bits_at(*state, signal.place, 0);
    if (std::exchange(known_[i], bits) != bits) change(at_, i, bits);
  }
  if (!of_levels_) write_until(kNever);
}

/// Instants that run again, because a session has gone back, are not written again.
void SignalTrace::level(std::uint8_t port, PortLevel level, Time at, bool mark) {
  if (at < settled_[port]) return;
  for (std::size_t i = 0; i < shown_.size(); ++i)
    if (const Signal& signal = shown_[i].signal;
        signal.kind == Signal::Kind::Level && signal.port == port && signal.level == level)
      change(at, i, mark ? 1 : 0);
}

void SignalTrace::settled(std::uint8_t port, Time until) {
  if (until <= settled_[port]) return;
  settled_[port] = until;
  write_until(std::ranges::min(settled_));
}

Time SignalTrace::levels_until() const { return of_levels_ ? std::ranges::min(settled_) : 0; }

/// Writes the changes before `end`, those of an instant together.
void SignalTrace::write_until(Time end) {
  if (waiting_.empty()) return;
  std::ranges::stable_sort(waiting_, {}, &Change::at);
  const auto rest = std::ranges::lower_bound(waiting_, end, {}, &Change::at);
  for (auto next = waiting_.begin(); next != rest;) {
    const Time at = next->at;
    for (; next != rest && next->at == at; ++next) {
      Shown& one = shown_[next->signal];
      one.changed |= one.bits != next->bits;
      one.bits = next->bits;
    }
    if (std::ranges::none_of(shown_, &Shown::changed)) continue;
    write(at);
    for (Shown& one : shown_) one.changed = false;
  }
  waiting_.erase(waiting_.begin(), rest);
}

double SignalTrace::number_of(const Shown& one) const {
  const std::uint32_t bits = one.bits.value_or(0);
  if (is_real(one.signal)) return std::bit_cast<float>(bits);
  switch (bits_of_signal(one.signal)) {
    case 16:
      return static_cast<std::int16_t>(bits);
    case 32:
      return static_cast<std::int32_t>(bits);
    default:
      return bits;
  }
}

VcdTrace::VcdTrace(TraceWanted given) : SignalTrace(std::move(given)) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "$timescale 1 ns $end\n$scope module PLC $end\n");
  for (std::size_t i = 0; i < shown().size(); ++i) {
    const Signal& signal = shown()[i].signal;
    fmt::format_to(out, "$var {} {} {} {} $end\n", is_real(signal) ? "real" : "wire",
                   is_real(signal) ? 64 : bits_of_signal(signal), code_of(i), in_one_word(signal.name));
  }
  fmt::format_to(out, "$upscope $end\n$enddefinitions $end\n");
  put(0, fmt::to_string(text));
}

void VcdTrace::write(Time at) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  if (at != std::exchange(told_, at)) fmt::format_to(out, "#{}\n", at);
  for (std::size_t i = 0; i < shown().size(); ++i) {
    const Shown& one = shown()[i];
    if (!one.changed) continue;
    if (is_real(one.signal))
      fmt::format_to(out, "r{} {}\n", number_of(one), code_of(i));
    else if (bits_of_signal(one.signal) == 1)
      fmt::format_to(out, "{}{}\n", *one.bits, code_of(i));
    else
      fmt::format_to(out, "b{:b} {}\n", *one.bits, code_of(i));
  }
  put(at, fmt::to_string(text));
}

void VcdTrace::finish() {
  SignalTrace::finish();
  if (const Time end = levels_until(); end > told_) put(end, fmt::format("#{}\n", end));
}

CsvTrace::CsvTrace(TraceWanted given) : SignalTrace(std::move(given)) {
  std::string heading;
  for (const Shown& one : shown()) heading += "," + csv_field(one.signal.name);
  put(0, heading + "\n");
}

void CsvTrace::write(Time at) {
  fmt::memory_buffer row;
  const auto out = std::back_inserter(row);
  fmt::format_to(out, "{}.{:06}", at / kMillisecond, at % kMillisecond);
  for (const Shown& one : shown()) {
    if (!one.bits)
      fmt::format_to(out, ",");
    else if (is_real(one.signal))
      fmt::format_to(out, ",{}", std::bit_cast<float>(*one.bits));
    else
      fmt::format_to(out, ",{}", static_cast<std::int64_t>(number_of(one)));
  }
  fmt::format_to(out, "\n");
  put(at, fmt::to_string(row));
}

}  // namespace s7200::tools
