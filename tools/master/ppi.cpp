// PPI: what a CPU answers on a port that is not in Freeport mode (facts 10.9).
#include <array>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "interpreter/program/operands/address.hpp"
#include "tools/master/words.hpp"
#include "tools/master/written_values.hpp"
#include "tools/plan/clock_text.hpp"
#include "tools/views/state/ppi_text.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr std::string_view kOwnStation = "--own-station";
constexpr std::uint8_t kPpiStation = 2, kProgrammingDevice = 0;

/// The request's number: there is one request at a time.
constexpr std::uint16_t kOnlyRequest = 1;

bool is_element(const MemoryRange& range) { return info(range.area).element != 0; }

s7::Type type_of(Width width) {
  switch (width) {
    case Width::Bit:
      return s7::kBit;
    case Width::Byte:
      return s7::kByte;
    case Width::Word:
      return s7::kWord;
    case Width::Double:
      return s7::kDouble;
  }
  return s7::kByte;
}

s7::Variable variable(const MemoryRange& range) {
  if (is_element(range))
    return {.type = s7::code_of(range.area), .count = range.count, .area = range.area, .first = range.number};
  return {.type = type_of(range.width), .count = range.count, .area = range.area, .first = range.number * 8 + range.bit};
}

/// A request, and what its answer is to be read as.
struct Wanted {
  enum class Kind : std::uint8_t { Status, Variable, Identification, Clock, Command, Forced, Unforced };

  Kind kind;
  Bytes pdu{};  ///< empty: the status of the station
  std::optional<MemoryRange> range{};

  bool has_value() const { return kind == Kind::Variable || kind == Kind::Identification; }
  bool is_forced() const { return kind == Kind::Forced || kind == Kind::Unforced; }
  /// The number of data bytes in the answer.
  std::size_t bytes() const {
    if (!range) return s7::kIdentificationBytes;
    return is_element(*range) ? range->count * s7::bytes_of_element(range->area) : range->bytes();
  }
};

class PpiRequest final : public ProtocolRequest {
 public:
  PpiRequest(std::uint8_t station, std::uint8_t own, Wanted wanted)
      : station_(station), own_(own), wanted_(std::move(wanted)) {}
  explicit PpiRequest(serial::Frame raw) : raw_(std::move(raw)) {}

  serial::Frame frame() override {
    if (!raw_.empty()) return raw_;
    polls_ = 0;
    too_late_ = false;
    const auto function = wanted_.pdu.empty() ? ppi::kStatusFunction : ppi::kRequestFunction;
    return serial::to_frame(ppi::to_frame({station_, own_, function, wanted_.pdu}));
  }

  std::optional<serial::Frame> next(Data response, Time elapsed) override {
    const bool fetches = raw_.empty() && !wanted_.pdu.empty() && response.size() == 1 && response[0] == ppi::kAccepted;
    too_late_ = fetches && elapsed > s7::kLongestWork;
    if (!fetches || too_late_) return {};
    const auto function = static_cast<std::uint8_t>(ppi::kPollFunction ^ (polls_++ % 2 == 0 ? 0 : ppi::kFrameCount));
    return serial::to_frame(ppi::to_frame({station_, own_, function}));
  }

  serial::Answer judge(Data request, Data response) const override;
  std::string_view error_name(std::uint16_t code) const override { return s7_error_name(code); }
  std::string subject() const override;
  std::string in_short(const serial::Answer& answer, Data request, Data response) const override;
  std::vector<std::string> in_lines(const serial::Answer& answer, Data request, Data response) const override;
  nlohmann::ordered_json subject_json(Data request) const override;
  nlohmann::ordered_json decoded_json(const serial::Answer& answer) const override;

 private:
  bool reads() const { return wanted_.pdu.size() > s7::kRequestHead && wanted_.pdu[s7::kRequestHead] == s7::kRead; }
  void take(Data pdu, serial::Answer& answer) const;
  bool is_to_this(const s7::UserData& answer) const;
  void take_value(Data data, serial::Answer& answer) const;
  static void take_forced(Data data, serial::Answer& answer);
  std::string value_text(const serial::Answer& answer, std::uint32_t i) const;

  serial::Frame raw_{};
  std::uint8_t station_ = 0, own_ = 0;
  Wanted wanted_{Wanted::Kind::Status};
  unsigned polls_ = 0;
  bool too_late_ = false;  // its station had no answer within kLongestWork
};

