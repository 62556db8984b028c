#include "tools/session/causes/effects/run_record.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/base/text/among.hpp"
#include "interpreter/model/special_memory.hpp"
#include "tools/session/causes/effects/changed_place.hpp"
#include "tools/session/causes/effects/memory_of_levels.hpp"
#include "tools/session/causes/effects/point_samples.hpp"
#include "tools/session/past/actions/access.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint32_t kCompared = image::kConstants / 8 * 8;
constexpr std::uint64_t kEdgeEvents = 8;          // of I0.0 to I0.3
constexpr std::uint64_t kMostAtAPoint = 512 * 8;  // bits of a place that are looked at

/// Memory that says nothing of what the program does: the clock bits and scan times of the CPU, the memory of edges, and the
/// points, which follow their images.
bool is_left_out(std::uint32_t byte) {
  const bool clock = byte == image::kSM || (byte >= sm::kLastScan && byte <= sm::kLongestScan + 1);
  return clock || (byte >= image::kOutputs && byte < image::kV);
}

bool is_timer(std::uint32_t byte) {
  return (byte >= image::kT && byte < image::kC) || (byte >= image::kTBits && byte < image::kCBits);
}

std::uint32_t timer_of(std::uint64_t bit) {
  const std::uint64_t byte = bit / 8;
  return static_cast<std::uint32_t>(byte >= image::kTBits ? bit - std::uint64_t{image::kTBits} * 8 : (byte - image::kT) / 2);
}

/// A bit where programs use bits, a value of a timer or counter, or the byte.
Bits natural_place(std::uint64_t bit) {
  const auto byte = static_cast<std::uint32_t>(bit / 8);
  if (byte >= image::kT && byte < image::kHC) return {bit / 16 * 16, 16};
  const bool bits = byte < image::kSM || (byte >= image::kS && byte < image::kAI) ||
                    (byte >= image::kTBits && byte < image::kInputs) || (byte >= image::kInputs && byte < image::kOutputs);
  return bits ? Bits{bit, 1} : Bits{bit / 8 * 8, 8};
}

bool works_on_the_stack(std::string_view mnemonic) {
  constexpr std::string_view kAll[] = {"ALD", "OLD", "LPS", "LRD", "LPP", "LDS"};
  return std::ranges::find(kAll, mnemonic) != std::end(kAll);
}

/// Whether it decides where the program goes on.
bool decides(const Instruction& instruction) {
  switch (instruction.structure) {
    case Structure::Jump:
    case Structure::Call:
    case Structure::For:
    case Structure::SegmentBegin:
    case Structure::SegmentExit:
      return true;
    default:
      return instruction.effect == Effect::ConditionalEnd;
  }
}

/// What an instruction leaves in special memory of its result is not what it works with.
bool is_status(const MemoryAccess& access) {
  return access.operand == kNoOperand && access.writes() && access.bits.first / 8 >= image::kSM &&
         access.bits.end() <= std::uint64_t{image::kS} * 8;
}

/// All that an instruction would read now: entries of tables, strings and messages too.
std::vector<Bits> reads_now(const Cpu& cpu, std::uint32_t op) {
  std::vector<Bits> reads = accessed(cpu, op, Access::Read);
  for (const MemoryAccess& each : effects_now(cpu.program(), op, cpu.state().image))
    if (each.reads() && !is_status(each)) reads.push_back(each.bits);
  return reads;
}

/// All that an instruction would write now, but not so large an area that it may be anything.
std::vector<Bits> writes_now(const Cpu& cpu, std::uint32_t op) {
  std::vector<Bits> writes = accessed(cpu, op, Access::Write);
  for (const MemoryAccess& each : effects_now(cpu.program(), op, cpu.state().image))
    if (each.writes() && each.bits.count <= kMostAtAPoint) writes.push_back(each.bits);
  return writes;
}

bool has_count(const Op& op) {
  return std::ranges::any_of(op.instruction->rules(), [](const OperandRule& rule) { return rule.count; });
}

/// Whether the system goes on storing what comes of it.
bool lets_the_system_store(const Instruction& instruction) {
  return instruction.effect == Effect::Receives || is_among(instruction.mnemonic, {"NETR", "NETW"});
}

}  // namespace

SeriesKey record_key(TraceKind kind, std::uint8_t where, std::uint16_t what) {
  return kFirstRecord + (std::uint64_t{static_cast<std::uint8_t>(kind)} << 24 | std::uint64_t{where} << 16 | what);
}

