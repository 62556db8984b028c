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
  for (const Signal& signal : wanted_.signals) {
    const bool memory = signal.kind == Signal::Kind::Memory;
    shown_.push_back({signal, memory ? std::nullopt : std::optional(0U), !memory});
    of_memory_ |= memory;
  }
}

void SignalTrace::record(const TraceRecord& record) {
  const bool begins = record.kind == TraceKind::ServiceBegin;
  if (begins || record.kind == TraceKind::ServiceEnd)
    for (Shown& one : shown_)
      if (one.signal.kind == Signal::Kind::Interrupt && one.signal.routine == record.routine) {
        one.bits = begins ? 1 : 0;
        one.changed = true;
      }
  look(record.at);
}

void SignalTrace::look(Time at) {
  const State* const state = wanted_.state ? wanted_.state() : nullptr;
  at_ = std::max(at_, at);  // a record may be about something that began before an instruction that is over
  for (Shown& one : shown_) {
    if (!state || one.signal.kind != Signal::Kind::Memory) continue;
    const std::uint32_t bits = bits_at(*state, one.signal.place, 0);
    one.changed |= one.bits != bits;
    one.bits = bits;
  }
  if (std::ranges::none_of(shown_, &Shown::changed)) return;
  write(at_);
  for (Shown& one : shown_) one.changed = false;
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
