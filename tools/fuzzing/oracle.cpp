#include "tools/fuzzing/oracle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/model/errors.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

using Kind = FuzzFinding::Kind;

constexpr Time kGrace = 100 * kMillisecond;  ///< after an input, before a request is expected to be answered at once

}  // namespace

Oracle::Oracle(const Inspection& inspection, const FuzzSettings& settings)
    : program_(*inspection.program), settings_(settings) {
  if (settings.writes.empty()) return;
  const Bits v = bits_of_area(*program_.model, Area::V);
  std::vector<Forbidden> allowed;
  for (const MemoryRange& range : settings.writes) allowed.push_back({range.at, range.at + range.bytes()});
  std::ranges::sort(allowed, {}, &Forbidden::from);
  auto from = static_cast<std::uint32_t>(v.first / 8);
  for (const Forbidden& range : allowed) {
    if (range.from > from) forbidden_.push_back({from, range.from});
    from = std::max(from, range.to);
  }
  const auto end = static_cast<std::uint32_t>(v.end() / 8);
  if (from < end) forbidden_.push_back({from, end});
}

void Oracle::watch_rules(TrialBench& bench) {
  if (settings_.never.empty()) return;
  bench.at_scan_end([this](const Cpu& cpu) {
    for (std::size_t rule = 0; rule < settings_.never.size(); ++rule) {
      const auto value = settings_.never[rule].value(cpu);
      if (!value || !value->truth()) continue;
      broken_ = rule;
      return false;
    }
    return true;
  });
}

std::vector<FuzzFinding> Oracle::look(const TrialBench& bench, const State& before) const {
  std::vector<FuzzFinding> findings;
  const State& now = bench.cpu().state();
  const bool restarted = bench.powered_up_at() >= before.time;  // which forgets all errors
  if (now.mode == Mode::Stop && !now.stopped_by_master) {
    FuzzFinding finding{.kind = now.fatal_code != 0 ? Kind::Fatal : Kind::Stop, .code = now.fatal_code};
    if (now.fatal_code != 0 && now.fatal_op != kNoRoutine) finding.op = now.fatal_op;
    finding.what = now.fatal_code != 0
                       ? fmt::format("STOP, fatal error {:04X}: {}", now.fatal_code, meaning_of(FatalError{now.fatal_code}))
                       : "the program goes to STOP";
    findings.push_back(std::move(finding));
  }
  for (const RuntimeError& error : now.errors) {
    if (error.count == 0 || (!restarted && now.error_count == before.error_count)) continue;
    const auto had = !restarted && std::ranges::any_of(before.errors, [&](const RuntimeError& old) {
      return old.count == error.count && old.code == error.code && old.op == error.op;
    });
    if (had) continue;
    FuzzFinding finding{.kind = Kind::Error, .code = error.code};
    if (error.op != kNoRoutine) finding.op = error.op;
    finding.what = fmt::format("run-time error {:04X}: {}", error.code, meaning_of(RunError{error.code}));
    findings.push_back(std::move(finding));
  }
  for (const Forbidden& range : forbidden_) {
    const auto same =
        std::mismatch(now.image.begin() + range.from, now.image.begin() + range.to, before.image.begin() + range.from);
    if (same.first == now.image.begin() + range.to) continue;
    FuzzFinding finding{.kind = Kind::Write, .place = static_cast<std::uint32_t>(same.first - now.image.begin())};
    finding.what = fmt::format("{} is written, which --writes does not allow", memory_text({finding.place * 8u, 8}));
    findings.push_back(std::move(finding));
  }
  if (const auto broken = std::exchange(broken_, std::nullopt)) {
    FuzzFinding finding{.kind = Kind::Rule, .rule = *broken};
    finding.what = fmt::format("the rule is broken: never {}", settings_.never[*broken].text());
    findings.push_back(std::move(finding));
  }
  return findings;
}

bool Oracle::is_silent(TrialBench& bench, const std::vector<std::uint8_t>& request) const {
  const auto silent_after = [&](Time wait) {
    const std::size_t before = bench.done().sent.size();
    bench.run_until(bench.time() + wait);
    const std::size_t unasked = bench.done().sent.size();
    bench.apply({.what = Stimulus::What::Frame, .bytes = request}, bench.time());
    const bool rule_broken = std::exchange(broken_, std::nullopt).has_value();  // then the run has ended there
    return bench.done().sent.size() == unasked && unasked == before && !bench.stopped() && !rule_broken;
  };
  if (!silent_after(kGrace) || !silent_after(settings_.answers_within)) return false;
  bench.run_until(bench.time() + settings_.answers_within);
  return silent_after(0);
}

std::string Oracle::end_of_scenario(const FuzzFinding& finding, const TrialBench& bench, const State& first) const {
  const std::string wait = fmt::format("  - wait: until {}\n", exact(bench.time() - bench.powered_up_at() + kMillisecond));
  switch (finding.kind) {
    case Kind::Fatal:
      return wait + "  - fatal: none\n";
    case Kind::Stop:
      return wait + "  - mode: run\n";
    case Kind::Error:
      return wait + "  - errors: none\n";
    case Kind::Write:
      return wait +
             fmt::format("  - memory: {{{}: {}}}\n", memory_text({finding.place * 8u, 8}), first.image[finding.place]);
    case Kind::Unanswered:
      return fmt::format("  - wait: {}\n  - send: {:02x}\n    timeout: {}\n    expect: any\n",
                         exact(settings_.answers_within), fmt::join(finding.request, " "), exact(settings_.answers_within));
    case Kind::Rule:
      return rule_check(finding, bench, first);
  }
  return {};
}

/// Of the addresses in a rule one whose other value would keep it; nothing if there is none.
std::string Oracle::rule_check(const FuzzFinding& finding, const TrialBench& bench, const State& first) const {
  EventQueue queue;
  for (const Place& place : settings_.never[finding.rule].places()) {
    if (place.pointer || place.range.count != 1) continue;
    TrialBench changed(bench.shared_program(), 0);
    changed.restore(bench.snapshot());
    std::uint32_t value = 0;
    const std::uint32_t at = place.range.at, bytes = bytes_of(place.range.width);
    for (std::uint32_t i = 0; i < bytes; ++i) value = value << 8 | first.image[at + i];
    std::vector<std::uint8_t> image(bytes);
    if (place.range.width == Width::Bit) {
      value = (bench.cpu().state().image[at] >> place.range.bit & 1) ^ 1;
      image[0] = static_cast<std::uint8_t>(bench.cpu().state().image[at] ^ (1u << place.range.bit));
    } else {
      std::copy_n(first.image.begin() + at, bytes, image.begin());
    }
    changed.poke(at, image);
    const auto holds = settings_.never[finding.rule].value(changed.cpu());
    if (holds && !holds->truth())
      return fmt::format("  - wait: until {}\n  - memory: {{{}: {}}}\n", exact(bench.time() - bench.powered_up_at()),
                         place.range.name_of(0), value);
  }
  return {};
}

}  // namespace s7200::tools
