#include "tools/coverage/profile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "interpreter/program/ladder/networks.hpp"

namespace s7200::tools {

std::uint64_t Durations::count() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const auto& each) { return sum + each.second; });
}

Time Durations::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), Time{0},
                         [](Time sum, const auto& each) { return sum + each.first * static_cast<Time>(each.second); });
}

Time Durations::mean() const { return counts_.empty() ? 0 : total() / static_cast<Time>(count()); }

Time Durations::within(double share) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count())));
  std::uint64_t sum = 0;
  for (const auto& [duration, times] : counts_)
    if ((sum += times) >= wanted) return duration;
  return 0;
}

namespace {

/// The least of 1, 2 or 5 times a power of ten that is no less.
Time round_up(Time time) {
  Time power = 1;
  while (power * 10 <= time) power *= 10;
  for (const Time factor : {1, 2, 5})
    if (power * factor >= time) return power * factor;
  return power * 10;
}

/// Where the bin ends that begins at a round time.
Time next_round(Time time) { return round_up(time + 1); }

}  // namespace

std::vector<Durations::Bin> Durations::histogram() const {
  constexpr Time kBins = 10, kNear = 4;
  std::vector<Bin> bins;
  const bool near = most() < kNear * least();
  const Time width = near ? round_up(std::max<Time>(1, (most() - least()) / kBins)) : 0;
  for (const auto& [duration, times] : counts_) {
    if (bins.empty() || duration >= bins.back().to) {
      Time from = near ? duration / width * width : 0, to = near ? from + width : 1;
      while (!near && to <= duration) from = std::exchange(to, next_round(to));
      bins.push_back({from, to, 0});
    }
    bins.back().count += times;
  }
  return bins;
}

std::vector<Time> Profile::by_op() const {
  std::vector<Time> all(executed.size());
  for (const auto& [stack, of_stack] : stacks)
    for (std::size_t op = 0; op < all.size(); ++op) all[op] += of_stack.ops[op];
  return all;
}

Time Profile::entries() const {
  return std::accumulate(stacks.begin(), stacks.end(), Time{0},
                         [](Time sum, const auto& each) { return sum + each.second.entry; });
}

namespace {

ProfileOrigin origin_of(const ProfileOrigin& known, ProfileOrigin run) {
  if (run.plc.empty()) run.plc = known.plc;
  return run;
}

void add_times(std::vector<Time>& to, const std::vector<Time>& from) {
  to.resize(std::max(to.size(), from.size()));
  for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
}

}  // namespace

void Profile::add(const Profile& other, const ProfileOrigin& origin) {
  total += other.total;
  system += other.system;
  for (const auto& [stack, of_stack] : other.stacks) {
    OfStack& own = stacks[stack];
    add_times(own.ops, of_stack.ops);
    own.entry += of_stack.entry;
  }
  executed.resize(other.executed.size());
  for (std::size_t op = 0; op < executed.size(); ++op) executed[op] += other.executed[op];
  scans.add(other.scans);
  for (const auto& [network, seen] : other.networks) networks[network].add(seen);
  if (other.worst_scan && (!worst_scan || other.worst_scan->length > worst_scan->length)) {
    worst_scan = other.worst_scan;
    worst_scan->in = origin_of(other.worst_scan->in, origin);
  }
  for (const auto& [event, seen] : other.events) {
    ProfiledEvent& own = events[event];
    own.routine = seen.routine;
    own.service.add(seen.service);
    own.latency.add(seen.latency);
    if (seen.worst.waited <= own.worst.waited) continue;
    own.worst = seen.worst;
    own.worst.in = origin_of(seen.worst.in, origin);
  }
}

ProfileSink::ProfileSink(std::shared_ptr<const Program> program)
    : program_(std::move(program)), flow_(control_flow(*program_)), reasons_(*program_) {
  profile_.program = program_;
  profile_.executed.resize(program_->ops.size());
  const Networks networks(*program_);
  for (std::uint32_t op = 0; op < program_->ops.size(); ++op) network_of_.push_back(networks.first_of(op));
  in_networks_.resize(program_->ops.size());
}

void ProfileSink::begin(const Cpu& cpu) {
  if (cpu_) account_until(cpu_->time());
  cpu_ = &cpu;
  last_ = cpu.time();
  executed_last_ = {};
  stopped_ = true;
  scan_.reset();
  stack_ = {0};
  here_ = nullptr;
  depth_ = 0;
  in_interrupt_ = enters_ = false;
}

Profile ProfileSink::profile() const {
  Profile profile = profile_;
  const Time rest = cpu_ ? cpu_->time() - last_ : 0;
  profile.system += rest;
  profile.total += rest;
  return profile;
}

