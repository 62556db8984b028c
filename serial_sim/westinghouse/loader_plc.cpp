#include "serial_sim/westinghouse/loader_plc.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/westinghouse/messages/words.hpp"

namespace s7200::westinghouse {
namespace {

constexpr std::uint32_t kAddresses = 0x10000;
constexpr std::size_t kMostArguments = kMostLoaderBytes + 2;
constexpr std::uint32_t kDirectory = 0xE400;
constexpr std::uint32_t kBlockHeader = 10;  // bytes before the data of a block

/// The pointers that opcode 18 returns: PII, PIQ, flags, timers, counters, system data, software release, end of the
/// program.
constexpr std::array<std::uint16_t, 8> kPointers{0xEF00, 0xEF80, 0xEE00, 0xEC00, 0xED00, 0xEA00, 0x2804, 0xCFFF};

/// The PLC of the document: four outputs, and DB001 with two words.
constexpr std::array<std::uint8_t, 4> kOutputs{0x12, 0x34, 0x56, 0x78};
constexpr std::array<std::uint8_t, 14> kBlock{0x70, 0x70, 0x41, 0x01, 0x80, 0x00, 0x00,
                                              0x00, 0x00, 0x07, 0x11, 0x01, 0x00, 0x00};
constexpr std::array<std::uint8_t, 2> kBlockAddress{0x80, 0x24};

/// User memory, and the images of timers, counters, flags, inputs and outputs.
bool is_area(std::uint32_t address) { return (address >= 0x8000 && address <= 0xCFFF) || address >= 0xEC00; }

}  // namespace

LoaderPlc::LoaderPlc() {
  put(0xEF80, kOutputs);
  put(0x8024 - kBlockHeader, kBlock);
  put(kDirectory + 2, kBlockAddress);
}

void LoaderPlc::put(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) memory_.write(address++, byte);
}

std::uint16_t LoaderPlc::word(std::uint32_t address) const {
  return static_cast<std::uint16_t>(memory_.read(address) << 8 | memory_.read(address + 1));
}

void LoaderPlc::go_idle() {
  due_ = LoaderStep::Begin;
  in_arguments_ = dle_ = false;
  arguments_.clear();
  data_.clear();
  wake_at(kNever);
}

/// A session ends if no byte comes for too long.
void LoaderPlc::wake(Time) { go_idle(); }

void LoaderPlc::restart(Time) { go_idle(); }

void LoaderPlc::say(Bytes bytes, Time request_end) {
  const Time at = request_end + settings_.latency_us * kMicrosecond;
  const Time end = at + static_cast<Time>(bytes.size()) * settings_.line.character_time();
  if (due_ != LoaderStep::Begin) wake_at(end + settings_.timeout_ms * kMillisecond);
  answer(std::move(bytes), at);
}

void LoaderPlc::refuse(Time end) {
  go_idle();
  if (settings_.nak == LoaderSettings::Nak::Sent) say({kRefusal.begin(), kRefusal.end()}, end);
}

/// Takes the PLC's turn in the session.
void LoaderPlc::go_on(Time end) {
  const bool with_data = has_data(static_cast<LoaderOpcode>(opcode_));
  const LoaderStep step = after(due_, with_data);
  due_ = after(step, with_data);
  if (step != LoaderStep::DataSent) return say(fixed(step), end);
  Bytes bytes = settings_.dle == Dle::Doubled ? stuffed(data_) : data_;
  bytes.insert(bytes.end(), kEndOfData.begin(), kEndOfData.end());
  say(std::move(bytes), end);
}

void LoaderPlc::hear(const ReceivedCharacter& character) {
  const Time end = character.start + settings_.line.character_time();
  const bool damaged = character.parity_error || character.framing_error;
  if (due_ == LoaderStep::Begin) {
    if (damaged || character.byte != kStx) return;
    return go_on(end);
  }
  wake_at(end + settings_.timeout_ms * kMillisecond);
  if (damaged) return refuse(end);
  take(character.byte, end);
}

void LoaderPlc::take(std::uint8_t byte, Time end) {
  if (in_arguments_) return take_argument(byte, end);
  if (due_ != LoaderStep::Opcode) return take_acknowledgement(byte, end);
  if (!is_loader_opcode(byte)) return refuse(end);
  opcode_ = byte;
  go_on(end);
}

void LoaderPlc::take_acknowledgement(std::uint8_t byte, Time end) {
  if (!dle_ && byte == kDle) {
    dle_ = true;
  } else if (dle_ && byte == kAck) {
    dle_ = false;
    acknowledged(end);
  } else {
    refuse(end);
  }
}

void LoaderPlc::acknowledged(Time end) {
  if (due_ == LoaderStep::Close) return go_idle();
  in_arguments_ = due_ == LoaderStep::Arguments;
  if (!in_arguments_) go_on(end);
}

void LoaderPlc::take_argument(std::uint8_t byte, Time end) {
  if (std::exchange(dle_, false)) {
    if (byte == kEot) return carry_out(end);
    if (byte != kDle) return refuse(end);
  } else if (byte == kDle) {
    dle_ = true;
    return;
  }
  if (arguments_.size() <= kMostArguments) arguments_.push_back(byte);
}