serial::Answer wrong(std::string fault) {
  serial::Answer answer;
  answer.verdict = serial::Verdict::Wrong;
  answer.fault = std::move(fault);
  return answer;
}

/// The answer after the acceptances of the request and of polls that came too early.
Data after_acceptances(Data response) {
  while (!response.empty() && response[0] == ppi::kAccepted) response = response.subspan(1);
  return response;
}

std::string_view refusal_of_station(std::uint8_t function) {
  if (function == ppi::kNoResource) return "the station has no resource: another master's answer waits to be fetched";
  if (function == ppi::kNoService) return "the station does not have this service";
  return "the reply has another function than 08";
}

serial::Answer PpiRequest::judge(Data, Data response) const {
  serial::Answer answer;
  if (response.empty()) return answer;
  answer.verdict = serial::Verdict::Right;
  const Data frame = after_acceptances(response);
  if (!raw_.empty()) return answer;
  if (frame.empty() && wanted_.pdu.empty()) return wrong("accepted, but no status");
  if (frame.empty())
    return wrong(too_late_ ? "accepted, but no answer within " + format_duration(s7::kLongestWork)
                           : "accepted, but no reply to a poll");
  const auto body = ppi::frame_length(frame) == frame.size() ? ppi::body_of(frame) : std::nullopt;
  if (!body) return wrong("not a frame: its length, check sum or end is wrong");
  if ((body->function & ppi::kIsRequest) != 0)
    return wrong(fmt::format("a request of station {} to station {}: it is a master, too", body->source, body->destination));
  if (body->source != station_ || body->destination != own_)
    return wrong(fmt::format("a reply of station {} to station {}", body->source, body->destination));
  if (wanted_.pdu.empty()) {
    answer.bytes = {body->function};
    return answer;
  }
  if (body->function != ppi::kData) return wrong(std::string(refusal_of_station(body->function)));
  take(body->data, answer);
  return answer;
}

/// Whether the answer has the group and the service of the request.
bool PpiRequest::is_to_this(const s7::UserData& answer) const {
  const auto asked = s7::user_data_in(Data(wanted_.pdu).subspan(s7::kRequestHead));
  return answer.is_answer && answer.group == asked->group && answer.service == asked->service;
}

void PpiRequest::take(Data pdu, serial::Answer& answer) const {
  const bool user_data = wanted_.pdu[1] == s7::kUserData;
  const std::size_t head = user_data ? s7::kRequestHead : s7::kAnswerHead;
  const bool whole = pdu.size() >= head && pdu[0] == s7::kProtocol && pdu[1] == (user_data ? s7::kUserData : s7::kAnswer) &&
                     pdu.size() == head + load16(&pdu[6]) + load16(&pdu[8]) && load16(&pdu[4]) == load16(&wanted_.pdu[4]);
  if (!whole) {
    answer = wrong("not the answer to this request");
    return;
  }
  const Data parameters = pdu.subspan(head, load16(&pdu[6])), data = pdu.subspan(head + parameters.size());
  const auto answered = user_data ? s7::user_data_in(parameters) : std::nullopt;
  if (user_data && !(answered && is_to_this(*answered))) {
    answer = wrong("not the answer to this request: another group or service");
    return;
  }
  const std::uint16_t error = answered ? answered->error : load16(&pdu[10]);
  if (error != 0) {
    answer.verdict = serial::Verdict::Exception;
    answer.exception = error;
  } else if (wanted_.has_value()) {
    take_value(data, answer);
  } else if (wanted_.is_forced()) {
    take_forced(data, answer);
  } else if (wanted_.kind == Wanted::Kind::Clock && s7_clock_text(data).empty()) {
    answer = wrong(fmt::format("no time in it: {} bytes of data", data.size()));
  } else {
    answer.bytes.assign(data.begin(), data.end());
  }
}

void PpiRequest::take_value(Data data, serial::Answer& answer) const {
  constexpr std::size_t kValueHead = 4;
  if (data.empty()) {
    answer = wrong("no return code");
  } else if (data[0] != s7::kDone) {
    answer.verdict = serial::Verdict::Exception;
    answer.exception = data[0];
  } else if (reads() && data.size() != kValueHead + wanted_.bytes()) {
    answer = wrong(fmt::format("wrong length: {} bytes of data, expected {}", data.size(), kValueHead + wanted_.bytes()));
  } else if (reads()) {
    answer.bytes.assign(data.begin() + kValueHead, data.end());
    if (!wanted_.range) return;
    if (is_element(*wanted_.range)) answer.bytes = s7::element_values(wanted_.range->area, answer.bytes);
    const bool words = wanted_.range->width == Width::Word || wanted_.range->width == Width::Double;
    for (std::size_t i = 0; i < answer.bytes.size(); i += words ? 2 : 1)
      answer.values.push_back(words ? load16(&answer.bytes[i]) : answer.bytes[i]);
  }
}

