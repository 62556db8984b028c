#include "tools/trials/chance.hpp"

#include <algorithm>
#include <utility>

#include "serial_sim/modbus/crc.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostRemembered = 256, kLongestFrame = 256;
constexpr Time kLongestPreset = 2 * 3600 * kSecond;
constexpr Time kPulse = 5 * kMillisecond;  ///< an input is on or off at least; a few scans
constexpr int kMostWrong = 3;

std::uint32_t number_at(const Vocabulary::Bytes& place, const State& now) {
  std::uint32_t number = 0;
  for (std::uint32_t i = 0; i < place.count; ++i) number = number << 8 | now.image[place.place + i];
  return number;
}

std::uint32_t mask_of(std::uint8_t bytes) { return bytes >= 4 ? ~0u : (1u << 8 * bytes) - 1; }

}  // namespace

Time TrialMaker::wait() {
  switch (chance_.below(8)) {
    case 0:
      return 0;
    case 1:
    case 2:
      return static_cast<Time>(chance_.below(20)) * kMillisecond;
    case 3:
    case 4:
      return 20 * kMillisecond + static_cast<Time>(chance_.below(180)) * kMillisecond;
    case 5:
      return static_cast<Time>(1 + chance_.below(12)) * 100 * kMillisecond;
    default:
      if (words_.presets.empty()) return 300 * kMillisecond;
      const Time preset = std::min(chance_.one_of(words_.presets), kLongestPreset);
      return preset + (chance_.one_in(2) ? 150 * kMillisecond : static_cast<Time>(chance_.below(8)) * preset / 8);
  }
}

std::uint32_t TrialMaker::value() {
  if (!words_.constants.empty() && !chance_.one_in(4))
    return static_cast<std::uint32_t>(chance_.one_of(words_.constants) + chance_.below(3) - 1);
  const std::uint64_t any = chance_.draw();
  return static_cast<std::uint32_t>(chance_.one_in(2) ? any % 16 : any);
}

/// At the boundary of a comparison that the memory decides: equal, or one more or less.
std::uint32_t TrialMaker::value_for(const Vocabulary::Bytes& place, const State& now) {
  const auto decided = decides_.find(place.place);
  if (decided == decides_.end() || decided->second.empty() || chance_.one_in(3)) return value();
  const Decided& one = chance_.one_of(decided->second);
  const std::uint32_t difference = words_.comparisons[one.comparison].difference(now.image);
  const std::uint32_t equal = number_at(place, now) - (one.against ? 0 - difference : difference);
  return chance_.one_in(2) ? equal : static_cast<std::uint32_t>(equal + 2 * chance_.below(2) - 1);
}

Stimulus TrialMaker::set_memory(const Vocabulary::Bytes& place, const State& now) {
  const std::uint32_t number = value_for(place, now);
  set_ = Set{place, number_at(place, now), number, {}};
  for (const Vocabulary::Comparison& each : words_.comparisons) set_->differences.push_back(each.difference(now.image));
  Stimulus stimulus{.what = Stimulus::What::Memory, .place = place.place};
  for (std::uint32_t i = place.count; i-- > 0;) stimulus.bytes.push_back(static_cast<std::uint8_t>(number >> 8 * i));
  return stimulus;
}

void TrialMaker::learn(const State& after) {
  const auto set = std::exchange(set_, std::nullopt);
  if (!set) return;
  for (std::size_t i = 0; i < words_.comparisons.size(); ++i) {
    const Vocabulary::Comparison& comparison = words_.comparisons[i];
    const std::uint32_t mask = mask_of(std::min(comparison.count, set->place.count));
    const std::uint32_t by = (set->value - set->before) & mask;
    const std::uint32_t changed = (comparison.difference(after.image) - set->differences[i]) & mask;
    if (by == 0) continue;
    std::vector<Decided>& known = decides_[set->place.place];
    note(known, i, false, changed == by);
    note(known, i, true, changed != by && changed == ((0 - by) & mask));
  }
}

void TrialMaker::note(std::vector<Decided>& known, std::size_t comparison, bool against, bool is_so) {
  const auto is_it = [&](const Decided& each) { return each.comparison == comparison && each.against == against; };
  const auto found = std::ranges::find_if(known, is_it);
  if (found == known.end()) {
    if (is_so) known.push_back({comparison, against});
    return;
  }
  found->wrong = is_so ? 0 : found->wrong + 1;
  if (found->wrong == kMostWrong) known.erase(found);
}

