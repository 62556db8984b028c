#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <map>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/base/result.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "interpreter/program/operands/address.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/peers/answer.hpp"
#include "tools/recordings/readers.hpp"
#include "tools/views/state/ppi_text.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

// --- variables and values ---

/// The width of the units in which a variable's count counts; nothing for a type that the S7-200 does not have.
std::optional<Width> width_of(std::uint8_t type, const AreaInfo& area) {
  if (area.element != 0) {
    if (type != s7::code_of(area.area)) return {};
    return area.element == bytes_of(Width::Double) ? Width::Double : Width::Word;
  }
  return s7::width_of(type);
}

/// A variable that a request reads or writes.
struct Variable {
  std::optional<MemoryRange> range{};  ///< nothing for an area or a type that is not known
  std::string name{};                  ///< `VW100:3`, `V100.7`, `T37`, as for `master --protocol ppi`
  bool identification = false;         ///< the CPU's identification, all of it
};

std::string name_of(const MemoryRange& range) {
  return range.name_of(0) + (range.count == 1 ? "" : fmt::format(":{}", range.count)) + (range.real ? ":real" : "");
}

Variable variable_of(const s7::WireVariable& wire_variable) {
  const auto& [type, wire_area, count, block, address] = wire_variable;
  if (wire_area == s7::kSystemInformation && type == s7::kByte && count == s7::kIdentificationBytes && address == 0)
    return {.name = "identification", .identification = true};
  const auto wire = std::ranges::find(s7::kWireAreas, wire_area, &s7::WireArea::code);
  if (wire == s7::kWireAreas.end()) return {.name = fmt::format("area 16#{:02X} byte {}:{}", wire_area, address / 8, count)};
  const AreaInfo& area = info(wire->area);
  const auto width = width_of(type, area);
  if (!width) return {.name = fmt::format("{} byte {}:{} of type 16#{:02X}", area.name, address / 8, count, type)};
  MemoryRange range{.area = area.area, .width = *width, .count = count, .real = type == s7::kReal};
  range.number = area.element != 0 ? address : address / 8;
  range.bit = *width == Width::Bit ? static_cast<std::uint8_t>(address % 8) : std::uint8_t{0};
  return {.range = range, .name = name_of(range)};
}

std::vector<Variable> variables_in(Data parameters) {
  std::vector<Variable> variables;
  for (std::size_t at = 2; at + s7::kVariableBytes <= parameters.size(); at += s7::kVariableBytes)
    variables.push_back(variable_of(s7::variable_at(parameters.subspan(at, s7::kVariableBytes))));
  return variables;
}

/// A value in the data of a write, or of the answer to a read.
struct Value {
  std::uint8_t code = 0;
  Data bytes{};
};

std::vector<Value> values_in(Data data) {
  constexpr std::size_t kHead = 4;
  std::vector<Value> values;
  for (std::size_t at = 0; at + kHead <= data.size();) {
    const std::size_t bytes = s7::data_bytes(data[at + 1], load16(&data[at + 2]));
    const Data rest = data.subspan(at + kHead);
    values.push_back({data[at], rest.first(std::min(bytes, rest.size()))});
    at += kHead + bytes + bytes % 2;
  }
  return values;
}

std::string element_text(const MemoryRange& range, const std::uint8_t* at) {
  switch (range.width) {
    case Width::Bit:
      return fmt::format("{}", *at & 1);
    case Width::Byte:
      return fmt::format("16#{:02X}", *at);
    case Width::Word:
      return fmt::format("16#{:04X}", load16(at));
    case Width::Double:
      return range.real ? fmt::format("{}", std::bit_cast<float>(load32(at))) : fmt::format("16#{:08X}", load32(at));
  }
  return {};
}

/// A value as text: `VW100:2 = 16#04D2 16#FFFB`
std::string value_text(const Variable& variable, Data bytes) {
  if (variable.identification) return fmt::format("{} = {}", variable.name, s7_identification_text(bytes));
  if (!variable.range) return fmt::format("{} = {}", variable.name, serial::to_hex(bytes));
  const Area area = variable.range->area;
  const Bytes elements = info(area).element != 0 ? s7::element_values(area, bytes) : Bytes{};
  if (info(area).element != 0) bytes = elements;
  std::string text = variable.name + " =";
  const std::size_t step = bytes_of(variable.range->width);
  for (std::size_t at = 0; at + step <= bytes.size(); at += step) text += " " + element_text(*variable.range, &bytes[at]);
  return text;
}