void LoaderPlc::carry_out(Time end) {
  if (!run()) return refuse(end);
  in_arguments_ = false;
  go_on(end);
}

bool LoaderPlc::run() {
  switch (static_cast<LoaderOpcode>(opcode_)) {
    case LoaderOpcode::Write:
      return write();
    case LoaderOpcode::Read:
      return read();
    case LoaderOpcode::Pointers:
      data_.assign(settings_.head_bytes, 0);
      for (const std::uint16_t pointer : kPointers) {
        data_.push_back(high_byte(pointer));
        data_.push_back(low_byte(pointer));
      }
      data_.resize(data_.size() + settings_.tail_bytes);
      return arguments_.empty();
    case LoaderOpcode::Block:
      return describe_block();
    case LoaderOpcode::Directory:
      data_ = {0};
      add_memory(kDirectory + (settings_.directory == FirstBlock::Db0 ? 0 : 2), kMostLoaderBytes);
      return arguments_.size() == 1 && arguments_[0] == kDataBlocks;
  }
  return false;
}

void LoaderPlc::add_memory(std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) data_.push_back(memory_.read(first + i));
}

bool LoaderPlc::read() {
  if (arguments_.size() != 4) return false;
  const std::uint32_t first = load16(&arguments_[0]), last = load16(&arguments_[2]);
  if (first > last || last - first >= kMostLoaderBytes) return false;
  data_.assign(kReadHead, 0);
  add_memory(first, last - first + 1);
  return true;
}

bool LoaderPlc::write() {
  if (arguments_.size() < 3 || arguments_.size() > kMostArguments) return false;
  const std::uint32_t first = load16(&arguments_[0]);
  const auto data = std::span(arguments_).subspan(2);
  if (first + data.size() > kAddresses) return false;
  if (settings_.writable == LoaderSettings::Writable::Areas)
    for (std::uint32_t i = 0; i < data.size(); ++i)
      if (!is_area(first + i)) return false;
  put(first, data);
  return true;
}

bool LoaderPlc::describe_block() {
  if (arguments_.size() != 2 || arguments_[0] != kDataBlocks) return false;
  const std::uint16_t address = word(kDirectory + 2U * arguments_[1]);
  if (address < kBlockHeader) return false;
  data_ = {0, high_byte(address), low_byte(address)};
  add_memory(address - kBlockHeader, kBlockHeader);
  return true;
}

const std::vector<Setting<LoaderPlc>>& LoaderPlc::settings() {
  using enum SettingForm::Notation;
  using S = LoaderSettings;
  static const std::vector<Setting<LoaderPlc>> kSettings = [] {
    std::vector<Setting<LoaderPlc>> rows;
    const auto own = [](auto& plc) -> auto& { return plc.settings_; };
    const auto add = [&](SettingForm form, auto member) {
      rows.push_back(setting_of<LoaderPlc>(std::move(form), own, member));
    };
    add_line_settings(
        rows, "", [](auto& plc) -> auto& { return plc.settings_.line; });
    add({"latency_us", "", "microseconds from a request to its answer", Decimal, {}, 0, 10'000}, &S::latency_us);
    add({"directory", "S1", "block whose address is the first of the directory", Word, kFirstBlockWords}, &S::directory);
    add({"head_bytes", "S2", "bytes 00 before the pointers of the system parameters", Decimal, {}, 0, 16}, &S::head_bytes);
    add({"tail_bytes", "S2", "bytes 00 after the pointers of the system parameters", Decimal, {}, 0, 64}, &S::tail_bytes);
    add({"dle", "S3", "how the PLC sends a byte 10 in data", Word, kDleWords}, &S::dle);
    add({"timeout_ms", "S4", "milliseconds that it waits for each byte within a session", Decimal, {}, 1, 10'000},
        &S::timeout_ms);
    add({"nak", "S4", "whether it answers what does not fit with 10 15", Word,
         words_of<S::Nak>({{S::Nak::Sent, "sent"}, {S::Nak::Silent, "silent"}})},
        &S::nak);
    add({"writable", "S5", "what can be written: all of memory, or user memory and images only", Word,
         words_of<S::Writable>({{S::Writable::All, "all"}, {S::Writable::Areas, "areas"}})},
        &S::writable);
    return rows;
  }();
  return kSettings;
}

const std::vector<Cells<LoaderPlc>>& LoaderPlc::cells() {
  static const std::vector<Cells<LoaderPlc>> kCells{
      {"M", true, 0, kAddresses - 1, UINT8_MAX, "bytes of the memory",
       [](const LoaderPlc& plc, std::uint32_t a) { return std::uint32_t{plc.memory_.read(a)}; },
       [](LoaderPlc& plc, std::uint32_t a, std::uint32_t value) {
         plc.memory_.write(a, static_cast<std::uint8_t>(value));
       }}};
  return kCells;
}

}  // namespace s7200::westinghouse
