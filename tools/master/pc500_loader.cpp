// The loader port of PC500 and PC2000: an operation is a session of several steps.
#include <array>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/westinghouse/loader_session.hpp"
#include "tools/master/words.hpp"
#include "tools/master/written_values.hpp"

namespace s7200::tools {
namespace {

using westinghouse::Dle;
using westinghouse::kDleWords;
using westinghouse::kFirstBlockWords;
using westinghouse::LoaderOpcode;
using westinghouse::LoaderOperation;
using Data = std::span<const std::uint8_t>;

constexpr std::string_view kDle = "--dle", kDirectory = "--directory";

/// A memory area whose bytes have names beside their addresses.
struct LoaderArea {
  std::string_view name;
  std::uint16_t first, count;
};
constexpr std::array kLoaderAreas{LoaderArea{"IB", 0xEF00, 0x80}, LoaderArea{"QB", 0xEF80, 0x80},
                                  LoaderArea{"FY", 0xEE00, 0x80}};

constexpr std::array<std::string_view, 8> kPointers{"PII",      "PIQ",         "flags",   "timers",
                                                    "counters", "system data", "release", "program end"};

/// The places of a block's number and of its length in its header, and the header's words, which the length counts.
constexpr std::size_t kBlockNumber = 6, kBlockLength = 11, kBlockHeader = 5;

class LoaderRequest final : public ProtocolRequest {
 public:
  struct About {
    std::string subject{};
    std::uint16_t first = 0;  ///< address of bytes that are read or written
    std::size_t count = 0;
    std::size_t first_block = 0;  ///< of a directory: the number of its first block
  };

  LoaderRequest(LoaderOperation operation, Dle dle, About about)
      : steps_(std::move(operation), dle), about_(std::move(about)) {}

  serial::Frame frame() override { return serial::to_frame(steps_.first()); }
  std::optional<serial::Frame> next(Data response, Time) override {
    const auto bytes = steps_.next(response);
    return bytes ? std::optional(serial::to_frame(*bytes)) : std::nullopt;
  }
  bool answered() const override { return steps_.answered(); }
  serial::Answer judge(Data request, Data response) const override;
  std::string_view error_name(std::uint16_t) const override { return westinghouse::kRefusalName; }
  std::string subject() const override { return about_.subject; }
  std::string in_short(const serial::Answer& answer, Data request, Data response) const override;
  std::vector<std::string> in_lines(const serial::Answer& answer, Data request, Data response) const override;
  nlohmann::ordered_json subject_json(Data request) const override;
  nlohmann::ordered_json decoded_json(const serial::Answer& answer) const override { return answer.values; }

 private:
  LoaderOpcode opcode() const { return steps_.operation().opcode; }
  std::vector<std::string> texts(const serial::Answer& answer) const;

  westinghouse::LoaderSteps steps_;
  About about_;
};

/// A request that sends one raw step of a session.
class RawStep final : public ProtocolRequest {
 public:
  explicit RawStep(serial::Frame frame) : frame_(std::move(frame)) {}

  serial::Frame frame() override { return frame_; }
  serial::Answer judge(Data, Data response) const override {
    serial::Answer answer;
    if (response.empty()) return answer;
    answer.verdict = serial::Verdict::Right;
    answer.bytes.assign(response.begin(), response.end());
    return answer;
  }
  std::string_view error_name(std::uint16_t) const override { return {}; }
  std::string subject() const override { return {}; }
  std::string in_short(const serial::Answer& answer, Data, Data) const override { return serial::to_hex(answer.bytes); }
  std::vector<std::string> in_lines(const serial::Answer& answer, Data request, Data response) const override {
    return {"  " + in_short(answer, request, response)};
  }
  nlohmann::ordered_json subject_json(Data) const override { return empty_subject(); }
  nlohmann::ordered_json decoded_json(const serial::Answer& answer) const override { return answer.values; }

