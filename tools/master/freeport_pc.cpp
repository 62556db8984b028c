// The published Freeport protocol of 33-byte commands between a PC and CPUs 22x.
#include <array>

#include "interpreter/base/text/numbers.hpp"
#include "serial_sim/pc_protocol/answer.hpp"
#include "serial_sim/pc_protocol/command.hpp"
#include "tools/master/words.hpp"
#include "tools/master/written_values.hpp"

namespace s7200::tools {
namespace {

using pc_protocol::Command;
using pc_protocol::Type;
using Data = std::span<const std::uint8_t>;

constexpr std::string_view kEndCharacter = "--end-character";
constexpr std::uint8_t kPcStation = 2;  // of the published program

class PcRequest final : public ProtocolRequest {
 public:
  /// `command` is nothing for a raw frame. `count` is the number of bytes that are wanted of the eight that a read brings.
  PcRequest(serial::Frame frame, std::optional<Command> command, std::size_t count, std::uint8_t end_character)
      : frame_(std::move(frame)), command_(std::move(command)), count_(count), end_character_(end_character) {}

  serial::Frame frame() override { return frame_; }

  serial::Answer judge(Data request, Data response) const override {
    serial::Answer answer = pc_protocol::check_answer(request, response, end_character_);
    if (response.size() == pc_protocol::kAnswerLength && response.back() != end_character_)
      answer.fault += fmt::format("; {} 16#{:02X} would take it", kEndCharacter, response.back());
    if (command_ && command_->type == Type::Read && !answer.bytes.empty())
      answer.values.assign(answer.bytes.begin(), answer.bytes.begin() + static_cast<std::ptrdiff_t>(count_));
    return answer;
  }

  std::string_view error_name(std::uint16_t code) const override { return pc_protocol::refusal_name(code); }

  std::string subject() const override;
  std::string in_short(const serial::Answer& answer, Data request, Data response) const override;
  std::vector<std::string> in_lines(const serial::Answer& answer, Data request, Data response) const override;
  nlohmann::ordered_json subject_json(Data request) const override;
  nlohmann::ordered_json decoded_json(const serial::Answer& answer) const override { return answer.values; }

 private:
  serial::Frame frame_;
  std::optional<Command> command_;
  std::size_t count_;
  std::uint8_t end_character_;
};

/// The name of a range: `VB1000`, `VB1000…1007`
std::string range_text(const pc_protocol::Address& first, std::size_t count) {
  const std::string text = pc_protocol::notation(first);
  return count == 1 ? text : fmt::format("{}…{}", text, first.number + count - 1);
}

std::string PcRequest::subject() const {
  if (!command_) return {};
  return fmt::format("station {}, {}", command_->station, range_text(command_->address, count_));
}

std::string PcRequest::in_short(const serial::Answer& answer, Data, Data) const {
  if (!command_) return answer.bytes.empty() ? "write done" : "read done: " + serial::to_hex(answer.bytes);
  if (command_->type == Type::Write) return range_text(command_->address, count_) + " written";
  std::string text;
  for (const std::uint16_t value : answer.values) text += fmt::format("{}16#{:02X}", text.empty() ? "" : " ", value);
  return text;
}

std::vector<std::string> PcRequest::in_lines(const serial::Answer& answer, Data request, Data response) const {
  if (answer.values.empty()) return {"  " + in_short(answer, request, response)};
  std::vector<std::string> lines;
  pc_protocol::Address address = command_->address;
  for (const std::uint16_t value : answer.values) {
    lines.push_back(fmt::format("{:>8}  16#{:02X} {:>6}", pc_protocol::notation(address), value, value));
    ++address.number;
  }
  return lines;
}

nlohmann::ordered_json PcRequest::subject_json(Data) const {
  nlohmann::ordered_json json = empty_subject();
  if (!command_) return json;
  json["station"] = command_->station;
  json["function"] = command_->type;
  json["area"] = pc_protocol::area_name(command_->address.area);
  json["first"] = command_->address.number;
  json["notation"] = pc_protocol::notation(command_->address);
  json["count"] = count_;
  return json;
}

/// Parses the end character. Throws std::invalid_argument.
std::uint8_t end_character(const std::string& text) {
  return static_cast<std::uint8_t>(parse_number(text, 0, UINT8_MAX, "the end character"));
}

class FreeportPcParser final : public WordParser {
 public:
  explicit FreeportPcParser(const ProtocolUse& use) : WordParser(use.station, UINT8_MAX) {
    if (const auto given = use.given.find(kEndCharacter); given != use.given.end())
      end_character_ = end_character(given->second);
  }