/// Another routine goes on, or the scan is over.
void ProfileSink::leave_routine() {
  if (scan_) scan_->routines[stack_.back()] += in_routine_;
  in_routine_ = 0;
  here_ = nullptr;
}

Profile::OfStack& ProfileSink::here() {
  if (here_) return *here_;
  here_ = &profile_.stacks[stack_];
  here_->ops.resize(program_->ops.size());
  return *here_;
}

/// What passes between instructions belongs to the system, or to the entry of an interrupt routine.
void ProfileSink::account_until(Time at) {
  const Time passed = at - last_;
  last_ = at;
  if (passed == 0) return;
  profile_.total += passed;
  if (!enters_) {
    profile_.system += passed;
    return;
  }
  here().entry += passed;
  if (scan_) scan_->routines[stack_.front()] += passed;
}

void ProfileSink::end_scan(Time at) {
  leave_routine();
  if (!scan_) return;
  scan_->length = at - scan_->begin;
  profile_.scans.add(scan_->length);
  for (const std::uint32_t network : networks_of_scan_) profile_.networks[network].add(in_networks_[network]);
  if (!profile_.worst_scan || scan_->length > profile_.worst_scan->length) profile_.worst_scan = scan_;
}

void ProfileSink::begin_scan(const TraceRecord& record) {
  if (!stopped_) end_scan(record.at);
  stopped_ = cpu_->state().mode == Mode::Stop;
  if (stopped_) return scan_.reset();
  if (!scan_) scan_.emplace();
  scan_->number = record.count;
  scan_->begin = record.at;
  scan_->interrupts = 0;
  for (const std::uint32_t network : networks_of_scan_) in_networks_[network] = 0;
  networks_of_scan_.clear();
  scan_->routines.assign(flow_.routines.size(), 0);
  in_routine_ = 0;
  if (in_interrupt_) return;
  stack_ = {0};
  here_ = nullptr;
  depth_ = 0;
}

void ProfileSink::begin_service(const TraceRecord& record) {
  account_until(record.at);
  leave_routine();
  interrupted_ = std::exchange(stack_, {flow_.nodes[program_->interrupt[record.routine]].routine});
  in_interrupt_ = enters_ = true;
  depth_ = cpu_->state().call_depth;
  if (scan_) ++scan_->interrupts;
  ProfiledEvent& event = profile_.events[record.event];
  const Time waited = record.at - record.since;
  if (executed_last_.op != kNoRoutine)
    reasons_.note({.at = executed_last_.at, .end = executed_last_.end, .op = executed_last_.op});
  event.routine = record.routine;
  event.latency.add(waited);
  if (waited > event.worst.waited) event.worst = {record.at, waited, reasons_.of(record), {}};
}

void ProfileSink::record(const TraceRecord& record) {
  switch (record.kind) {
    case TraceKind::ScanBegin:
      begin_scan(record);
      break;
    case TraceKind::ServiceBegin:
      begin_service(record);
      break;
    case TraceKind::ModeChange:
      account_until(record.at);
      executed_last_ = {};
      stopped_ = true;
      scan_.reset();
      stack_ = {0};
      here_ = nullptr;
      depth_ = 0;
      in_interrupt_ = enters_ = false;
      break;
    default:
      break;
  }
  reasons_.note(record);
}

void ProfileSink::instruction(const InstructionRecord& record) {
  account_until(record.at);
  enters_ = false;
  const Time took = record.end - record.at;
  last_ = record.end;
  profile_.total += took;
  here().ops[record.op] += took;
  if (scan_) {
    in_routine_ += took;
    const std::uint32_t network = network_of_[record.op];
    if (in_networks_[network] == 0 && took != 0) networks_of_scan_.push_back(network);
    in_networks_[network] += took;
  }
  ++profile_.executed[record.op];
  executed_last_ = {record.at, record.end, record.op};
  follow();
}

/// Calls and returns show in the depth of calls, and the end of an interrupt routine in the CPU's state.
void ProfileSink::follow() {
  const State& state = cpu_->state();
  if (in_interrupt_ && !state.in_interrupt) {
    profile_.events[state.serving_event].service.add(last_ - state.serving_since);
    leave_routine();
    stack_ = interrupted_;
    in_interrupt_ = false;
  } else if (state.call_depth > depth_) {
    leave_routine();
    stack_.push_back(flow_.nodes[state.pc].routine);
  } else if (state.call_depth < depth_ && stack_.size() > 1) {
    leave_routine();
    stack_.pop_back();
  }
  depth_ = state.call_depth;
}

}  // namespace s7200::tools