/// Takes the result for the only variable.
void PpiRequest::take_forced(Data data, serial::Answer& answer) {
  const auto codes = s7::list_in(data);
  if (!codes || codes->empty()) {
    answer = wrong("no return code");
  } else if (codes->back() != s7::kDone) {
    answer.verdict = serial::Verdict::Exception;
    answer.exception = codes->back();
  }
}

std::string range_text(const MemoryRange& range) {
  return range.count == 1 ? range.name_of(0) : fmt::format("{}…{}", range.name_of(0), range.name_of(range.count - 1));
}

std::string PpiRequest::subject() const {
  if (!raw_.empty()) return {};
  return fmt::format("station {}{}", station_, wanted_.range ? ", " + range_text(*wanted_.range) : "");
}

std::string PpiRequest::value_text(const serial::Answer& answer, std::uint32_t i) const {
  const MemoryRange& range = *wanted_.range;
  const std::uint8_t* at = &answer.bytes[i * bytes_of(range.width)];
  switch (range.width) {
    case Width::Bit:
      return fmt::format("{}", at[0] & 1);
    case Width::Byte:
      return fmt::format("16#{:02X} {:>6}", at[0], at[0]);
    case Width::Word:
      return fmt::format("16#{:04X} {:>6}", load16(at), static_cast<std::int16_t>(load16(at)));
    case Width::Double:
      if (range.real) return fmt::format("{}", std::bit_cast<float>(load32(at)));
      return fmt::format("16#{:08X} {:>11}", load32(at), static_cast<std::int32_t>(load32(at)));
  }
  return {};
}

std::string PpiRequest::in_short(const serial::Answer& answer, Data, Data response) const {
  if (!raw_.empty()) return serial::to_hex(response);
  switch (wanted_.kind) {
    case Wanted::Kind::Status:
      return answer.bytes == Bytes{ppi::kSlave} ? "a slave, ready" : fmt::format("16#{:02X}", answer.bytes[0]);
    case Wanted::Kind::Identification:
      return s7_identification_text(answer.bytes);
    case Wanted::Kind::Clock:
      return s7_clock_text(answer.bytes);
    case Wanted::Kind::Command:
      return "done";
    case Wanted::Kind::Forced:
      return range_text(*wanted_.range) + " forced";
    case Wanted::Kind::Unforced:
      return range_text(*wanted_.range) + " no longer forced";
    case Wanted::Kind::Variable:
      break;
  }
  if (!reads()) return range_text(*wanted_.range) + " written";
  std::string text;
  for (std::uint32_t i = 0; i < wanted_.range->count; ++i) text += (i == 0 ? "" : "  ") + value_text(answer, i);
  return text;
}

std::vector<std::string> PpiRequest::in_lines(const serial::Answer& answer, Data request, Data response) const {
  if (!wanted_.range || !reads()) return {"  " + in_short(answer, request, response)};
  std::vector<std::string> lines;
  for (std::uint32_t i = 0; i < wanted_.range->count; ++i)
    lines.push_back(fmt::format("{:>8}  {}", wanted_.range->name_of(i), value_text(answer, i)));
  return lines;
}

nlohmann::ordered_json PpiRequest::subject_json(Data) const {
  nlohmann::ordered_json json = empty_subject();
  if (!raw_.empty()) return json;
  json["station"] = station_;
  if (wanted_.pdu.size() > s7::kRequestHead) json["function"] = wanted_.pdu[s7::kRequestHead];
  if (!wanted_.range) return json;
  json["area"] = info(wanted_.range->area).name;
  json["first"] = wanted_.range->number;
  json["notation"] = wanted_.range->name_of(0);
  json["count"] = wanted_.range->count;
  return json;
}

nlohmann::ordered_json PpiRequest::decoded_json(const serial::Answer& answer) const {
  if (!wanted_.range || wanted_.range->width != Width::Double) return answer.values;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t at = 0; at + 4 <= answer.bytes.size(); at += 4) {
    const std::uint32_t value = load32(&answer.bytes[at]);
    if (wanted_.range->real)
      list.push_back(std::bit_cast<float>(value));
    else
      list.push_back(static_cast<std::int32_t>(value));
  }
  return list;
}

