#include "tools/master/block_request.hpp"

#include "tools/master/written_values.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr std::size_t kMostWords = westinghouse::kMostBlockBytes / 2;

constexpr std::string_view kDataCheck = "--data-check";

DataCheck data_check_of(const ProtocolUse& use) {
  return static_cast<DataCheck>(use.chosen(kDataCheck, westinghouse::kDataCheckWords));
}

std::uint16_t word_address(const std::string& text) {
  return static_cast<std::uint16_t>(parse_number(text, 0, UINT16_MAX, "address"));
}

/// The name of a block of words: `words 16#1234…1235`
std::string words_text(std::uint16_t first, std::size_t count) {
  if (count == 1) return fmt::format("word 16#{:04X}", first);
  return fmt::format("words 16#{:04X}…{:04X}", first, first + count - 1);
}

void check_range(const std::string& text, std::uint16_t first, std::size_t count) {
  if (count > kMostWords) refuse(fmt::format("{}: {} words; a block has {} at most", text, count, kMostWords));
  if (first + count - 1 > UINT16_MAX) refuse(fmt::format("{}: the words run past 16#FFFF", text));
}

}  // namespace

ProtocolOption data_check_option() {
  return word_option(kDataCheck, "FORM",
                     fmt::format("of a block of data: {}", fmt::join(westinghouse::kDataCheckWords, ", ")),
                     "a check of a block", westinghouse::kDataCheckWords);
}

serial::Answer BlockRequest::judge(Data request, Data response) const {
  serial::Answer answer = westinghouse::check_block_answer(request, response, about_.check);
  const bool reads = about_.first && about_.done.empty();
  if (answer.verdict != serial::Verdict::Right || !reads) return answer;
  for (std::size_t i = 0; i + 1 < answer.bytes.size(); i += 2)
    answer.values.push_back(static_cast<std::uint16_t>(answer.bytes[i] | answer.bytes[i + 1] << 8));
  return answer;
}

std::string_view BlockRequest::error_name(std::uint16_t code) const { return westinghouse::highway_error_name(code); }

std::string BlockRequest::in_short(const serial::Answer& answer, Data request, Data) const {
  std::string text;
  for (const std::uint16_t value : answer.values) text += fmt::format("{}16#{:04X}", text.empty() ? "" : " ", value);
  if (!text.empty()) return text;
  if (!about_.done.empty()) return about_.done;
  if (request[0] == static_cast<std::uint8_t>(westinghouse::Opcode::SetUnitAddress))
    return westinghouse::unit_text(answer.bytes);
  if (request[0] == static_cast<std::uint8_t>(westinghouse::Opcode::Highway))
    return westinghouse::highway_text(request, answer.bytes);
  return answer.bytes.empty() ? "done" : serial::to_hex(answer.bytes);
}

std::vector<std::string> BlockRequest::in_lines(const serial::Answer& answer, Data request, Data response) const {
  if (answer.values.empty()) return {"  " + in_short(answer, request, response)};
  std::vector<std::string> lines;
  std::uint16_t address = *about_.first;
  for (const std::uint16_t value : answer.values)
    lines.push_back(fmt::format("  16#{:04X}  16#{:04X} {:>6}", address++, value, value));
  return lines;
}

nlohmann::ordered_json BlockRequest::subject_json(Data request) const {
  nlohmann::ordered_json json = empty_subject();
  if (about_.raw) return json;
  json["function"] = request[0];
  if (request[0] == static_cast<std::uint8_t>(westinghouse::Opcode::SetUnitAddress)) json["station"] = request[1];
  if (!about_.first) return json;
  json["area"] = "words";
  json["first"] = *about_.first;
  json["notation"] = fmt::format("16#{:04X}", *about_.first);
  json["count"] = about_.count;
  return json;
}

BlockParser::BlockParser(const ProtocolUse& use, bool sync)
    : WordParser(use.station, UINT8_MAX), sync_(sync), check_(data_check_of(use)) {}

void BlockParser::add(const Bytes& message, BlockRequest::About about) {
  about.sync = sync_;
  about.check = check_;
  WordParser::add(std::make_shared<BlockRequest>(message, std::move(about)));
}

void BlockParser::read(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, ':');
    text_ = "read " + operand;
    const std::uint16_t first = word_address(parts ? parts->first : operand);
    const auto count =
        parts ? static_cast<std::size_t>(parse_number(parts->second, 1, UINT16_MAX, "count")) : std::size_t{1};
    check_range(text_, first, count);
    add(westinghouse::read_block(first, 2 * count), {.subject = words_text(first, count), .first = first, .count = count});
  }
}

void BlockParser::write(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example 16#1234=5", stl::shortened(operand)));
    text_ = "write " + operand;
    const std::uint16_t first = word_address(parts->first);
    Bytes data;
    for (const std::int64_t value : values_of(parts->second, INT16_MIN, UINT16_MAX)) {
      data.push_back(static_cast<std::uint8_t>(value & 0xFF));
      data.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
    }
    const std::size_t count = data.size() / 2;
    check_range(text_, first, count);
    const std::string subject = words_text(first, count);
    add(westinghouse::write_block(first, data, check_),
        {.subject = subject, .first = first, .count = count, .done = subject + " written"});
  }
}

void BlockParser::write_bits(const Words& operands, bool on) {
  constexpr int kLastBit = 15;
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, '.');
    if (!parts) refuse(fmt::format("'{}': a bit is missing; write for example 16#1234.5", stl::shortened(operand)));
    text_ = fmt::format("{} {}", on ? "set" : "reset", operand);
    const std::uint16_t address = word_address(parts->first);
    const auto bit = static_cast<std::uint8_t>(parse_number(parts->second, 0, kLastBit, "bit"));
    add(westinghouse::write_bit(address, bit, on), {.subject = fmt::format("bit {} of word 16#{:04X}", bit, address),
                                                    .first = address,
                                                    .count = 1,
                                                    .done = on ? "bit set" : "bit reset"});
  }
}

void BlockParser::retest(const Words&) { add(westinghouse::retest(), {.done = "retest accepted"}); }

void BlockParser::raw(const Words& operands) {
  for (const std::string& operand : operands) {
    serial::Frame frame = parse_hex(operand);
    const std::uint8_t first = frame.front().byte;
    add_raw(
        operand, first,
        std::make_shared<BlockRequest>(std::move(frame), BlockRequest::About{.raw = true, .sync = sync_, .check = check_}));
  }
}

}  // namespace s7200::tools