// --- requests and answers ---

/// The data unit of a frame, taken apart.
struct Pdu {
  std::uint8_t kind = 0;
  std::uint16_t number = 0;
  std::uint16_t error = 0;
  Data parameters{}, data{};

  std::uint8_t function() const { return parameters.empty() ? std::uint8_t{0} : parameters[0]; }
};

/// Trouble if its lengths are wrong.
Result<Pdu> pdu_of(Data bytes) {
  if (bytes.size() < s7::kRequestHead || bytes[0] != s7::kProtocol)
    return trouble("{} bytes that are not of S7", bytes.size());
  Pdu pdu{.kind = bytes[1], .number = load16(&bytes[4])};
  const bool answer = pdu.kind == s7::kAnswer;
  const std::size_t head = answer ? s7::kAnswerHead : s7::kRequestHead, parameters = load16(&bytes[6]);
  if (bytes.size() < head) return Trouble{"an answer without its error code"};
  if (bytes.size() != head + parameters + load16(&bytes[8])) return Trouble{"its lengths do not fit what it carries"};
  if (answer) pdu.error = load16(&bytes[10]);
  pdu.parameters = bytes.subspan(head, parameters);
  pdu.data = bytes.subspan(head + parameters);
  return pdu;
}

std::string error_text(std::uint16_t error) { return serial::error_text(error, s7_error_name(error)); }