std::uint8_t own_station(const ProtocolUse& use) {
  const auto given = use.given.find(kOwnStation);
  if (given == use.given.end()) return kProgrammingDevice;
  return static_cast<std::uint8_t>(parse_number(given->second, 0, ppi::kLastStation, "the master's station"));
}

class PpiParser final : public WordParser {
 public:
  explicit PpiParser(const ProtocolUse& use) : WordParser(use.station, ppi::kLastStation), own_(own_station(use)) {
    if (use.station > ppi::kLastStation)
      refuse(fmt::format("--station {}: not from 0 to {}", use.station, ppi::kLastStation));
  }

  std::vector<MasterAction> parse(const Words& words);

  void read(const Words& operands);
  void write(const Words& operands);
  void force(const Words& operands);
  void unforce(const Words& operands);
  void run(const Words&) { change_mode(s7::kRun, {0, 0, 0, 0, 0, 0, 0xFD, 0, 0}); }
  void stop(const Words&) { change_mode(s7::kStop, {0, 0, 0, 0, 0}); }
  void clock(const Words&);
  void set_clock(const Words& operands);
  void status(const Words&) { add({Wanted::Kind::Status}); }
  void identification(const Words&);
  void raw(const Words& operands);

 private:
  void add(Wanted wanted) { WordParser::add(std::make_shared<PpiRequest>(station_, own_, std::move(wanted))); }
  void add_clock(std::uint8_t service, const Bytes& data);
  void change_mode(s7::Function function, Bytes parameters);
  void add_forced(Wanted::Kind kind, const MemoryRange& range, const Bytes& value);
  MemoryRange range_of(const std::string& text);

  std::uint8_t own_;
};

using PpiVerb = Verb<PpiParser>;

constexpr std::array kPpiVerbs{
    PpiVerb{"read", "ADDRESS[:COUNT]…", "VB100:4, VW100:2, VD20:real, M31.7, QB0, SMB0, AIW0, T37, C5", 1, kMany,
            &PpiParser::read},
    PpiVerb{"write", "ADDRESS=VALUE,…", "VB100=65,66, VW100=-5, M31.7=1, C5=0", 1, kMany, &PpiParser::write},
    PpiVerb{"force", "ADDRESS=VALUE…", "I0.3=1, Q0.0=1, VB500=9, AIW4=1000: until it is unforced", 1, kMany,
            &PpiParser::force},
    PpiVerb{"unforce", "ADDRESS…", "I0.3, VB500", 1, kMany, &PpiParser::unforce},
    PpiVerb{"run", "", "the CPU goes to RUN", 0, 0, &PpiParser::run},
    PpiVerb{"stop", "", "the CPU goes to STOP", 0, 0, &PpiParser::stop},
    PpiVerb{"clock", "", "its time of day", 0, 0, &PpiParser::clock},
    PpiVerb{"set-clock", "TIME", "2026-11-22T15:45:30", 1, 1, &PpiParser::set_clock},
    PpiVerb{"identification", "", "which CPU it is, and its release", 0, 0, &PpiParser::identification},
    PpiVerb{"status", "", "whether there is a station", 0, 0, &PpiParser::status},
    PpiVerb{"raw", "HEX…", "frames as they are", 1, kMany, &PpiParser::raw},
    PpiVerb{"station", "NUMBER", "the actions after it go to this station", 1, 1, &PpiParser::station},
    PpiVerb{"wait", "TIME", "before the next action", 1, 1, &PpiParser::wait},
};

std::vector<MasterAction> PpiParser::parse(const Words& words) {
  return parse_with(*this, std::span<const PpiVerb>(kPpiVerbs), words, "read VB100:4");
}