 private:
  serial::Frame frame_;
};

serial::Answer LoaderRequest::judge(Data, Data response) const {
  serial::Answer answer = steps_.judge(response);
  if (answer.verdict != serial::Verdict::Right) return answer;
  if (opcode() == LoaderOpcode::Block && load16(&answer.bytes[kBlockLength]) < kBlockHeader) {
    answer.verdict = serial::Verdict::Wrong;
    answer.fault =
        fmt::format("a block of {} words: its header alone has {}", load16(&answer.bytes[kBlockLength]), kBlockHeader);
    return answer;
  }
  if (opcode() == LoaderOpcode::Read) {
    answer.bytes.erase(answer.bytes.begin(), answer.bytes.begin() + westinghouse::kReadHead);
    answer.values.assign(answer.bytes.begin(), answer.bytes.end());
  }
  return answer;
}

std::vector<std::string> LoaderRequest::texts(const serial::Answer& answer) const {
  std::vector<std::string> texts;
  const Data bytes = answer.bytes;
  switch (opcode()) {
    case LoaderOpcode::Write:
      return {about_.subject + " written"};
    case LoaderOpcode::Read:
      for (std::size_t i = 0; i < answer.values.size(); ++i)
        texts.push_back(fmt::format("16#{:04X}  16#{:02X} {:>6}", about_.first + i, answer.values[i], answer.values[i]));
      return texts;
    case LoaderOpcode::Pointers:
      for (std::size_t i = 0; i < kPointers.size(); ++i)
        texts.push_back(fmt::format("{:<12} 16#{:04X}", kPointers[i], load16(&bytes[westinghouse::kReadHead + 2 * i])));
      if (const Data more = bytes.subspan(westinghouse::kReadHead + 2 * kPointers.size()); !more.empty())
        texts.push_back(fmt::format("{:<12} {}", "more", serial::to_hex(more)));
      return texts;
    case LoaderOpcode::Block:
      return {fmt::format("DB{:03} at 16#{:04X}, {} data words", bytes[kBlockNumber], load16(&bytes[1]),
                          load16(&bytes[kBlockLength]) - kBlockHeader)};
    case LoaderOpcode::Directory:
      for (std::size_t block = 0; 2 * block + 2 < bytes.size(); ++block)
        if (const std::uint16_t address = load16(&bytes[1 + 2 * block]); address != 0)
          texts.push_back(fmt::format("DB{:03} at 16#{:04X}", about_.first_block + block, address));
      if (texts.empty()) texts.emplace_back("no data blocks");
      return texts;
  }
  return texts;
}

std::string LoaderRequest::in_short(const serial::Answer& answer, Data, Data) const {
  if (answer.values.empty()) return fmt::format("{}", fmt::join(texts(answer), ", "));
  std::string text;
  for (const std::uint16_t value : answer.values) text += fmt::format("{}16#{:02X}", text.empty() ? "" : " ", value);
  return text;
}

std::vector<std::string> LoaderRequest::in_lines(const serial::Answer& answer, Data, Data) const {
  std::vector<std::string> lines;
  for (const std::string& text : texts(answer)) lines.push_back("  " + text);
  return lines;
}

nlohmann::ordered_json LoaderRequest::subject_json(Data) const {
  nlohmann::ordered_json json = empty_subject();
  json["function"] = static_cast<int>(opcode());
  if (about_.count == 0) return json;
  json["area"] = "bytes";
  json["first"] = about_.first;
  json["notation"] = fmt::format("16#{:04X}", about_.first);
  json["count"] = about_.count;
  return json;
}

Dle dle_of(const ProtocolUse& use) { return static_cast<Dle>(use.chosen(kDle, kDleWords)); }

/// Parses an address: `QB3`, `16#EF83`
std::uint16_t loader_address(const std::string& text) {
  const std::string upper = stl::upper_case(text);
  for (const LoaderArea& area : kLoaderAreas)
    if (upper.starts_with(area.name))
      return static_cast<std::uint16_t>(area.first + parse_number(upper.substr(area.name.size()), 0, area.count - 1,
                                                                  fmt::format("byte of {}", area.name)));
  return static_cast<std::uint16_t>(parse_number(text, 0, UINT16_MAX, "address"));
}

class Pc500Parser final : public WordParser {
 public:
  explicit Pc500Parser(const ProtocolUse& use)
      : WordParser(use.station, UINT8_MAX), dle_(dle_of(use)), first_block_(use.chosen(kDirectory, kFirstBlockWords)) {}

  std::vector<MasterAction> parse(const Words& words);

  void read(const Words& operands);
  void write(const Words& operands);
  void pointers(const Words&) { add(westinghouse::loader_pointers(), {}); }
  void block(const Words& operands);
  void directory(const Words&) { add(westinghouse::loader_directory(), {.first_block = first_block_}); }
  void raw(const Words& operands);

 private:
  void add(LoaderOperation operation, LoaderRequest::About about) {
    WordParser::add(std::make_shared<LoaderRequest>(std::move(operation), dle_, std::move(about)));
  }
  LoaderRequest::About about(std::uint16_t first, std::size_t count) const;