namespace {

/// `turns_of` gives those of a bit; null if there is none.
template <typename TurnsOf>
std::vector<std::uint8_t> value_after(const std::vector<std::uint8_t>& image, const Bits& place, Time at,
                                      const TurnsOf& turns_of) {
  std::vector<std::uint8_t> bytes;
  const auto is_on = [&](std::uint64_t bit) {
    if (const std::vector<Turn>* const turns = turns_of(bit)) {
      const auto after = std::ranges::upper_bound(*turns, at, {}, &Turn::at);
      if (after != turns->begin()) return (after - 1)->value;
    }
    return (image[bit / 8] >> (bit % 8) & 1) != 0;
  };
  for (std::uint64_t bit = place.first; bit < place.end(); ++bit) {
    const std::uint64_t number = place.count == 1 ? 0 : bit - place.first;
    if (number % 8 == 0) bytes.push_back(0);
    if (is_on(bit)) bytes.back() = static_cast<std::uint8_t>(bytes.back() | 1U << (number % 8));
  }
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> RunRecord::value(const Bits& place, Time at) const {
  return value_after(image, place, at, [&](std::uint64_t bit) -> const std::vector<Turn>* {
    const auto turns = memory.find(bit);
    return turns == memory.end() ? nullptr : &turns->second;
  });
}

std::vector<std::uint8_t> RunRecord::value(const Bits& place, Point point, Time at) const {
  return value_after(image, place, at, [&](std::uint64_t bit) -> const std::vector<Turn>* {
    const auto turns = series.find(memory_key(bit, point));
    return turns == series.end() ? nullptr : &turns->second;
  });
}

bool RunRecord::is_looked_at(const Bits& place, Point point) const {
  if (point == kBetweenScans) return true;
  return std::ranges::any_of(places[point], [&](const Bits& each) { return each.contains(place); });
}

bool RunRecord::passes_about(std::uint32_t op, Time at, Time about) const {
  const auto after = std::ranges::lower_bound(passes[op], at, {}, &Passes::last);
  if (after != passes[op].end() && after->first <= at + about) return true;
  return after != passes[op].begin() && (after - 1)->last + about >= at;
}

SeriesRecorder::SeriesRecorder(History& history, std::size_t station, std::optional<Hold> hold, StopToken stop_request)
    : Reader(station, stop_request),
      cpu_(history.station(station).cpu()),
      hold_(std::move(hold)),
      run_{.image = {cpu_.state().image.begin(), cpu_.state().image.begin() + image::kConstants}},
      seen_(run_.image),
      reads_(cpu_.program().ops.size()),
      writes_(cpu_.program().ops.size()),
      direct_reads_(cpu_.program().ops.size()),
      passed_in_(cpu_.program().ops.size()),
      decided_(cpu_.program().ops.size()) {
  run_.places.resize(behind(static_cast<std::uint32_t>(cpu_.program().ops.size())));
  run_.passes.resize(cpu_.program().ops.size());
  samples_ = std::make_unique<PointSamples>(run_);
  levels_ = std::make_unique<MemoryOfLevels>(cpu_, seen_, *samples_);
}

SeriesRecorder::~SeriesRecorder() = default;

void SeriesRecorder::ignore_edges() {
  State& state = cpu_.core().s;
  edges_ = Edges{.attached = state.attached, .counter = state.counter};
  std::copy_n(state.image.begin() + image::kHC, edges_->values.size(), edges_->values.begin());
  for (std::size_t event = 0; event < kEdgeEvents; ++event) state.attached[event] = kNotAttached;
}

/// A level for each subroutine, of the main program and of an interrupt routine.
std::size_t SeriesRecorder::level() const {
  const State& state = cpu_.state();
  return state.call_depth + (state.in_interrupt ? kMostCalls + 1 : 0);
}

bool SeriesRecorder::is_stop(std::uint32_t op) const {
  const auto& ops = cpu_.program().ops;
  return op < ops.size() && ops[op].instruction->mnemonic == "STOP";
}

std::vector<Bits> SeriesRecorder::reads_of(std::uint32_t op) {
  if (cpu_.program().ops[op].has_pointer || has_count(cpu_.program().ops[op])) return reads_now(cpu_, op);
  if (!reads_[op]) reads_[op] = reads_now(cpu_, op);
  return *reads_[op];
}

const std::vector<Bits>& SeriesRecorder::writes_of(std::uint32_t op) {
  if (!writes_[op] || has_count(cpu_.program().ops[op])) writes_[op] = writes_now(cpu_, op);
  return *writes_[op];
}

/// What it reads whatever pointers and counts have: another run reads the same there.
const std::vector<Bits>& SeriesRecorder::direct_reads_of(std::uint32_t op) {
  if (direct_reads_[op]) return *direct_reads_[op];
  direct_reads_[op].emplace();
  if (has_count(cpu_.program().ops[op])) return *direct_reads_[op];
  for (const MemoryAccess& each : effects_now(cpu_.program(), op, cpu_.state().image))
    if (each.reads() && !each.by_pointer && !is_status(each) && each.bits.count <= kMostAtAPoint)
      direct_reads_[op]->push_back(each.bits);
  return *direct_reads_[op];
}

void SeriesRecorder::note_pass(std::uint32_t op) {
  std::vector<Passes>& passes = run_.passes[op];
  const Time now = cpu_.time();
  if (!passes.empty() && passed_in_[op] + 1 >= scans_)
    passes.back().last = now;
  else
    passes.push_back({now, now});
  passed_in_[op] = scans_;
}

void SeriesRecorder::put(const Bits& place, const std::vector<std::uint8_t>& value) {
  auto& bytes = cpu_.core().s.image;
  const std::size_t at = place.first / 8;
  if (place.count != 1) {
    std::ranges::copy(value, bytes.begin() + static_cast<std::ptrdiff_t>(at));
    return;
  }
  const auto mask = static_cast<std::uint8_t>(1U << (place.first % 8));
  bytes[at] = static_cast<std::uint8_t>((bytes[at] & ~mask) | (value[0] != 0 ? mask : 0));
}

/// From the change on that was held off.
void SeriesRecorder::heed_edges_again() {
  if (!edges_) return;
  State& state = cpu_.core().s;
  state.attached = edges_->attached;
  state.counter = edges_->counter;
  std::ranges::copy(edges_->values, state.image.begin() + image::kHC);
  edges_.reset();
}

void SeriesRecorder::keep_held() {
  if (!hold_) return;
  if (cpu_.time() >= hold_->until) {
    if (!hold_->then.empty()) put(hold_->places.front(), hold_->then);
    hold_.reset();
    return;
  }
  for (const Bits& place : hold_->places) {
    if (bytes_at(cpu_.state(), place) == hold_->value) continue;
    put(place, hold_->value);
    heed_edges_again();
  }
}

bool SeriesRecorder::before(std::uint32_t op) {
  interrupted_ |= !Reader::before(op);
  run_.full |= run_.happenings.size() >= kMostHappenings;
  run_.end = cpu_.time();
  if (interrupted_ || run_.full) return false;
  levels_->follow();
  keep_held();
  note_changes({}, cpu_.time());
  level_ = level();
  const Op& next = cpu_.program().ops[op];
  read_now_.clear();
  written_now_.clear();
  known_only_now_ = next.has_pointer || next.instruction->structure == Structure::Call || returns_from_subroutine(next);
  if (known_only_now_) {
    read_now_ = reads_now(cpu_, op);
    written_now_ = accessed(cpu_, op, Access::Write);
  }
  note_pass(op);
  samples_->look(in_front_of(op), returns_from_subroutine(next) ? read_now_ : direct_reads_of(op), seen_, cpu_.time());
  return true;
}

void SeriesRecorder::instruction(const InstructionRecord& record) {
  levels_->follow();
  keep_held();
  const Op& op = cpu_.program().ops[record.op];
  const Instruction& instruction = *op.instruction;
  Rung& rung = rungs_[level_];
  if (begins_routine(instruction.structure)) rung = {};
  const ContactForm form = contact_form(instruction);
  if (form.is_contact()) {
    if (form.join == Join::Load && rung.ended) rung.contacts.clear();
    rung.ended = false;
    std::vector<Bits> reads = op.has_pointer ? read_now_ : reads_of(record.op);
    if (!reads.empty()) rung.contacts.push_back({record.op, std::move(reads)});
    return;
  }
  if (works_on_the_stack(instruction.mnemonic)) {
    rung.ended = false;
    return;
  }
  note_changes(record.op, record.at);
  const std::vector<Bits>& written = known_only_now_ ? written_now_ : writes_of(record.op);
  if (record.powered) note_written(record, written);
  samples_->look(behind(record.op), written, seen_, cpu_.time());
  if (decides(instruction)) note_decision(record);
  if (record.powered && lets_the_system_store(instruction)) note_store(record.op);
  const auto rules = instruction.rules();
  if (!rules.empty() && !op[0].pointer && is_timer(op[0].at))
    timers_[timer_of(std::uint64_t{op[0].at} * 8)] = looks_of(record.op);
  rung.ended = true;
}

/// Contacts of the rung first, in their order.
std::vector<Look> SeriesRecorder::looks_of(std::uint32_t op) {
  std::vector<Look> looks;
  for (const Contact& contact : rungs_[level_].contacts)
    for (const Bits& bits : contact.reads) looks.push_back({contact.op, bits});
  const bool early = !read_now_.empty();
  for (const Bits& bits : early ? read_now_ : reads_of(op)) looks.push_back({op, bits});
  return looks;
}

void SeriesRecorder::note_store(std::uint32_t op) {
  Store store{.at = cpu_.time(), .looks = looks_of(op)};
  for (const MemoryAccess& each : effects_now(cpu_.program(), op, cpu_.state().image))
    if (each.writes()) store.places.push_back(each.bits);
  stores_[op] = std::move(store);
}

/// The instruction that lets the system store there, the last one that was executed.
std::optional<std::uint32_t> SeriesRecorder::stored_by(const Bits& place) const {
  std::optional<std::uint32_t> found;
  for (const auto& [op, store] : stores_) {
    const bool there = std::ranges::any_of(store.places, [&](const Bits& bits) { return bits.overlaps(place); });
    if (there && (!found || stores_.at(*found).at < store.at)) found = op;
  }
  return found;
}

/// A timer goes on because of the last execution of its instruction, and its bit because of its value; an input has what its
/// point has; a message is stored because of its RCV.
std::vector<Look> SeriesRecorder::looks_of_system(const Bits& place) const {
  const auto byte = static_cast<std::uint32_t>(place.first / 8);
  if (byte < image::kQ) return {{{}, {place.first + std::uint64_t{image::kInputs - image::kI} * 8, place.count}}};
  if (const auto by = stored_by(place)) return stores_.at(*by).looks;
  if (!is_timer(byte)) return {};
  const std::uint32_t number = timer_of(place.first);
  const auto executed = timers_.find(number);
  std::vector<Look> looks = executed == timers_.end() ? std::vector<Look>{} : executed->second;
  if (byte >= image::kTBits) looks.push_back({{}, {std::uint64_t{image::kT + 2 * number} * 8, 16}});
  return looks;
}

Happening SeriesRecorder::happening_of(std::optional<std::uint32_t> op, Time at) const {
  const State& state = cpu_.state();
  Happening happening{.at = at, .op = op};
  if (state.in_interrupt) happening.serving = state.serving_event;
  return happening;
}

void SeriesRecorder::add(SeriesKey key, Time at, Happening happening) {
  run_.series[key].push_back({at, run_.happenings.size(), true});
  run_.happenings.push_back(std::move(happening));
}

/// The places that the instruction has written, then what else has changed.
std::vector<Bits> SeriesRecorder::places_of(const std::vector<std::uint64_t>& changed,
                                            const std::vector<Bits>& written) const {
  std::vector<Bits> places;
  for (const std::uint64_t bit : changed) {
    const Bits one{bit, 1};
    const auto contains = [&](const Bits& place) { return place.contains(one); };
    if (std::ranges::any_of(places, contains)) continue;
    const auto operand = std::ranges::find_if(written, contains);
    places.push_back(operand == written.end() ? natural_place(bit) : *operand);
  }
  return places;
}

void SeriesRecorder::note_changes(std::optional<std::uint32_t> op, Time at) {
  const std::uint8_t* const now = cpu_.state().image.data();
  if (std::memcmp(now, seen_.data(), kCompared) == 0) return;
  std::vector<std::uint64_t> changed;
  for (std::uint32_t byte = 0; byte < image::kConstants; ++byte) {
    const auto differ = static_cast<std::uint8_t>(now[byte] ^ seen_[byte]);
    seen_[byte] = now[byte];
    if (differ == 0 || is_left_out(byte)) continue;
    for (std::uint64_t bit = 0; bit < 8; ++bit)
      if (differ >> bit & 1) changed.push_back(std::uint64_t{byte} * 8 + bit);
  }
  if (changed.empty()) return;
  const bool early = !written_now_.empty();
  const std::vector<Bits> written = !op ? std::vector<Bits>{} : early ? written_now_ : accessed(cpu_, *op, Access::Write);
  for (const Bits& place : places_of(changed, written)) {
    Happening happening = happening_of(op, at);
    happening.place = place;
    happening.looks = op ? looks_of(*op) : looks_of_system(place);
    if (!op) happening.op = stored_by(place);
    for (const std::uint64_t bit : changed)
      if (place.contains({bit, 1})) {
        run_.memory[bit].push_back({at, run_.happenings.size(), (now[bit / 8] >> (bit % 8) & 1) != 0});
        samples_->changed(bit, run_.happenings.size());
      }
    run_.happenings.push_back(std::move(happening));
  }
}

/// What it writes comes of it, even the bits that had been so before.
void SeriesRecorder::note_written(const InstructionRecord& record, const std::vector<Bits>& places) {
  constexpr std::uint64_t kMostOfAnOperand = 32;
  for (const Bits& place : places) {
    if (place.count > kMostOfAnOperand || is_left_out(static_cast<std::uint32_t>(place.first / 8)) ||
        !samples_->is_new(behind(record.op), place, seen_))
      continue;
    Happening happening = happening_of(record.op, record.at);
    happening.place = place;
    happening.looks = looks_of(record.op);
    for (std::uint64_t bit = place.first; bit < place.end(); ++bit) samples_->changed(bit, run_.happenings.size());
    run_.happenings.push_back(std::move(happening));
  }
}

/// Of an LSCR that is whether its segment is executed.
void SeriesRecorder::note_decision(const InstructionRecord& record) {
  const bool segment = cpu_.program().ops[record.op].instruction->structure == Structure::SegmentBegin;
  const bool value = segment ? cpu_.state().rail : record.powered;
  if (decided_[record.op] == value) return;
  decided_[record.op] = value;
  Happening happening = happening_of(record.op, record.at);
  happening.looks = looks_of(record.op);
  run_.series[decision_key(record.op)].push_back({record.at, run_.happenings.size(), value});
  run_.happenings.push_back(std::move(happening));
}

void SeriesRecorder::record(const TraceRecord& record) {
  Happening happening = happening_of({}, record.at);
  happening.kind = record.kind;
  switch (record.kind) {
    case TraceKind::ScanBegin:
      if (scan_ != 0) run_.longest_scan = std::max(run_.longest_scan, record.at - scan_);
      scan_ = record.at;
      ++scans_;
      samples_->look_between_scans(seen_, record.at);
      rungs_[0] = {};
      return;
    case TraceKind::CharacterSent:
      happening.where = record.port;
      happening.what = record.byte;
      happening.looks = messages_[record.port];
      break;
    case TraceKind::Transmit:
      happening.where = record.port;
      happening.op = record.op;
      happening.looks = messages_[record.port] = looks_of(record.op);
      break;
    case TraceKind::ServiceBegin:
      happening.where = record.event;
      happening.what = record.routine;
      for (const PortInfo& port : kPorts)
        if (port.received_message == record.event) happening.looks = looks_of_system({port.message * std::uint64_t{8}, 8});
      break;
    case TraceKind::Attach:
    case TraceKind::Detach:
      happening.where = record.event;
      happening.what = record.routine;
      happening.op = record.op;
      happening.looks = looks_of(record.op);
      break;
    case TraceKind::Enable:
    case TraceKind::RuntimeError:
    case TraceKind::FatalError:
      happening.what = record.code;
      if (record.op < cpu_.program().ops.size()) {
        happening.op = record.op;
        happening.looks = looks_of(record.op);
      }
      break;
    case TraceKind::ModeChange:
      samples_->look_between_scans(seen_, record.at);
      happening.what = record.code;
      if (const std::uint32_t op = cpu_.core().loop.op; is_stop(op)) {
        happening.op = op;
        happening.looks = looks_of(op);
      }
      break;
    default:
      return;
  }
  const SeriesKey key = record_key(record.kind, happening.where, happening.what);
  add(key, record.at, std::move(happening));
}

}  // namespace s7200::tools