/// Parses a range. The CPU is not known: memory that only the largest CPU has may be asked for.
MemoryRange PpiParser::range_of(const std::string& text) {
  static const CpuModel boundless = [] {
    CpuModel model = cpu226();
    model.size.fill(0x20'0000);  // as far as the 24 bits of an address reach
    return model;
  }();
  const auto range = parse_range(text, boundless);
  if (!range) refuse(range.why());
  const std::uint32_t size = cpu226().size_of(range->area), step = is_element(*range) ? 1 : bytes_of(range->width);
  if (range->number + std::uint64_t{range->count} * step > size)
    refuse(fmt::format("'{}' does not exist on any CPU: {} memory has {} {} at most", stl::shortened(text),
                       info(range->area).name, size, is_element(*range) ? "elements" : "bytes"));
  if (s7::code_of(range->area) == 0)
    refuse(fmt::format("'{}': a master cannot reach {}", stl::shortened(text), info(range->area).meaning));
  return *range;
}

void PpiParser::read(const Words& operands) {
  constexpr std::uint32_t kMost = s7::kLongestPdu - s7::kAnswerHead - 2 - 4;  // beside function, number and the value's head
  for (const std::string& operand : operands) {
    text_ = "read " + operand;
    const MemoryRange range = range_of(operand);
    if (range.bytes() > kMost) refuse(fmt::format("{}: {} bytes; a request reads {} at most", text_, range.bytes(), kMost));
    Bytes parameters{s7::kRead, 1};
    append(parameters, variable(range));
    add({Wanted::Kind::Variable, s7::pdu(s7::kRequest, kOnlyRequest, parameters, {}), range});
  }
}

void PpiParser::identification(const Words&) {
  Bytes parameters{s7::kRead, 1};
  s7::append_identification(parameters);
  add({Wanted::Kind::Identification, s7::pdu(s7::kRequest, kOnlyRequest, parameters, {})});
}

/// The bytes of `values`, which are to begin at `range`; its count becomes theirs.
Bytes value_bytes(MemoryRange& range, const std::string& values, const std::string& action) {
  Bytes bytes;
  MemoryRange one = range;
  one.count = 1;
  range.count = 0;
  for (const std::string& text : split_at_commas(values)) {
    const auto assignment = parse_value(one, text);
    if (!assignment) refuse(fmt::format("{}: '{}' is not a value for {}", action, stl::shortened(text), range.name_of(0)));
    std::array<std::uint8_t, 4> value{};
    store32(value.data(), assignment->value);
    bytes.insert(bytes.end(), value.end() - bytes_of(range.width), value.end());
    ++range.count;
  }
  return bytes;
}

/// The values as they stand in the data of a write.
Bytes elements_of(Area area, Data values) {
  Bytes elements;
  for (std::size_t at = 0; at < values.size(); at += info(area).element)
    s7::append_element(elements, area, values.subspan(at, info(area).element), false);
  return elements;
}

/// Whether any of the words is negative.
bool has_negative(Data values) {
  for (std::size_t at = 0; at + 1 < values.size(); at += 2)
    if (values[at] > 0x7F) return true;
  return false;
}

void PpiParser::write(const Words& operands) {
  constexpr std::size_t kMost = s7::kLongestPdu - s7::kRequestHead - 2 - s7::kVariableBytes - 4;
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example VB100=65", stl::shortened(operand)));
    text_ = "write " + operand;
    MemoryRange range = range_of(parts->first);
    Bytes value = value_bytes(range, parts->second, text_);
    if (range.area == Area::T && has_negative(value))  // a CPU may take it, but never counts to it
      refuse(fmt::format("{}: a timer counts from 0 to {}", text_, INT16_MAX));
    if (is_element(range)) value = elements_of(range.area, value);
    if (range.width == Width::Bit && range.count != 1) refuse(fmt::format("{}: one bit at a time", text_));
    if (value.size() > kMost) refuse(fmt::format("{}: {} bytes; a request writes {} at most", text_, value.size(), kMost));
    range_of(range.name_of(range.count - 1));
    Bytes parameters{s7::kWrite, 1};
    append(parameters, variable(range));
    const auto type = range.width == Width::Bit ? s7::kInBits : is_element(range) ? s7::kInBytes : s7::kInBitsOfBytes;
    Bytes data{0, type};
    s7::append16(data, type == s7::kInBitsOfBytes ? value.size() * 8 : value.size());
    data.insert(data.end(), value.begin(), value.end());
    add({Wanted::Kind::Variable, s7::pdu(s7::kRequest, kOnlyRequest, parameters, data), range});
  }
}

/// The value is filled up to an even number of bytes.
void PpiParser::add_forced(Wanted::Kind kind, const MemoryRange& range, const Bytes& value) {
  const bool released = kind == Wanted::Kind::Unforced;
  if (range.count != 1) refuse(fmt::format("{}: one value at a time", text_));
  Bytes place, list{released, 1};
  append(place, variable(range));
  list.insert(list.end(), place.begin() + 2, place.end());
  list.insert(list.end(), value.begin(), value.end());
  if (value.size() % 2 != 0) list.push_back(0);
  const Bytes parameters = s7::parameters_of({.group = s7::kForceGroup, .service = s7::kForce});
  add({kind, s7::pdu(s7::kUserData, kOnlyRequest, parameters, s7::data_of_list(list)), range});
}