Stimulus TrialMaker::switch_inputs(const State& now) {
  const Vocabulary::Bytes& input = chance_.one_of(words_.inputs);
  std::uint8_t value = now.terminals[input.place];
  std::uint8_t bits = 0;
  while ((bits & input.mask) == 0)
    bits = chance_.one_in(3) ? chance_.byte() : static_cast<std::uint8_t>(1u << chance_.below(8));
  value ^= bits & input.mask;
  return {.what = Stimulus::What::Input, .place = input.place, .bytes = {value}};
}

static_assert(TrialMaker::kMostEdges * 2 * kPulse == 60 * kSecond);

/// As many as a counter counts, or one more or less.
Trial TrialMaker::pulses(const State& now) {
  const std::uint32_t count = std::min(chance_.one_of(words_.counts), kMostEdges);
  const Vocabulary::Bytes& input = chance_.one_of(words_.inputs);
  std::uint8_t bit = 0;
  while ((bit & input.mask) == 0) bit = static_cast<std::uint8_t>(1u << chance_.below(8));
  Trial trial;
  std::uint8_t value = now.terminals[input.place];
  for (std::uint64_t turns = 2 * std::max<std::uint64_t>(1, count + chance_.below(3) - 1); turns > 0; --turns) {
    value ^= bit;
    trial.push_back({.wait = kPulse, .what = Stimulus::What::Input, .place = input.place, .bytes = {value}});
  }
  return trial;
}

Trial TrialMaker::next(const State& now) {
  const Time pause = wait();
  const std::uint64_t kinds[]{words_.inputs.empty() ? 0U : 6U, words_.analog.empty() ? 0U : 3U,
                              words_.commands.empty() ? 0U : 3U, words_.port ? 6U : 0U};
  const std::uint64_t drawn = chance_.below(kinds[0] + kinds[1] + kinds[2] + kinds[3]);
  if (words_.empty()) return {{.wait = pause, .what = Stimulus::What::Input, .place = 0, .bytes = {now.terminals[0]}}};
  const bool inputs = drawn < kinds[0];
  if (inputs && !words_.counts.empty() && chance_.one_in(4)) return pulses(now);
  Stimulus stimulus = inputs                                   ? switch_inputs(now)
                      : drawn < kinds[0] + kinds[1]            ? set_memory(chance_.one_of(words_.analog), now)
                      : drawn < kinds[0] + kinds[1] + kinds[2] ? set_memory(chance_.one_of(words_.commands), now)
                                                               : frame();
  stimulus.wait = pause;
  return {std::move(stimulus)};
}

void TrialMaker::remember(const std::vector<std::uint8_t>& frame) {
  if (remembered_.size() < kMostRemembered)
    remembered_.push_back(frame);
  else
    remembered_[static_cast<std::size_t>(chance_.below(kMostRemembered))] = frame;
}

/// A field of a request is another value; then its CRC is right again.
std::vector<std::uint8_t> TrialMaker::well_formed() {
  std::vector<std::uint8_t> frame = chance_.one_of(words_.requests);
  frame.resize(frame.size() - 2);
  for (std::uint64_t changes = chance_.below(4); changes > 0; --changes) {
    const std::size_t at = 1 + static_cast<std::size_t>(chance_.below(frame.size() - 1));
    constexpr std::uint16_t kWords[]{0, 1, 0x7D, 0x7E, 0xFF, 0x100, 0x7FFF, 0x8000, 0xFFFF};
    if (at + 1 < frame.size() && chance_.one_in(3)) {
      const std::uint16_t word = chance_.one_of(kWords);
      frame[at] = static_cast<std::uint8_t>(word >> 8);
      frame[at + 1] = static_cast<std::uint8_t>(word);
      continue;
    }
    constexpr std::uint8_t kEdges[]{0, 1, 2, 0x7D, 0x7F, 0x80, 0xFF};
    frame[at] = chance_.one_in(2) ? chance_.one_of(kEdges) : static_cast<std::uint8_t>(value());
  }
  if (chance_.one_in(4))
    frame.resize(std::min(kLongestFrame - 2, frame.size() + static_cast<std::size_t>(chance_.below(120))));
  modbus::add_crc(frame);
  return frame;
}

