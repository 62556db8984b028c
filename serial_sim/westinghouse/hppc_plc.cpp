#include "serial_sim/westinghouse/hppc_plc.hpp"

#include <array>
#include <utility>

#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/westinghouse/messages/words.hpp"

namespace s7200::westinghouse {
namespace {

constexpr std::uint8_t kLinkError = 0x01, kIllegalOpcode = 0x10, kInvalidOperand = 0x11, kInvalidLength = 0x12,
                       kChannelError = 0x26;
constexpr Time kLongestGap = 500 * kMillisecond, kLongestMessage = 10 * kSecond;
constexpr std::uint8_t kNetworkNotFound = 0x02, kNotRunning = 0x10;

/// The parameter table of section 6.6 as far as the document prints values, address by address.
struct TableEntry {
  std::uint32_t value;
  std::uint8_t bytes;
};
constexpr std::array kTable{
    TableEntry{0x008A, 2},                                                  // ladder checksum
    TableEntry{0x80456, 4}, TableEntry{0x8066A, 4},                         // OG force bit table, OG image
    TableEntry{0x80880, 4}, TableEntry{0x80C02, 4},                         // IOP 1, IOP 2
    TableEntry{0x80C02, 4}, TableEntry{0x0040, 2},  TableEntry{0x0000, 2},  // history bits: base, length, highest used
    TableEntry{0x0000, 2},  TableEntry{0x0110, 2},                          // highest network: UDSF, main ladder
    TableEntry{0x80C82, 4}, TableEntry{3, 4},       TableEntry{0x80C85, 4},
    TableEntry{3, 4},                               // UDSF and main ladder: base, length
    TableEntry{0xABFFE, 4}, TableEntry{0x0800, 2},  // holding registers: base, number
};
constexpr std::size_t kHighestHistoryBit = 7, kHighestNetwork = 9, kRegisters = kTable.size() - 1;
constexpr std::uint32_t kTableEnd = 0x80034;

}  // namespace

std::uint32_t HppcPlc::value(std::uint32_t address, std::size_t bytes) const {
  std::uint32_t value = 0;
  for (std::size_t i = bytes; i-- > 0;) value = value << 8 | memory_.read(address + static_cast<std::uint32_t>(i));
  return value;
}

void HppcPlc::put(std::uint32_t address, std::uint32_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i)
    memory_.write(address + static_cast<std::uint32_t>(i), static_cast<std::uint8_t>(value >> 8 * i & 0xFF));
}

/// [H10] The printed example has no word for the highest history bit, and no registers.
void HppcPlc::put_table() {
  const bool example = settings_.table == HppcSettings::Table::Example;
  for (std::uint32_t address = kParameterTable; address < kTableEnd; ++address) memory_.write(address, 0);
  std::uint32_t address = kParameterTable;
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (example && i == kHighestHistoryBit) continue;
    put(address, example && i == kRegisters ? 0 : kTable[i].value, kTable[i].bytes);
    address += kTable[i].bytes;
  }
}

void HppcPlc::begin_anew() {
  message_.clear();
  deaf_ = false;
  wake_at(kNever);
}

/// A gap, or a message that takes too long.
void HppcPlc::wake(Time) { begin_anew(); }

void HppcPlc::restart(Time at) {
  begin_anew();
  sends_until_ = 0;
  powered_since_ = at;
}

void HppcPlc::hear(const ReceivedCharacter& character) {
  if (character.start < powered_since_ + settings_.search_ms * kMillisecond) return;
  if (character.start < sends_until_) {
    abort();
    sends_until_ = 0;
    return begin_anew();
  }
  const Time end = character.start + settings_.line.character_time();
  if (message_.empty() && !deaf_) begun_ = character.start;
  const bool too_long = end - begun_ > kLongestMessage;
  wake_at(end + kLongestGap);
  deaf_ = deaf_ || too_long || character.framing_error || character.parity_error;
  if (deaf_) return;
  message_.push_back(character.byte);
  if (message_.size() < 2) return;
  const std::size_t length = load16_low_first(message_.data());
  deaf_ = length < kShortestHppc || length > kLongestHppc;
  if (deaf_ || message_.size() < length) return;
  const Bytes message = message_;
  begin_anew();
  take(message, end);
}