  std::vector<MasterAction> parse(const Words& words);

  void read(const Words& operands);
  void write(const Words& operands);
  void raw(const Words& operands);

 private:
  /// Adds a command with `data` for `count` bytes from `address` on.
  void add(Type type, const std::string& address, std::size_t count, Bytes data);

  std::uint8_t end_character_ = pc_protocol::kEndCharacter;
};

using PcVerb = Verb<FreeportPcParser>;

constexpr std::array kFreeportPcVerbs{
    PcVerb{"read", "ADDRESS[:COUNT]…", "1 to 8 bytes: VB100:4, MB8, IB0, QB0", 1, kMany, &FreeportPcParser::read},
    PcVerb{"write", "ADDRESS=VALUE,…", "1 to 8 bytes: 65, -5, 16#41, 2#1010", 1, kMany, &FreeportPcParser::write},
    PcVerb{"raw", "HEX…", "frames as they are", 1, kMany, &FreeportPcParser::raw},
    PcVerb{"station", "NUMBER", "the actions after it go to this station", 1, 1, &FreeportPcParser::station},
    PcVerb{"wait", "TIME", "before the next action", 1, 1, &FreeportPcParser::wait},
};

std::vector<MasterAction> FreeportPcParser::parse(const Words& words) {
  return parse_with(*this, std::span<const PcVerb>(kFreeportPcVerbs), words, "read VB100:4");
}

void FreeportPcParser::add(Type type, const std::string& address, std::size_t count, Bytes data) {
  const auto first = pc_protocol::parse_address(address);
  if (!first) refuse(first.why());
  if (first->number + count - 1 > UINT16_MAX) refuse(fmt::format("{}: the bytes run past {}", text_, UINT16_MAX));
  Command command{type, station_, *first, std::move(data)};
  serial::Frame frame = serial::to_frame(pc_protocol::to_bytes(command));
  WordParser::add(std::make_shared<PcRequest>(std::move(frame), std::move(command), count, end_character_));
}

void FreeportPcParser::read(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, ':');
    text_ = "read " + operand;
    const auto count = parts ? parse_number(parts->second, 1, pc_protocol::kMostBytes, "count") : 1;
    add(Type::Read, parts ? parts->first : operand, static_cast<std::size_t>(count), {});
  }
}

void FreeportPcParser::write(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example VB100=65", stl::shortened(operand)));
    text_ = "write " + operand;
    Bytes data = byte_values_of(parts->second);
    if (data.size() > pc_protocol::kMostBytes)
      refuse(fmt::format("{}: {} bytes; a command writes {} at most", text_, data.size(), pc_protocol::kMostBytes));
    const std::size_t count = data.size();
    add(Type::Write, parts->first, count, std::move(data));
  }
}

void FreeportPcParser::raw(const Words& operands) {
  for (const std::string& operand : operands) {
    serial::Frame frame = parse_hex(operand);
    const std::uint8_t first = frame.front().byte;
    add_raw(operand, first, std::make_shared<PcRequest>(std::move(frame), std::nullopt, 0, end_character_));
  }
}

std::string fault_of_end_character(const std::string& text) {
  try {
    end_character(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

}  // namespace

const Protocol& freeport_pc_protocol() {
  static const Protocol protocol{
      .name = "freeport-pc",
      .meaning = "33-byte commands of a PC to a Freeport program of a CPU 22x",
      .station = kPcStation,
      .format = {.parity = Parity::None},
      .over_modbus_tcp = false,
      .options = {{kEndCharacter, "BYTE", "character that ends an answer; the published program sends 26", "16#26",
                   fault_of_end_character}},
      .actions_help = "Actions of --protocol freeport-pc, to station 2 unless another is given:\n" +
                      verbs_help(std::span<const PcVerb>(kFreeportPcVerbs)),
      .action_words = verb_words(std::span<const PcVerb>(kFreeportPcVerbs)),
      .actions = [](const Words& words, const ProtocolUse& use) { return FreeportPcParser(use).parse(words); },
      .is_complete = [](Data response) { return response.size() == pc_protocol::kAnswerLength; }};
  return protocol;
}

}  // namespace s7200::tools
