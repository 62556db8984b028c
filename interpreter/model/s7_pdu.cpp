#include "interpreter/model/s7_pdu.hpp"

#include <algorithm>

namespace s7200::s7 {
namespace {

void append(Bytes& to, std::uint8_t type, std::size_t count, std::size_t block, std::uint8_t area, std::uint32_t first) {
  to.insert(to.end(), kVariableHead.begin(), kVariableHead.end());
  to.push_back(type);
  append16(to, count);
  append16(to, block);
  to.push_back(area);
  to.push_back(static_cast<std::uint8_t>(first >> 16));
  append16(to, first & 0xFFFF);
}

constexpr std::size_t kGroup = 5, kService = 6, kNumber = 7, kError = 10;  // places in the parameters of user data
constexpr std::uint8_t kAsksForGroup = 0x40, kAnswersGroup = 0x80;

}  // namespace

std::uint8_t code_of(Area area) {
  const auto found = std::ranges::find(kWireAreas, area, &WireArea::area);
  return found == kWireAreas.end() ? std::uint8_t{0} : found->code;
}

std::uint32_t bytes_of_element(Area area) {
  switch (area) {
    case Area::T:
      return 5;
    case Area::C:
      return 3;
    default:
      return info(area).element;
  }
}

void append_element(Bytes& to, Area area, std::span<const std::uint8_t> value, bool is_on) {
  const std::size_t before = bytes_of_element(area) - value.size();
  if (before != 0) {
    to.push_back(is_on ? kElementIsOn : std::uint8_t{0});
    to.insert(to.end(), before - 1, 0);
  }
  to.insert(to.end(), value.begin(), value.end());
}

Bytes element_values(Area area, std::span<const std::uint8_t> data) {
  const std::size_t size = bytes_of_element(area), value = info(area).element;
  Bytes values;
  for (; data.size() >= size; data = data.subspan(size)) {
    const auto last = data.subspan(size - value, value);
    values.insert(values.end(), last.begin(), last.end());
  }
  return values;
}

std::optional<Width> width_of(std::uint8_t type) {
  switch (type) {
    case kBit:
      return Width::Bit;
    case kByte:
    case kCharacter:
      return Width::Byte;
    case kWord:
    case kInteger:
      return Width::Word;
    case kDouble:
    case kLong:
    case kReal:
      return Width::Double;
    default:
      return {};
  }
}

std::string_view name_of_blocks(std::uint8_t letter) {
  const auto found = std::ranges::find(kBlockTypes, letter, &BlockType::letter);
  return found == kBlockTypes.end() ? std::string_view{} : found->name;
}

std::optional<BlockName> block_name_in(std::span<const std::uint8_t> text) {
  constexpr std::size_t kLength = 8, kDigits = 5;
  if (text.size() != kLength || text[0] != '0') return {};
  BlockName name{.type = text[1]};
  for (const std::uint8_t digit : text.subspan(2, kDigits)) {
    if (digit < '0' || digit > '9') return {};
    name.number = name.number * 10 + (digit - '0');
  }
  return name;
}

std::optional<std::span<const std::uint8_t>> name_to_upload(std::span<const std::uint8_t> parameters) {
  constexpr std::size_t kLength = 8, kName = 10;
  if (parameters.size() < kName || parameters.size() != kLength + 1 + parameters[kLength] || parameters[kName - 1] != '_')
    return {};
  return parameters.subspan(kName);
}

void append(Bytes& to, const Variable& variable) {
  append(to, variable.type, variable.count, variable.area == Area::V ? kBlockOfV : 0, code_of(variable.area),
         variable.first);
}

WireVariable variable_at(std::span<const std::uint8_t> bytes) {
  return {bytes[3], bytes[8], load16(&bytes[4]), load16(&bytes[6]), load32(&bytes[8]) & 0xFF'FFFF};
}

std::size_t data_bytes(std::uint8_t type, std::size_t length) {
  return type == kInBits || type == kInBitsOfBytes ? (length + 7) / 8 : length;
}

/// The client library libnodave does not count the values in the length of its list.
static std::optional<std::span<const std::uint8_t>> list_to_force(std::span<const std::uint8_t> data) {
  constexpr std::size_t kHead = 4, kListHead = 2, kOfVariable = kVariableBytes - 2;
  if (const auto list = list_in(data); list || data.size() < kHead + kListHead) return list;
  const bool counts_variables = load16(&data[2]) == kListHead + data[kHead + 1] * kOfVariable;
  return counts_variables ? std::optional(data.subspan(kHead)) : std::nullopt;
}

std::optional<ForcedList> forced_in(std::span<const std::uint8_t> data, std::size_t head) {
  constexpr std::size_t kListHead = 2, kNoHead = 2, kBytes = kVariableBytes - kNoHead;
  const auto list = list_to_force(data);
  if (!list || list->size() < kListHead || (*list)[0] > 1 || (*list)[1] == 0) return {};
  const std::size_t count = (*list)[1];
  std::size_t at = kListHead + count * kBytes;
  if (list->size() < at) return {};
  ForcedList found{.released = (*list)[0] == 1 || list->size() == at};
  for (std::size_t i = 0; i < count; ++i) {
    const auto bytes = list->subspan(kListHead - kNoHead + i * kBytes, kVariableBytes);  // its first two are not its own
    if (bytes[kNoHead] != kVariableHead[kNoHead]) return {};
    found.variables.push_back(variable_at(bytes));
  }
  for (std::size_t i = 0; i < count && !found.released; ++i) {
    const auto width = width_of(found.variables[i].type);
    const std::size_t bytes = width ? bytes_of(*width) : 0;
    if (list->size() < at + head + bytes) return {};
    found.values.push_back(list->subspan(at + head, bytes));
    at += head + bytes + bytes % 2;
  }
  return found;
}

void append_identification(Bytes& to) { append(to, kByte, kIdentificationBytes, 0, kSystemInformation, 0); }

Bytes parameters_of(const UserData& user_data) {
  const std::uint8_t side = user_data.is_answer ? kAnswersGroup : kAsksForGroup;
  Bytes bytes{0, 1, 0x12, 4, 0x11, static_cast<std::uint8_t>(side | user_data.group), user_data.service, user_data.number};
  if (!user_data.is_answer && user_data.group != kForceGroup) return bytes;
  bytes[3] = 8, bytes[4] = 0x12;
  append16(bytes, 0);
  append16(bytes, user_data.error);
  return bytes;
}

std::optional<UserData> user_data_in(std::span<const std::uint8_t> parameters) {
  if (parameters.size() <= kNumber) return {};
  UserData found{.group = static_cast<std::uint8_t>(parameters[kGroup] & 0x0F),
                 .service = parameters[kService],
                 .number = parameters[kNumber],
                 .is_answer = (parameters[kGroup] & 0xF0) == kAnswersGroup};
  if (!found.is_answer) return found;
  if (parameters.size() < kError + 2) return {};
  found.error = load16(&parameters[kError]);
  return found;
}

Bytes data_of_list(std::span<const std::uint8_t> list) {
  Bytes bytes{kDone, kInBytes};
  append16(bytes, list.size());
  bytes.insert(bytes.end(), list.begin(), list.end());
  return bytes;
}

std::optional<std::span<const std::uint8_t>> list_in(std::span<const std::uint8_t> data) {
  constexpr std::size_t kHead = 4;
  if (data.size() < kHead || load16(&data[2]) != data.size() - kHead) return {};
  return data.subspan(kHead);
}

Bytes data_of_clock(const std::array<std::uint8_t, 8>& todr) {
  constexpr std::uint8_t kFirstYear = 0x90;
  Bytes bytes{kDone, kInBytes, 0, 10, 0, static_cast<std::uint8_t>(todr[0] >= kFirstYear ? 0x19 : 0x20)};
  bytes.insert(bytes.end(), todr.begin(), todr.end());
  return bytes;
}

std::optional<WireClock> clock_in(std::span<const std::uint8_t> data) {
  constexpr std::size_t kCentury = 5, kTodr = 6;
  WireClock clock{};
  if (data.size() != kTodr + clock.todr.size()) return {};
  clock.century = data[kCentury];
  std::copy(data.begin() + kTodr, data.end(), clock.todr.begin());
  return clock;
}

Bytes pdu(Kind kind, std::uint16_t number, const Bytes& parameters, const Bytes& data) {
  Bytes bytes{kProtocol, kind, 0, 0};
  append16(bytes, number);
  append16(bytes, parameters.size());
  append16(bytes, data.size());
  bytes.insert(bytes.end(), parameters.begin(), parameters.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

}  // namespace s7200::s7