void HppcPlc::take(Data message, Time end) {
  const std::uint8_t destination = message[2], source = message[3], opcode = message[5];
  if (destination != kIop && destination != kAll) return;
  if (settings_.zero_byte == HppcSettings::ZeroByte::Checked && message[4] != 0) return;
  const bool intact = hppc_fcs(message, settings_.fcs) == 0;
  if (intact && opcode == static_cast<std::uint8_t>(HppcOpcode::Error)) return;
  Reply reply{.error = kLinkError};
  if (intact) reply = carry_out(opcode, message.subspan(kHppcHeader, message.size() - kShortestHppc));
  if (destination == kAll) return;
  HppcOpcode answered{opcode};
  if (reply.error != 0) {
    if (settings_.errors == HppcSettings::Errors::Ignored) return;
    answered = HppcOpcode::Error;
    reply.operands = {reply.error, static_cast<std::uint8_t>(settings_.edit_lo & 0xFF),
                      static_cast<std::uint8_t>(settings_.edit_lo >> 8)};
  }
  const std::uint8_t from = settings_.port == HppcSettings::Port::Iop ? kIop : 0;
  Bytes bytes = hppc_message(source, from, answered, reply.operands, settings_.fcs);
  const Time character = settings_.line.character_time(), at = end + settings_.answer_after * character;
  sends_until_ = at + static_cast<Time>(bytes.size()) * character;
  answer(std::move(bytes), at);
}

HppcPlc::Reply HppcPlc::carry_out(std::uint8_t opcode, Data operands) {
  constexpr std::uint8_t kLastNamed = 0x23, kFirstNamedAgain = 0x20, kLastOfBlock = 0x0F;
  switch (static_cast<HppcOpcode>(opcode)) {
    case HppcOpcode::Parameters:
      return parameters(operands);
    case HppcOpcode::Read:
      return read(operands);
    case HppcOpcode::Write:
      return write(operands);
    case HppcOpcode::BitWrite:
      return write_bits(operands);
    case HppcOpcode::Monitor:
      return monitor(operands);
    case HppcOpcode::Error:
      break;
  }
  const bool named = opcode <= kLastOfBlock || (opcode >= kFirstNamedAgain && opcode <= kLastNamed);
  return {.error = named ? kChannelError : kIllegalOpcode};
}

HppcPlc::Reply HppcPlc::parameters(Data operands) const {
  if (operands.size() != 1) return {.error = kInvalidLength};
  Reply reply;
  add_hppc_address(reply.operands, kParameterTable);
  for (std::uint32_t i = 0; i < operands[0]; ++i) reply.operands.push_back(memory_.read(kParameterTable + i));
  return reply;
}

HppcPlc::Reply HppcPlc::read(Data operands) const {
  const bool addressed = settings_.layout.read_request == HppcLayout::ReadRequest::AddressAndNumber;
  if (operands.size() != (addressed ? 4U : 1U)) return {.error = kInvalidLength};
  const std::uint32_t first = addressed ? hppc_address(operands) : 0;
  const std::uint8_t count = operands.back();
  if (first + count > kHppcMemory) return {.error = kInvalidOperand};
  Reply reply{.operands = {count}};
  for (std::uint32_t i = 0; i < count; ++i) reply.operands.push_back(memory_.read(first + i));
  return reply;
}

HppcPlc::Reply HppcPlc::write(Data operands) {
  constexpr std::size_t kHead = 4;
  if (operands.size() < kHead || operands.size() != kHead + operands[3]) return {.error = kInvalidLength};
  const std::uint32_t first = hppc_address(operands);
  const Data data = operands.subspan(kHead);
  if (first + data.size() > kHppcMemory) return {.error = kInvalidOperand};
  for (std::uint32_t i = 0; i < data.size(); ++i) memory_.write(first + i, data[i]);
  return {};
}

HppcPlc::Reply HppcPlc::write_bits(Data operands) {
  if (operands.size() != 7) return {.error = kInvalidLength};
  const std::uint32_t address = hppc_address(operands);
  if (address + 2 > kHppcMemory) return {.error = kInvalidOperand};
  std::uint32_t pattern = load16_low_first(&operands[3]), mask = load16_low_first(&operands[5]);
  if (settings_.layout.bit_write == HppcLayout::BitWrite::MaskFirst) std::swap(pattern, mask);
  put(address, (value(address, 2) & ~mask) | (pattern & mask), 2);
  return {};
}

HppcPlc::Reply HppcPlc::monitor(Data operands) const {
  constexpr std::size_t kHead = 6, kSizes = 3;
  const std::size_t width = settings_.layout.monitor_address_bytes;
  if (operands.size() < kHead) return {.error = kInvalidLength};
  const Data counts = operands.subspan(3, kSizes);
  const std::size_t addresses = std::size_t{counts[0]} + counts[1] + counts[2];
  if (operands.size() != kHead + width * addresses) return {.error = kInvalidLength};
  if (counts[0] + 2U * counts[1] + 4U * counts[2] > kMostMonitored) return {.error = kInvalidOperand};
  Reply reply{.operands = {monitor_status(hppc_address(operands))}};
  Data rest = operands.subspan(kHead);
  for (std::size_t size = 0; size < kSizes; ++size)
    for (std::size_t i = 0; i < counts[size]; ++i) {
      const std::uint32_t address = hppc_address(rest), bytes = 1U << size;
      if (address + bytes > kHppcMemory) return {.error = kInvalidOperand};
      for (std::uint32_t byte = 0; byte < bytes; ++byte) reply.operands.push_back(memory_.read(address + byte));
      rest = rest.subspan(width);
    }
  return reply;
}