/// Forced values as text, or only the places of released values: `Q0.0 = 1, VB500 = 16#09`
std::string forced_text(const s7::ForcedList& list) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < list.variables.size(); ++i) {
    const Variable variable = variable_of(list.variables[i]);
    texts.push_back(list.released ? variable.name : value_text(variable, list.values[i]));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// The result for each variable that was to be forced.
std::string forced_answer_text(Data data) {
  const auto codes = s7::list_in(data);
  if (!codes || codes->size() < 3) return "user data";
  std::vector<std::string> texts;
  for (const std::uint8_t code : codes->subspan(2)) texts.push_back(code == s7::kDone ? "done" : error_text(code));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string force_text(const Pdu& pdu, std::uint8_t service, bool answer) {
  if (answer) return forced_answer_text(pdu.data);
  const bool in_stop = service == s7::kSetInStop;
  const auto list = s7::forced_in(pdu.data, in_stop ? s7::kValueHead : 0);
  const std::string_view verb = in_stop ? "set in STOP" : list && list->released ? "unforce" : "force";
  return list ? fmt::format("{} {}", verb, forced_text(*list)) : fmt::format("{}, incomplete", verb);
}

/// Type and number of each entry: `1 OB, 1 DB`, or of one type its numbers: `1, 2`.
std::string blocks_text(Data entries, bool numbers) {
  constexpr std::size_t kEntry = 4;
  std::vector<std::string> texts;
  for (; entries.size() >= kEntry; entries = entries.subspan(kEntry)) {
    if (numbers)
      texts.push_back(fmt::format("{}", load16(&entries[0])));
    else if (const std::uint16_t count = load16(&entries[2]); count != 0)
      texts.push_back(fmt::format("{} {}", count, s7::name_of_blocks(entries[1])));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string block_text(const Pdu& pdu, std::uint8_t service, bool answer) {
  const Data list = s7::list_in(pdu.data).value_or(Data{});
  switch (service) {
    case s7::kListBlocks:
      return answer ? "blocks: " + blocks_text(list, false) : "how many blocks?";
    case s7::kListBlocksOfType:
      if (answer) return "blocks: " + blocks_text(list, true);
      return fmt::format("which {}?", list.size() < 2 ? "blocks" : s7::name_of_blocks(list[1]));
    case s7::kBlockInfo: {
      constexpr std::size_t kLength = 40;
      if (!answer) return s7_block_text(list) + "?";
      return list.size() < kLength + 2 ? "block" : fmt::format("block of {} bytes", load16(&list[kLength]));
    }
    default:
      return fmt::format("user data, group {}, service {}", s7::kBlockGroup, service);
  }
}

std::string user_data_text(const Pdu& pdu) {
  const auto user_data = s7::user_data_in(pdu.parameters);
  if (!user_data) return "user data";
  const auto& [group, service, number, answer, error] = *user_data;
  if (error != 0) return error_text(error);
  if (group == s7::kBlockGroup) return block_text(pdu, service, answer);
  if (group == s7::kForceGroup && (service == s7::kForce || service == s7::kSetInStop))
    return force_text(pdu, service, answer);
  const std::string clock = s7_clock_text(pdu.data);
  if (group == s7::kClockGroup && service == s7::kReadClock) return answer ? "clock: " + clock : "read the clock";
  if (group == s7::kClockGroup && service == s7::kSetClock) return answer ? "clock set" : "set the clock to " + clock;
  return fmt::format("user data, group {}, service {}", group, service);
}

std::string set_up_text(const Pdu& pdu) {
  constexpr std::size_t kLongest = 6;
  if (pdu.parameters.size() < kLongest + 2) return "set up";
  return fmt::format("set up: {} bytes at once", load16(&pdu.parameters[kLongest]));
}

std::string write_text(const Pdu& pdu, const std::vector<Variable>& variables) {
  const std::vector<Value> values = values_in(pdu.data);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < variables.size(); ++i)
    texts.push_back(i < values.size() ? value_text(variables[i], values[i].bytes) : variables[i].name);
  return fmt::format("write {}", fmt::join(texts, ", "));
}

std::string request_text(const Pdu& pdu) {
  if (pdu.kind == s7::kUserData) return user_data_text(pdu);
  if (pdu.parameters.empty()) return "an empty request";
  const std::vector<Variable> variables = variables_in(pdu.parameters);
  std::vector<std::string> names;
  for (const Variable& variable : variables) names.push_back(variable.name);
  switch (pdu.function()) {
    case s7::kRead:
      return fmt::format("read {}", fmt::join(names, ", "));
    case s7::kWrite:
      return write_text(pdu, variables);
    case s7::kStartUpload:
      return fmt::format("start the upload of {}", s7_block_text(s7::name_to_upload(pdu.parameters).value_or(Data{})));
    case s7::kUpload:
      return "next part of the block";
    case s7::kEndUpload:
      return "end the upload";
    case s7::kRun:
      return "go to RUN";
    case s7::kStop:
      return "go to STOP";
    case s7::kSetup:
      return set_up_text(pdu);
    default:
      return fmt::format("function {:02X}", pdu.function());
  }
}

std::string read_answer_text(const Pdu& pdu, const std::vector<Variable>& variables) {
  const std::vector<Value> values = values_in(pdu.data);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Variable variable = i < variables.size() ? variables[i] : Variable{.name = "read"};
    texts.push_back(values[i].code == s7::kDone ? value_text(variable, values[i].bytes)
                                                : fmt::format("{}: {}", variable.name, error_text(values[i].code)));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string write_answer_text(const Pdu& pdu, const std::vector<Variable>& variables) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < pdu.data.size(); ++i) {
    const std::string name = i < variables.size() ? variables[i].name + (pdu.data[i] == s7::kDone ? "" : ":") : "";
    texts.push_back(fmt::format("{}{}{}", name, name.empty() ? "" : " ",
                                pdu.data[i] == s7::kDone ? "written" : error_text(pdu.data[i])));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// An answer as text. `variables` are those of the request; none if the request was not heard.
std::string answer_text(const Pdu& pdu, const std::vector<Variable>& variables) {
  if (pdu.kind == s7::kUserData) return user_data_text(pdu);
  if (pdu.error != 0) return error_text(pdu.error);
  switch (pdu.function()) {
    case s7::kRead:
      return read_answer_text(pdu, variables);
    case s7::kWrite:
      return write_answer_text(pdu, variables);
    case s7::kStartUpload:
      return "upload started";
    case s7::kUpload:
      return fmt::format("part of the block{}", pdu.parameters.size() > 1 && pdu.parameters[1] != 0 ? ", more follows" : "");
    case s7::kEndUpload:
      return "upload ended";
    case s7::kRun:
      return "goes to RUN";
    case s7::kStop:
      return "goes to STOP";
    case s7::kSetup:
      return set_up_text(pdu);
    default:
      return fmt::format("function {:02X}: done", pdu.function());
  }
}

/// The name of a frame without data.
std::string_view function_text(std::uint8_t function) {
  if ((function & ppi::kIsRequest) == 0) {
    switch (function) {
      case ppi::kSlave:
        return "a slave";
      case ppi::kNoResource:
        return "no resource";
      case ppi::kNoService:
        return "no such service";
      default:
        return "no data";
    }
  }
  switch (function & ppi::kService) {
    case ppi::kStatus:
      return "status?";
    case ppi::kAnswerLow:
    case ppi::kAnswerHigh:
      return "poll";
    default:
      return "a service that is not known";
  }
}

/// An answer comes with a later frame than its request, and says nothing of its variables.
class PpiReader final : public FrameReader {
 public:
  ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) override {
    const Data bytes(frame.bytes);
    ReadFrame read;
    if (bytes.size() == 1 && bytes[0] == ppi::kAccepted) {
      read.direction = open != nullptr ? Direction::Answer : Direction::Unknown;
      read.right = open == nullptr || !asks_for_status(open->bytes);
      read.puts_off = open != nullptr && polls(open->bytes);
      read.text = read.puts_off ? "no answer yet" : "accepted";
      if (!read.right) read.text += ": a station answers a request for its status with its state";
      return read;
    }
    if (const auto token = ppi::token_of(bytes)) {
      read.direction = Direction::Request;
      read.right = read.needs_no_answer = true;
      read.station = token->destination;
      read.text = fmt::format("token from station {} to station {}", token->source, token->destination);
      return read;
    }
    const auto body = ppi::frame_length(bytes) == bytes.size() ? ppi::body_of(bytes) : std::nullopt;
    if (!body) {
      read.text = "not a frame: its length, check sum or end is wrong";
      return read;
    }
    const bool request = (body->function & ppi::kIsRequest) != 0;
    read.direction = request ? Direction::Request : open != nullptr ? Direction::Answer : Direction::Unknown;
    if (request) read.station = body->destination;
    read.needs_no_answer = request && body->destination == ppi::kEveryStation;
    std::string wrong = read.direction == Direction::Answer ? why_not_the_answer(*body, open->bytes) : "";
    const std::string text =
        body->data.empty() ? std::string(function_text(body->function)) : text_of(*body, request, wrong);
    read.right = wrong.empty();
    read.text = fmt::format("{} to {}, function {:02X}: {}", body->source, body->destination, body->function,
                            wrong.empty() ? text : wrong);
    return read;
  }

  bool may_be_echoed(const RecordedFrame&) const override { return false; }

  std::size_t first_message(Data bytes, const RecordedFrame*) const override {
    const auto length = ppi::frame_length(bytes);
    return length && *length <= bytes.size() ? *length : 0;
  }

  bool announces_more(Data bytes, Direction, const RecordedFrame*) const override {
    return !bytes.empty() && ppi::frame_length(bytes).value_or(bytes.size() + 1) > bytes.size();
  }

 private:
  /// The last request of a master to a station, which waits to be fetched.
  struct Job {
    std::uint16_t number = 0;
    std::vector<Variable> variables{};
  };

  static bool polls(Data frame) {
    const auto body = ppi::body_of(frame);
    return body && body->data.empty() && !asks_for_status(frame);
  }

  static bool asks_for_status(Data frame) {
    const auto body = ppi::body_of(frame);
    return body && (body->function & ppi::kIsRequest) != 0 && (body->function & ppi::kService) == ppi::kStatus;
  }

  /// Empty if a frame may be the answer to a request. EN 50170: the station that is asked answers, a request for its status
  /// with a frame without data.
  static std::string why_not_the_answer(const ppi::Body& answer, Data request) {
    const auto asked = ppi::body_of(request);
    if (!asked) return {};
    const auto station = [](std::uint8_t address) { return static_cast<std::uint8_t>(address & ~ppi::kExtension); };
    if (station(answer.source) != station(asked->destination))
      return fmt::format("answer of station {}, not {}", station(answer.source), station(asked->destination));
    return asks_for_status(request) && !answer.data.empty()
               ? "data: a station answers a request for its status with its state"
               : "";
  }

  std::string text_of(const ppi::Body& body, bool request, std::string& wrong) {
    const auto pdu = pdu_of(body.data);
    if (!pdu) return wrong = pdu.why(), "";
    if (request) {
      const bool names = pdu->kind == s7::kRequest && (pdu->function() == s7::kRead || pdu->function() == s7::kWrite);
      jobs_[{body.destination, body.source}] = {pdu->number,
                                                names ? variables_in(pdu->parameters) : std::vector<Variable>{}};
      return request_text(*pdu);
    }
    const auto job = jobs_.find({body.source, body.destination});
    const bool known = job != jobs_.end() && job->second.number == pdu->number;
    return answer_text(*pdu, known ? job->second.variables : std::vector<Variable>{});
  }

  std::map<std::pair<std::uint8_t, std::uint8_t>, Job> jobs_;  // by station and master
};

}  // namespace

std::unique_ptr<FrameReader> ppi_reader(const ChosenWords&) { return std::make_unique<PpiReader>(); }

}  // namespace s7200::tools
