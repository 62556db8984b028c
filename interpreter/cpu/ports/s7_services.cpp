#include "interpreter/cpu/ports/s7_services.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "interpreter/cpu/ports/freeport.hpp"
#include "interpreter/cpu/ports/s7_blocks.hpp"
#include "interpreter/cpu/units/clock.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/cpu/units/points.hpp"
#include "interpreter/model/s7_pdu.hpp"

namespace s7200::s7_services {
namespace {

using namespace s7;
using Span = std::span<const std::uint8_t>;

/// A place says where a variable is, or why it is nowhere.
struct Place {
  ReturnCode code = kDone;
  Area area{};
  std::uint32_t at = 0, bytes = 0;  ///< in the image, or in the identification
  std::uint32_t in_data = 0;        ///< bytes of T, C and HC in an answer or a request
  std::optional<std::uint8_t> bit{};
  bool identification = false;
};

/// 0 of a type that is not known.
std::uint32_t bytes_of_type(std::uint8_t type) {
  const auto width = width_of(type);
  return width ? bytes_of(*width) : 0;
}

/// T, C and HC go by number; their type has the code of their area.
Place find_element(const Core& core, const WireVariable& variable, const AreaInfo& area) {
  if (variable.type != variable.area) return {.code = kWrongType};
  if (variable.count == 0 || variable.address + variable.count > core.model().size_of(area.area)) return {.code = kOutside};
  return {.area = area.area,
          .at = area.base + variable.address * area.element,
          .bytes = variable.count * area.element,
          .in_data = variable.count * bytes_of_element(area.area)};
}

/// This is for variables in bytes; all others go by bits.
Place find_bytes(const Core& core, const WireVariable& variable, const AreaInfo& area) {
  const std::uint32_t first = variable.address / 8;
  const auto bit = static_cast<std::uint8_t>(variable.address % 8);
  const bool is_bit = variable.type == kBit;
  const std::uint32_t bytes = is_bit ? 1 : variable.count * bytes_of_type(variable.type);
  if (is_bit ? area.bits == kNoBits || variable.count != 1 : bytes_of_type(variable.type) == 0 || bit != 0)
    return {.code = kWrongType};
  if (bytes == 0 || first + bytes > core.model().size_of(area.area)) return {.code = kOutside};
  return {.area = area.area, .at = area.base + first, .bytes = bytes, .bit = is_bit ? std::optional(bit) : std::nullopt};
}

Place find_in_identification(const WireVariable& variable) {
  const std::uint32_t first = variable.address / 8, bytes = variable.count * bytes_of_type(variable.type);
  if (variable.type == kBit || bytes_of_type(variable.type) == 0 || variable.address % 8 != 0) return {.code = kWrongType};
  if (bytes == 0 || first + bytes > kIdentificationBytes) return {.code = kOutside};
  return {.at = first, .bytes = bytes, .identification = true};
}

const WireArea* find_area(std::uint8_t code) {
  const auto found = std::ranges::find(kWireAreas, code, &WireArea::code);
  return found == kWireAreas.end() ? nullptr : &*found;
}

Place find(const Core& core, const WireVariable& variable) {
  if (variable.area == kSystemInformation) return find_in_identification(variable);
  const WireArea* found = find_area(variable.area);
  if (found == nullptr || (found->area == Area::V && variable.block != kBlockOfV)) return {.code = kNoArea};
  const AreaInfo& area = info(found->area);
  return area.element != 0 ? find_element(core, variable, area) : find_bytes(core, variable, area);
}

/// The name of a CPU and its release.
Bytes identification_of(const CpuModel& model) {
  std::string text = "CPU " + std::string(model.sold_as.empty() ? model.name : model.sold_as);
  text.resize(kIdentificationName, ' ');
  text += model.release;
  return {text.begin(), text.end()};
}

void append(Bytes& to, Span bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

/// A place as forcing knows it.
MemoryRange range_of(const Place& place, const WireVariable& variable) {
  return {.area = place.area,
          .width = width_of(variable.type).value_or(Width::Word),
          .number = place.at - info(place.area).base,
          .bit = place.bit.value_or(0),
          .at = place.at};
}

std::uint32_t number_in(Width width, Span value) {
  if (width == Width::Bit) return value[0] & 1;
  std::uint32_t number = 0;
  for (const std::uint8_t byte : value) number = number << 8 | byte;
  return number;
}

/// An answer to a request has these parts.
struct Reply {
  Refusal refusal = Refusal::None;
  Bytes parameters{}, data{};
};

/// A master's request, with what it needs to be carried out.
class Request {
 public:
  Request(Core& core, std::uint8_t port, std::uint8_t source, Kind kind, Span parameters, Span data)
      : core_(core), port_(port), source_(source), kind_(kind), parameters_(parameters), data_(data) {}

  Reply carry_out() {
    if (kind_ == kUserData) return user_data();
    if (parameters_.empty()) return refused(Refusal::Malformed);
    switch (parameters_[0]) {
      case kSetup:
        return set_up();
      case kRead:
        return read();
      case kWrite:
        return write();
      case kStartUpload:
        return start_upload();
      case kUpload:
      case kEndUpload:
        return go_on_with_upload();
      case kRun:
      case kStop:
        return change_mode();
      default:
        return refused(Refusal::Unknown);
    }
  }

 private:
  Reply user_data() {
    const auto asked = user_data_in(parameters_);
    if (!asked) return user_data_reply(refused(Refusal::Malformed));
    return user_data_reply(user_data(asked->group, asked->service));
  }

  Reply user_data(std::uint8_t group, std::uint8_t service) {
    switch (group << 8 | service) {
      case kBlockGroup << 8 | kListBlocks:
        return list(s7_blocks::counts());
      case kBlockGroup << 8 | kListBlocksOfType:
        return list_blocks_of_type();
      case kBlockGroup << 8 | kBlockInfo:
        return tell_of_block();
      case kClockGroup << 8 | kReadClock:
        return has_clock() ? read_clock() : refused(Refusal::Unknown);
      case kClockGroup << 8 | kSetClock:
        return has_clock() ? set_clock() : refused(Refusal::Unknown);
      case kForceGroup << 8 | kForce:
        return force();
      case kForceGroup << 8 | kSetInStop:
        return set_in_stop();
      default:
        return refused(Refusal::Unknown);
    }
  }

  Reply refused(Refusal why) {
    trace(static_cast<std::uint16_t>(why));
    return {.refusal = why};
  }

  void trace(std::uint16_t code) const {
    TraceRecord record{
        .at = core_.s.time, .kind = TraceKind::PpiService, .event = source_, .port = port_, .code = code, .op = kind_};
    if (const auto asked = kind_ == kUserData ? user_data_in(parameters_) : std::nullopt)
      record.routine = asked->group, record.byte = asked->service, record.count = 1;
    else if (kind_ == kRequest && !parameters_.empty())
      record.byte = parameters_[0], record.count = 1;
    core_.trace(record);
  }

  void trace(PpiVerb verb, const WireVariable& variable, ReturnCode code) const {
    core_.trace({.at = core_.s.time,
                 .kind = TraceKind::PpiAccess,
                 .event = source_,
                 .routine = variable.area,
                 .byte = static_cast<std::uint8_t>(verb),
                 .port = port_,
                 .type = variable.type,
                 .code = code,
                 .op = variable.address,
                 .count = variable.count});
  }

  Reply set_up() {
    constexpr std::size_t kLength = 8;  // F0 00 jobs(2) jobs(2) length of a PDU(2)
    if (parameters_.size() != kLength) return refused(Refusal::Malformed);
    trace(0);
    Reply reply;
    append(reply.parameters, std::array<std::uint8_t, 6>{kSetup, 0, 0, 1, 0, 1});
    append16(reply.parameters, std::min<std::size_t>(load16(&parameters_[6]), kLongestPdu));
    return reply;
  }

  /// The variables that the parameters list; none if they are not what they should be.
  std::vector<WireVariable> variables() const {
    std::vector<WireVariable> found;
    if (parameters_.size() < 2 || parameters_.size() != 2 + parameters_[1] * kVariableBytes) return found;
    for (std::size_t at = 2; at < parameters_.size(); at += kVariableBytes) {
      const Span bytes = parameters_.subspan(at, kVariableBytes);
      if (!std::equal(kVariableHead.begin(), kVariableHead.end(), bytes.begin())) return {};
      found.push_back(variable_at(bytes));
    }
    return found;
  }

  Reply read() {
    const std::vector<WireVariable> wanted = variables();
    if (wanted.empty()) return refused(Refusal::Malformed);
    Reply reply{.parameters = {kRead, parameters_[1]}};
    for (const WireVariable& variable : wanted) {
      const Place place = find(core_, variable);
      if (reply.data.size() + std::max(place.bytes, place.in_data) > kLongestPdu) return refused(Refusal::TooLong);
      if (reply.data.size() % 2 != 0) reply.data.push_back(0);
      append_value(reply.data, place);
      trace(PpiVerb::Reads, variable, place.code);
    }
    return reply;
  }

  void append_value(Bytes& data, const Place& place) const {
    data.push_back(place.code);
    if (place.code != kDone) {
      append(data, std::array<std::uint8_t, 3>{});
    } else if (place.bit) {
      data.push_back(kInBits);
      append16(data, 1);
      data.push_back(core_.s.image[place.at] >> *place.bit & 1);
    } else if (place.identification) {
      data.push_back(kInBitsOfBytes);
      append16(data, place.bytes * 8);
      append(data, Span(identification_of(core_.model())).subspan(place.at, place.bytes));
    } else if (place.in_data != 0) {
      append_elements(data, place);
    } else {
      data.push_back(kInBitsOfBytes);
      append16(data, place.bytes * 8);
      append(data, Span(core_.s.image).subspan(place.at, place.bytes));
    }
  }

  void append_elements(Bytes& data, const Place& place) const {
    const AreaInfo& area = info(place.area);
    data.push_back(kInBytes);
    append16(data, place.in_data);
    for (std::uint32_t at = place.at; at < place.at + place.bytes; at += area.element) {
      const std::uint32_t number = (at - area.base) / area.element;
      const bool is_on = area.bits != kNoBits && (core_.s.image[area.bits + number / 8] >> number % 8 & 1) != 0;
      append_element(data, place.area, Span(core_.s.image).subspan(at, area.element), is_on);
    }
  }

  /// Writes all variables if all of them are there, and nothing otherwise.
  Reply write() {
    const std::vector<WireVariable> wanted = variables();
    const std::vector<Span> values = values_of(wanted.size());
    if (values.empty()) return refused(Refusal::Malformed);
    Reply reply{.parameters = {kWrite, parameters_[1]}};
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      Place place = find(core_, wanted[i]);
      if (place.code == kDone) place.code = put(place, values[i]);
      trace(PpiVerb::Writes, wanted[i], place.code);
      reply.data.push_back(place.code);
    }
    if (core_.s.mode == Mode::Run) freeport::follow_control(core_);
    return reply;
  }

  /// The values stand in the data, in the order of the variables: 00 type length(2) value; each begins at an even place.
  /// None if there are fewer than `count`.
  std::vector<Span> values_of(std::size_t count) const {
    std::vector<Span> values;
    for (std::size_t at = 0; values.size() < count; at += 4 + values.back().size() + values.back().size() % 2) {
      const auto value = value_at(at);
      if (!value) return {};
      values.push_back(*value);
    }
    return values;
  }

  std::optional<Span> value_at(std::size_t at) const {
    if (at + 4 > data_.size()) return {};
    const std::size_t bytes = data_bytes(data_[at + 1], load16(&data_[at + 2]));
    if (at + 4 + bytes > data_.size()) return {};
    return data_.subspan(at + 4, bytes);
  }

  ReturnCode put(const Place& place, Span value) {
    const bool read_only = place.identification || place.area == Area::AI || place.area == Area::HC ||
                           (place.area == Area::SM && place.at < sm::byte(kReadOnlySpecialMemory));
    if (read_only) return kNotAllowed;
    if (value.size() != (place.in_data != 0 ? place.in_data : place.bytes)) return kWrongType;
    if (place.bit) {
      core_.put_bit(place.at, *place.bit, (value[0] & 1) != 0);
      return kDone;
    }
    const Bytes values = place.in_data != 0 ? element_values(place.area, value) : Bytes(value.begin(), value.end());
    std::ranges::copy(values, core_.s.image.begin() + place.at);
    return kDone;
  }

  Reply change_mode() {
    if (parameters_.size() < kProgram.size() ||
        !std::equal(kProgram.begin(), kProgram.end(), parameters_.end() - static_cast<std::ptrdiff_t>(kProgram.size())))
      return refused(Refusal::Unknown);
    trace(0);
    core_.s.ppi[port_].wanted_mode = parameters_[0] == kRun ? Mode::Run : Mode::Stop;
    return {.parameters = {parameters_[0]}};
  }

  // --- blocks ---

  /// A list as the data of the answer to user data.
  Reply list(const Bytes& list) {
    trace(0);
    return {.data = data_of_list(list)};
  }

  Reply list_blocks_of_type() {
    const auto type = list_in(data_);
    if (!type || type->size() < 2 || (*type)[0] != '0') return refused(Refusal::Malformed);
    const auto blocks = s7_blocks::of_type((*type)[1]);
    if (!blocks) return refused(Refusal::BlockType);
    return blocks->empty() ? refused(Refusal::NoBlockOfType) : list(*blocks);
  }

  Reply tell_of_block() {
    const auto text = list_in(data_);
    if (!text) return refused(Refusal::Malformed);
    const Refusal refusal = refusal_of_block(*text);
    return refusal == Refusal::None ? list(s7_blocks::information(core_.model())) : refused(refusal);
  }

  static Refusal refusal_of_block(Span text) {
    const auto name = block_name_in(text);
    return name ? s7_blocks::refusal_of(*name) : Refusal::BlockName;
  }

  Reply start_upload() {
    const auto name = name_to_upload(parameters_);
    if (!name) return refused(Refusal::Malformed);
    const Refusal refusal = refusal_of_block(*name);
    if (refusal != Refusal::None) return refused(refusal);
    trace(0);
    core_.s.ppi[port_].uploads = true;
    core_.s.ppi[port_].uploaded = 0;
    const std::string length = fmt::format("{:07}", s7_blocks::upload_length(core_.model()));
    Reply reply{.parameters = {kStartUpload, 0, 1, 0, 0, 0, 0, kUploadId, static_cast<std::uint8_t>(length.size())}};
    reply.parameters.insert(reply.parameters.end(), length.begin(), length.end());
    return reply;
  }

  /// Sends the next part of the upload, or its end.
  Reply go_on_with_upload() {
    constexpr std::size_t kId = 7;
    PpiPort& port = core_.s.ppi[port_];
    if (parameters_.size() != kId + 1) return refused(Refusal::Malformed);
    if (!port.uploads || parameters_[kId] != kUploadId) return refused(Refusal::OutOfTurn);
    trace(0);
    if (parameters_[0] == kUpload) return part_of_upload(port);
    port.uploads = false;
    return {.parameters = {kEndUpload}};
  }

  Reply part_of_upload(PpiPort& port) const {
    constexpr std::size_t kMost = kLongestPdu - kAnswerHead - 2 - 4;
    const Bytes part = s7_blocks::upload(core_, port.uploaded, kMost);
    port.uploaded = static_cast<std::uint16_t>(port.uploaded + part.size());
    const bool more = port.uploaded < s7_blocks::upload_length(core_.model());
    Reply reply{.parameters = {kUpload, more}};
    append16(reply.data, part.size());
    append(reply.data, std::array<std::uint8_t, 2>{0, 0xFB});
    append(reply.data, part);
    return reply;
  }

  static constexpr std::uint8_t kUploadId = 1;

  // --- forced values ---

  Reply force() {
    const auto list = forced_in(data_, 0);
    if (!list) return refused(Refusal::Malformed);
    return for_each(*list, list->released ? PpiVerb::Unforces : PpiVerb::Forces,
                    [&](const MemoryRange& place, Span value) { return force(place, value, list->released); });
  }

  ReturnCode force(const MemoryRange& place, Span value, bool released) {
    if (!forcing::possible(place)) return kNotAllowed;
    if (released) return forcing::unforce(core_, place), kDone;
    return forcing::force(core_, place, number_in(place.width, value)) ? kDone : kNotAllowed;
  }

  Reply set_in_stop() {
    const auto list = forced_in(data_, kValueHead);
    if (!list || list->released) return refused(Refusal::Malformed);
    return for_each(*list, PpiVerb::SetsInStop, [&](const MemoryRange& place, Span value) {
      if (core_.s.mode != Mode::Stop || !points::can_be_set_in_stop(place)) return kNotAllowed;
      points::set_in_stop(core_, place, number_in(place.width, value));
      return kDone;
    });
  }

  /// The answer lists what has become of each variable.
  Reply for_each(const ForcedList& list, PpiVerb verb, const auto& act) {
    Bytes codes{static_cast<std::uint8_t>(list.released), static_cast<std::uint8_t>(list.variables.size())};
    for (std::size_t i = 0; i < list.variables.size(); ++i) {
      const WireVariable& variable = list.variables[i];
      const Place place = find(core_, variable);
      ReturnCode code = place.code;
      if (code == kDone) code = place.identification ? kNotAllowed : variable.count != 1 ? kWrongType : kDone;
      if (code == kDone) code = act(range_of(place, variable), list.released ? Span{} : list.values[i]);
      trace(verb, variable, code);
      codes.push_back(code);
    }
    return {.data = data_of_list(codes)};
  }

  // --- the clock ---

  bool has_clock() const { return (core_.model().self & clock::kCpusWithClock) != 0; }

  Reply read_clock() {
    trace(0);
    return {.data = data_of_clock(clock::bcd_now(core_))};
  }

  Reply set_clock() {
    const auto wanted = clock_in(data_);
    if (!wanted) return refused(Refusal::Malformed);
    clock::Bcd to = wanted->todr;
    to[6] = 0;
    to[7] &= 0x0F;
    if (!clock::is_time(to) || !clock::set_bcd(core_, to)) return refused(Refusal::Malformed);
    trace(0);
    return {.data = {kNotStored, 0, 0, 0}};
  }

  static constexpr std::uint8_t kNotStored = 0x0A;  ///< no data follow

  Reply user_data_reply(Reply reply) {
    UserData answer = user_data_in(parameters_).value_or(UserData{});
    answer.is_answer = true;
    answer.error = static_cast<std::uint16_t>(reply.refusal);
    reply.parameters = parameters_of(answer);
    if (reply.data.empty()) reply.data = {kNotStored, 0, 0, 0};
    return reply;
  }

  Core& core_;
  std::uint8_t port_, source_;
  Kind kind_;
  Span parameters_, data_;
};

Bytes pdu(Kind kind, Span request, const Reply& reply) {
  Bytes pdu{kProtocol, kind, 0, 0, request[4], request[5]};
  append16(pdu, reply.parameters.size());
  append16(pdu, reply.data.size());
  if (kind == kAnswer) append16(pdu, static_cast<std::uint16_t>(reply.refusal));
  append(pdu, reply.parameters);
  append(pdu, reply.data);
  return pdu;
}

}  // namespace

Bytes carry_out(Core& core, std::uint8_t port, std::uint8_t source, Span request) {
  if (request.size() < kRequestHead || request[0] != kProtocol || (request[1] != kRequest && request[1] != kUserData))
    return {};
  const std::size_t parameters = load16(&request[6]), data = load16(&request[8]);
  if (request.size() != kRequestHead + parameters + data) return {};
  const auto kind = static_cast<Kind>(request[1]), kind_of_answer = kind == kUserData ? kUserData : kAnswer;
  const Reply reply = Request(core, port, source, kind, request.subspan(kRequestHead, parameters),
                              request.subspan(kRequestHead + parameters))
                          .carry_out();
  Bytes answer = pdu(kind_of_answer, request, reply);
  if (answer.size() > kLongestPdu) answer = pdu(kind_of_answer, request, {.refusal = Refusal::TooLong});
  return answer;
}

}  // namespace s7200::s7_services