std::uint8_t HppcPlc::monitor_status(std::uint32_t network) const {
  if (settings_.status != HppcSettings::kAsItIs) return settings_.status;
  if (settings_.run == HppcSettings::Run::Stopped) return kNotRunning;
  std::uint32_t place = kParameterTable;
  for (std::size_t i = 0; i < kHighestNetwork; ++i)
    if (settings_.table == HppcSettings::Table::Section66 || i != kHighestHistoryBit) place += kTable[i].bytes;
  return network > value(place, 2) ? kNetworkNotFound : 0;
}

const std::vector<Setting<HppcPlc>>& HppcPlc::settings() {
  using enum SettingForm::Notation;
  using S = HppcSettings;
  using L = HppcLayout;
  static const std::vector<Setting<HppcPlc>> kSettings = [] {
    std::vector<Setting<HppcPlc>> rows;
    const auto own = [](auto& plc) -> auto& { return plc.settings_; };
    const auto add = [&](SettingForm form, auto member) {
      rows.push_back(setting_of<HppcPlc>(std::move(form), own, member));
    };
    const auto add_to_layout = [&](SettingForm form, auto member) {
      const auto layout = [](auto& plc) -> auto& { return plc.settings_.layout; };
      rows.push_back(setting_of<HppcPlc>(std::move(form), layout, member));
    };
    add({"port", "", "where the computer is plugged in", Word,
         words_of<S::Port>({{S::Port::Sim0, "sim0"}, {S::Port::Iop, "iop"}})},
        &S::port);
    add({"run", "", "whether the processor runs", Word,
         words_of<S::Run>({{S::Run::Running, "running"}, {S::Run::Stopped, "stopped"}})},
        &S::run);
    add({"fcs", "", "frame check: with the odd entry of the document's table, or without", Word, kFcsWords}, &S::fcs);
    add({"edit_lo", "H8", "register in error responses", Hex, {}, 0, UINT16_MAX}, &S::edit_lo);
    add({"answer_after", "", "characters of silence before an answer", Decimal, {}, 1, 200}, &S::answer_after);
    add_line_settings(
        rows, "H1", [](auto& plc) -> auto& { return plc.settings_.line; });
    add({"search_ms", "H2", "milliseconds after power-up that it looks for its line", Decimal, {}, 0, 10'000},
        &S::search_ms);
    add({"zero_byte", "H3", "the fifth byte of a message", Word,
         words_of<S::ZeroByte>({{S::ZeroByte::Ignored, "ignored"}, {S::ZeroByte::Checked, "checked"}})},
        &S::zero_byte);
    add_to_layout({"read_request", "H4", "operands of a read", Word, kReadRequestWords}, &L::read_request);
    add_to_layout({"bit_write", "H5", "order of the words of a bit write", Word, kBitWriteWords}, &L::bit_write);
    add_to_layout({"monitor_address_bytes", "H6", "bytes of each address of a monitor", Decimal, {}, 3, 4},
                  &L::monitor_address_bytes);
    add({"status", "H7", "status in the answer to a monitor; FF: as the processor and the networks are"}, &S::status);
    add({"errors", "H8", "what it does with a request that is wrong", Word,
         words_of<S::Errors>({{S::Errors::Answered, "answered"}, {S::Errors::Ignored, "ignored"}})},
        &S::errors);
    rows.push_back({{"table", "H10", "parameter table as in section 6.6, or as in the printed example", Word,
                     words_of<S::Table>({{S::Table::Section66, "section66"}, {S::Table::Example, "example"}})},
                    [](const HppcPlc& plc) { return static_cast<std::uint32_t>(plc.settings_.table); },
                    [](HppcPlc& plc, std::uint32_t value) {
                      plc.settings_.table = static_cast<S::Table>(value);
                      plc.put_table();
                    }});
    return rows;
  }();
  return kSettings;
}

const std::vector<Cells<HppcPlc>>& HppcPlc::cells() {
  static const std::vector<Cells<HppcPlc>> kCells{
      {"M", true, 0, kHppcMemory - 1, UINT8_MAX, "bytes of the memory",
       [](const HppcPlc& plc, std::uint32_t a) { return std::uint32_t{plc.memory_.read(a)}; },
       [](HppcPlc& plc, std::uint32_t a, std::uint32_t value) { plc.memory_.write(a, static_cast<std::uint8_t>(value)); }}};
  return kCells;
}

}  // namespace s7200::westinghouse