/// A write of several coils or registers whose quantity, byte count and data agree, or one of them lies; its CRC is right.
std::vector<std::uint8_t> TrialMaker::write_of_several() {
  const bool coils = chance_.one_in(2);
  const auto bytes_of = [coils](std::uint64_t quantity) { return coils ? (quantity + 7) / 8 : 2 * quantity; };
  constexpr std::uint16_t kStarts[]{0, 1, 8, 0x3F, 0x40, 0x3FF, 0x7FF, 0x7FFF, 0x8000, 0xFFFF};
  constexpr std::uint16_t kQuantities[]{0, 1, 2, 8, 0x3C, 0x78, 0x7B, 0x80, 0x7FFF, 0xFFFF};
  const std::uint16_t start = chance_.one_in(2) ? chance_.one_of(kStarts) : static_cast<std::uint16_t>(value());
  std::uint64_t quantity = chance_.one_in(2) ? chance_.one_of(kQuantities) : chance_.below(130);
  std::uint64_t count = bytes_of(quantity), data = count;
  const auto lies = [&](std::uint64_t& about) { about = chance_.one_in(2) ? about + chance_.below(3) - 1 : chance_.byte(); };
  switch (chance_.below(5)) {
    case 0:
      lies(quantity);
      break;
    case 1:
      lies(count);
      break;
    case 2:
      lies(data);
      break;
    default:
      break;
  }
  std::vector<std::uint8_t> frame{words_.requests.front().front(), static_cast<std::uint8_t>(coils ? 15 : 16)};
  for (const std::uint64_t word : {std::uint64_t{start}, quantity}) {
    frame.push_back(static_cast<std::uint8_t>(word >> 8));
    frame.push_back(static_cast<std::uint8_t>(word));
  }
  frame.push_back(static_cast<std::uint8_t>(count));
  while (frame.size() < std::min<std::uint64_t>(7 + (data & 0xFF), kLongestFrame - 2)) frame.push_back(chance_.byte());
  modbus::add_crc(frame);
  return frame;
}

/// What the program compares characters with, now and then ended as lines are.
std::vector<std::uint8_t> TrialMaker::characters() {
  std::vector<std::uint8_t> frame;
  const std::uint64_t most = chance_.one_in(8) ? kLongestFrame - 1 : chance_.one_in(3) ? 1 : 12;
  const std::uint64_t count = 1 + chance_.below(most);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint32_t characters = chance_.one_in(3) ? chance_.byte() : value();
    for (int byte = characters > 0xFFFF ? 3 : characters > 0xFF ? 1 : 0; byte >= 0; --byte)
      frame.push_back(static_cast<std::uint8_t>(characters >> 8 * byte));
  }
  if (chance_.one_in(3)) frame.push_back('\r');
  return frame;
}

void TrialMaker::change(std::vector<std::uint8_t>& frame) {
  const std::size_t at = static_cast<std::size_t>(chance_.below(frame.size()));
  switch (chance_.below(6)) {
    case 0:
      frame[at] ^= static_cast<std::uint8_t>(1u << chance_.below(8));
      break;
    case 1:
      frame[at] = static_cast<std::uint8_t>(value());
      break;
    case 2:
      frame.resize(at + 1);
      break;
    case 3:
      frame.insert(frame.begin() + static_cast<std::ptrdiff_t>(at), chance_.byte());
      break;
    case 4:
      frame.erase(frame.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    default:
      const auto other = words_.requests.empty() ? characters() : chance_.one_of(words_.requests);
      frame.insert(frame.end(), other.begin(), other.end());
  }
}

Stimulus TrialMaker::frame() {
  Stimulus stimulus{.what = Stimulus::What::Frame};
  std::vector<std::uint8_t>& bytes = stimulus.bytes;
  const bool known = !words_.requests.empty();
  if (known && !chance_.one_in(4))
    bytes = chance_.one_in(4) ? write_of_several() : well_formed();
  else if (!remembered_.empty() && !chance_.one_in(3))
    bytes = chance_.one_of(remembered_);
  else
    bytes = characters();
  if (chance_.one_in(known ? 5 : 2)) change(bytes);
  if (bytes.empty()) bytes.push_back(chance_.byte());
  if (bytes.size() > kLongestFrame) bytes.resize(kLongestFrame);
  if (chance_.one_in(12)) stimulus.gap = static_cast<Time>(chance_.below(6)) * kMillisecond;
  return stimulus;
}

/// Power fails seldom: to start again takes as long as hundreds of frames.
Stimulus TrialMaker::disturbance() {
  if (!words_.port || chance_.one_in(16)) return {.wait = wait(), .what = Stimulus::What::Power};
  if (chance_.one_in(3)) return {.wait = wait(), .what = Stimulus::What::Break};
  Stimulus stimulus = frame();
  stimulus.damaged = static_cast<std::uint16_t>(1 + chance_.below(stimulus.bytes.size()));
  stimulus.bad_stop = chance_.one_in(3);
  if (!stimulus.bad_stop) return stimulus;
  if (stimulus.gap == 0) stimulus.damaged = static_cast<std::uint16_t>(stimulus.bytes.size());
  stimulus.bytes[stimulus.damaged - 1u] |= 1;  // without a bit at mark it would be a break
  return stimulus;
}

}  // namespace s7200::tools