void PpiParser::force(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example Q0.0=1", stl::shortened(operand)));
    text_ = "force " + operand;
    MemoryRange range = range_of(parts->first);
    const Bytes value = value_bytes(range, parts->second, text_);
    add_forced(Wanted::Kind::Forced, range, value);
  }
}

void PpiParser::unforce(const Words& operands) {
  for (const std::string& operand : operands) {
    text_ = "unforce " + operand;
    add_forced(Wanted::Kind::Unforced, range_of(operand), {});
  }
}

void PpiParser::change_mode(s7::Function function, Bytes parameters) {
  parameters.insert(parameters.begin(), function);
  parameters.push_back(static_cast<std::uint8_t>(s7::kProgram.size()));
  parameters.insert(parameters.end(), s7::kProgram.begin(), s7::kProgram.end());
  add({Wanted::Kind::Command, s7::pdu(s7::kRequest, kOnlyRequest, parameters, {})});
}

void PpiParser::add_clock(std::uint8_t service, const Bytes& data) {
  add({service == s7::kReadClock ? Wanted::Kind::Clock : Wanted::Kind::Command,
       s7::pdu(s7::kUserData, kOnlyRequest, s7::parameters_of({.group = s7::kClockGroup, .service = service}), data)});
}

void PpiParser::clock(const Words&) { add_clock(s7::kReadClock, {0x0A, 0, 0, 0}); }

void PpiParser::set_clock(const Words& operands) {
  std::string text = operands[0];  // as other tools write it too, with a T before the time
  std::ranges::replace(text, 'T', ' ');
  const auto time = parse_clock(text);
  if (!time) refuse(fmt::format("'{}' is not a time; write for example 2026-11-22T15:45:30", stl::shortened(operands[0])));
  const auto bcd = [](int value) { return static_cast<std::uint8_t>(value / 10 << 4 | value % 10); };
  add_clock(s7::kSetClock, s7::data_of_clock({bcd(time->year), bcd(time->month), bcd(time->day), bcd(time->hour),
                                              bcd(time->minute), bcd(time->second), 0, time->weekday}));
}

void PpiParser::raw(const Words& operands) {
  for (const std::string& operand : operands) {
    serial::Frame frame = parse_hex(operand);
    const std::uint8_t first = frame.front().byte;
    add_raw(operand, first, std::make_shared<PpiRequest>(std::move(frame)));
  }
}

std::string fault_of_own_station(const std::string& text) {
  try {
    parse_number(text, 0, ppi::kLastStation, "the master's station");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

bool is_complete_ppi(Data response) { return !response.empty() && ppi::frame_length(response) == response.size(); }

std::string doubt(const std::vector<MasterAction>& actions, const ProtocolUse& use) {
  const std::uint8_t own = own_station(use);
  const auto asks_its_own = [own](const MasterAction& action) {
    return action.kind == MasterAction::Kind::Request && action.station == own;
  };
  if (std::ranges::none_of(actions, asks_its_own)) return {};
  return fmt::format("station {} is the master's own, too, and on a line each station has another: {} NUMBER", own,
                     kOwnStation);
}

}  // namespace

const Protocol& ppi_protocol() {
  static const Protocol protocol{
      .name = "ppi",
      .meaning = "programming devices and panels: a port that is not in Freeport mode",
      .station = kPpiStation,
      .format = {},
      .over_modbus_tcp = false,
      .options = {{kOwnStation, "NUMBER", "the master's own; a programming device has 0, a panel 1", "0",
                   fault_of_own_station}},
      .actions_help = "Actions of --protocol ppi, to station 2 unless another is given:\n" +
                      verbs_help(std::span<const PpiVerb>(kPpiVerbs)) +
                      "  On the line each but status is two exchanges or more, the request and polls for its answer: "
                      "exchange=2 of a fault is the first poll.\n",
      .action_words = verb_words(std::span<const PpiVerb>(kPpiVerbs)),
      .actions = [](const Words& words, const ProtocolUse& use) { return PpiParser(use).parse(words); },
      .is_complete = is_complete_ppi,
      .doubt = doubt,
      .patience = {.timeout = 150 * kMillisecond, .retries = 2},
      .wants_freeport = false};
  return protocol;
}

}  // namespace s7200::tools