  Dle dle_;
  std::size_t first_block_;
};

using LoaderVerb = Verb<Pc500Parser>;

constexpr std::array kPc500Verbs{
    LoaderVerb{"read", "ADDRESS[:COUNT]…", "bytes, up to 512 at once: 16#EF80:4, IB0, QB3, FY10 (04)", 1, kMany,
               &Pc500Parser::read},
    LoaderVerb{"write", "ADDRESS=BYTE,…", "the same, written (03)", 1, kMany, &Pc500Parser::write},
    LoaderVerb{"parameters", "", "where its images, timers, counters and data are, and its release (18)", 0, 0,
               &Pc500Parser::pointers},
    LoaderVerb{"block", "NUMBER", "a data block: where it is and how long (1A)", 1, 1, &Pc500Parser::block},
    LoaderVerb{"blocks", "", "all data blocks (1B)", 0, 0, &Pc500Parser::directory},
    LoaderVerb{"raw", "HEX…", "single steps of a session, as they are", 1, kMany, &Pc500Parser::raw},
    LoaderVerb{"wait", "TIME", "before the next action", 1, 1, &Pc500Parser::wait},
};

std::vector<MasterAction> Pc500Parser::parse(const Words& words) {
  return parse_with(*this, std::span<const LoaderVerb>(kPc500Verbs), words, "read QB0:4");
}

LoaderRequest::About Pc500Parser::about(std::uint16_t first, std::size_t count) const {
  if (count > westinghouse::kMostLoaderBytes)
    refuse(fmt::format("{}: {} bytes; a session has {} at most", text_, count, westinghouse::kMostLoaderBytes));
  if (first + count - 1 > UINT16_MAX) refuse(fmt::format("{}: the bytes run past 16#FFFF", text_));
  if (count == 1) return {fmt::format("byte 16#{:04X}", first), first, count};
  return {fmt::format("bytes 16#{:04X}…{:04X}", first, first + count - 1), first, count};
}

void Pc500Parser::read(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, ':');
    text_ = "read " + operand;
    const std::uint16_t first = loader_address(parts ? parts->first : operand);
    const auto count = static_cast<std::size_t>(parts ? parse_number(parts->second, 1, UINT16_MAX, "count") : 1);
    add(westinghouse::loader_read(first, count), about(first, count));
  }
}

void Pc500Parser::write(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example QB0=16#7F", stl::shortened(operand)));
    text_ = "write " + operand;
    const std::uint16_t first = loader_address(parts->first);
    const Bytes data = byte_values_of(parts->second);
    add(westinghouse::loader_write(first, data), about(first, data.size()));
  }
}

void Pc500Parser::block(const Words& operands) {
  const auto number = static_cast<std::uint8_t>(parse_number(operands[0], 0, UINT8_MAX, "data block"));
  add(westinghouse::loader_block(number), {.subject = fmt::format("DB{:03}", number)});
}

void Pc500Parser::raw(const Words& operands) {
  for (const std::string& operand : operands) {
    serial::Frame frame = parse_hex(operand);
    const std::uint8_t first = frame.front().byte;
    add_raw(operand, first, std::make_shared<RawStep>(std::move(frame)));
  }
}

}  // namespace

const Protocol& pc500_loader_protocol() {
  static const Protocol protocol{
      .name = "pc500-loader",
      .meaning = "Westinghouse PC500 and PC2000 at their loader port; in simulation a PC503",
      .station = {},
      .format = {},
      .over_modbus_tcp = false,
      .options = {word_option(kDle, "FORM", fmt::format("a byte 10 in what the PLC sends: {}", fmt::join(kDleWords, ", ")),
                              "a way to send a byte 10", kDleWords),
                  word_option(kDirectory, "BLOCK",
                              fmt::format("block whose address is the first of its directory: {}",
                                          fmt::join(kFirstBlockWords, ", ")),
                              "a block that the directory may begin with", kFirstBlockWords)},
      .actions_help = "Actions of --protocol pc500-loader; in brackets its operations:\n" +
                      verbs_help(std::span<const LoaderVerb>(kPc500Verbs)),
      .action_words = verb_words(std::span<const LoaderVerb>(kPc500Verbs)),
      .actions = [](const Words& words, const ProtocolUse& use) { return Pc500Parser(use).parse(words); },
      .is_complete = westinghouse::is_whole_step,
      .patience = {.timeout = 500 * kMillisecond,
                   .retries = 2,
                   .pause = 500 * kMillisecond,
                   .repeats = [](std::uint16_t) { return true; }},
      .choices = "--timeout, --retries, --before-retry [S4], --directory [S1]",
      .plcs = westinghouse::find_plc("pc500-loader")};
  return protocol;
}

}  // namespace s7200::tools
