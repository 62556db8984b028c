// The loader port of HPPC1500 and HPPC1700.
#include <array>

#include "serial_sim/westinghouse/messages/hppc_message.hpp"
#include "tools/master/words.hpp"
#include "tools/master/written_values.hpp"

namespace s7200::tools {
namespace {

using westinghouse::FcsTable;
using westinghouse::HppcLayout;
using westinghouse::HppcOpcode;
using westinghouse::kBitWriteWords;
using westinghouse::kFcsWords;
using westinghouse::kMonitorAddressWords;
using westinghouse::kReadRequestWords;
using Data = std::span<const std::uint8_t>;

constexpr std::string_view kFcs = "--fcs", kNoResync = "--no-resync", kReadRequest = "--read-request",
                           kBitWrite = "--bit-write", kMonitorAddress = "--monitor-address-bytes";
constexpr std::uint8_t kWholeTable = 0x34;  // bytes of the parameter table up to the number of holding registers
constexpr std::size_t kAddress = 3;
constexpr std::uint32_t kLastAddress = westinghouse::kHppcMemory - 1;

serial::Frame frame_of(HppcOpcode opcode, const Bytes& operands, FcsTable table) {
  return serial::to_frame(westinghouse::hppc_message(westinghouse::kIop, westinghouse::kApl, opcode, operands, table));
}

/// The choices that the document leaves open for messages.
struct Form {
  FcsTable table = FcsTable::Document;
  HppcLayout layout{};
};

Form form_of(const ProtocolUse& use) {
  return {static_cast<FcsTable>(use.chosen(kFcs, kFcsWords)),
          {static_cast<HppcLayout::ReadRequest>(use.chosen(kReadRequest, kReadRequestWords)),
           static_cast<HppcLayout::BitWrite>(use.chosen(kBitWrite, kBitWriteWords)),
           westinghouse::kMonitorAddressBytes[use.chosen(kMonitorAddress, kMonitorAddressWords)]}};
}

/// Holding registers n to n + count - 1 lie downwards from where register 1 is.
struct Registers {
  std::uint16_t first = 1;
  std::uint16_t count = 1;
  std::vector<std::uint16_t> values{};  ///< to be written

  std::uint32_t lowest(std::uint32_t base) const { return base - 2U * (first - 1U + count - 1U); }
};

class HppcRequest final : public ProtocolRequest {
 public:
  struct About {
    HppcOpcode opcode = HppcOpcode::Read;
    Bytes operands{};
    std::string subject{};
    std::optional<std::uint32_t> first{};  ///< address of bytes that are read or written
    std::size_t count = 0;
    std::optional<Registers> registers{};                   ///< then the first step reads the parameter table
    std::array<std::vector<std::uint32_t>, 3> monitored{};  ///< bytes, words, double words
    std::vector<std::size_t> asked{};                       ///< which of the three, in the order of the action
  };

  HppcRequest(About about, const Form& form) : about_(std::move(about)), form_(form) {}
  HppcRequest(serial::Frame raw, const Form& form) : raw_(std::move(raw)), form_(form) {}

  serial::Frame frame() override {
    if (!raw_.empty()) return raw_;
    step_ = 1;
    if (about_.registers) return frame_of(HppcOpcode::Parameters, {kWholeTable}, form_.table);
    return frame_of(about_.opcode, about_.operands, form_.table);
  }

  std::optional<serial::Frame> next(Data response, Time) override;
  serial::Answer judge(Data request, Data response) const override;
  std::string_view error_name(std::uint16_t code) const override { return westinghouse::hppc_error_name(code); }
  std::string subject() const override { return about_.subject; }
  std::string in_short(const serial::Answer& answer, Data request, Data response) const override;
  std::vector<std::string> in_lines(const serial::Answer& answer, Data request, Data response) const override;
  nlohmann::ordered_json subject_json(Data request) const override;
  nlohmann::ordered_json decoded_json(const serial::Answer& answer) const override { return answer.values; }

 private:
  std::string why_not_there(Data table) const;
  /// Takes the operands of the last answer. Returns what is wrong with them; empty if they are right.
  std::string take(serial::Answer& answer) const;
  std::vector<std::string> monitored_lines(const serial::Answer& answer) const;

  serial::Frame raw_;
  About about_;
  Form form_;
  int step_ = 1;
};

/// The first message of a stream of them, by its length.
Data first_message(Data stream) {
  const std::size_t length = stream.size() < 2 ? stream.size() : stream[0] + stream[1] * 256U;
  return stream.first(std::min(std::max<std::size_t>(length, 1), stream.size()));
}

/// Why the registers that are asked for do not exist; empty if they do.
std::string HppcRequest::why_not_there(Data table) const {
  const auto found = westinghouse::holding_registers(table);
  if (!found) return "the parameter table does not say where the holding registers are";
  const std::uint32_t last = about_.registers->first + about_.registers->count - 1U;
  if (!found->number || *found->number == 0 || last <= *found->number) return {};
  return fmt::format("by the parameter table there are {} holding registers", *found->number);
}

std::optional<serial::Frame> HppcRequest::next(Data response, Time) {
  if (!about_.registers || step_ != 1) return {};
  const serial::Answer answer = westinghouse::check_hppc_answer({}, response, form_.table);
  if (answer.verdict != serial::Verdict::Right || answer.bytes.size() < kAddress) return {};
  const Data table = Data(answer.bytes).subspan(kAddress);
  const auto found = westinghouse::holding_registers(table);
  if (!found || !why_not_there(table).empty()) return {};
  ++step_;
  const Registers& registers = *about_.registers;
  const std::uint32_t lowest = registers.lowest(found->base);
  if (registers.values.empty())
    return frame_of(HppcOpcode::Read,
                    westinghouse::hppc_read(lowest, static_cast<std::uint8_t>(2 * registers.count), form_.layout),
                    form_.table);
  Bytes data;
  for (auto value = registers.values.rbegin(); value != registers.values.rend(); ++value) {
    data.push_back(static_cast<std::uint8_t>(*value & 0xFF));
    data.push_back(static_cast<std::uint8_t>(*value >> 8));
  }
  return frame_of(HppcOpcode::Write, westinghouse::hppc_write(lowest, data), form_.table);
}

serial::Answer HppcRequest::judge(Data request, Data response) const {
  if (about_.registers) {
    const Data asked = first_message(request), answered = first_message(response);
    serial::Answer answer = westinghouse::check_hppc_answer(asked, answered, form_.table);
    if (answer.verdict != serial::Verdict::Right) return answer;
    request = request.subspan(asked.size());
    response = response.subspan(answered.size());
    if (request.empty()) {
      answer.verdict = serial::Verdict::Wrong;
      answer.lasting = true;
      answer.fault = why_not_there(Data(answer.bytes).subspan(std::min(kAddress, answer.bytes.size())));
      return answer;
    }
  }
  serial::Answer answer = westinghouse::check_hppc_answer(request, response, form_.table);
  if (answer.verdict == serial::Verdict::Silent && about_.registers) {
    answer.verdict = serial::Verdict::Wrong;
    answer.fault = "no answer to the second of two steps";
  }
  if (answer.verdict != serial::Verdict::Right || !raw_.empty()) return answer;
  if (std::string fault = take(answer); !fault.empty()) {
    answer = {};
    answer.verdict = serial::Verdict::Wrong;
    answer.fault = std::move(fault);
  }
  return answer;
}

std::string HppcRequest::take(serial::Answer& answer) const {
  const auto wrong_length = [&](std::size_t expected) {
    return answer.bytes.size() == expected
               ? std::string()
               : fmt::format("wrong length: {} bytes of data, expected {}", answer.bytes.size(), expected);
  };
  const bool registers = about_.registers.has_value();
  const bool reads = registers ? about_.registers->values.empty() : about_.opcode == HppcOpcode::Read;
  if (reads) {
    const std::size_t count = registers ? 2U * about_.registers->count : about_.count;
    if (std::string fault = wrong_length(1 + count); !fault.empty()) return fault;
    if (answer.bytes[0] != count) return fmt::format("wrong number: {}, expected {}", answer.bytes[0], count);
    answer.bytes.erase(answer.bytes.begin());
    if (!registers) {
      answer.values.assign(answer.bytes.begin(), answer.bytes.end());
      return {};
    }
    for (std::size_t i = answer.bytes.size(); i > 0; i -= 2)
      answer.values.push_back(static_cast<std::uint16_t>(answer.bytes[i - 2] | answer.bytes[i - 1] << 8));
    answer.bytes.clear();
    return {};
  }
  switch (registers ? HppcOpcode::Write : about_.opcode) {
    case HppcOpcode::Write:
    case HppcOpcode::BitWrite:
      return wrong_length(0);
    case HppcOpcode::Parameters:
      return wrong_length(kAddress + about_.count);
    case HppcOpcode::Monitor: {
      const auto& [bytes, words, double_words] = about_.monitored;
      return wrong_length(1 + bytes.size() + 2 * words.size() + 4 * double_words.size());
    }
    default:
      return {};
  }
}

std::string HppcRequest::in_short(const serial::Answer& answer, Data, Data) const {
  if (!raw_.empty()) return answer.bytes.empty() ? "done" : serial::to_hex(answer.bytes);
  if (about_.opcode == HppcOpcode::Parameters && !about_.registers) return westinghouse::hppc_parameters_text(answer.bytes);
  if (about_.opcode == HppcOpcode::Monitor) return fmt::format("{}", fmt::join(monitored_lines(answer), " "));
  std::string text;
  for (const std::uint16_t value : answer.values)
    text += fmt::format("{}16#{:0{}X}", text.empty() ? "" : " ", value, about_.registers ? 4 : 2);
  if (!text.empty()) return text;
  return about_.count == 0 && !about_.registers ? "in step" : about_.subject + " written";
}

std::vector<std::string> HppcRequest::in_lines(const serial::Answer& answer, Data request, Data response) const {
  if (raw_.empty() && about_.opcode == HppcOpcode::Monitor) return monitored_lines(answer);
  if (answer.values.empty()) return {"  " + in_short(answer, request, response)};
  std::vector<std::string> lines;
  std::uint32_t place = about_.registers ? about_.registers->first : *about_.first;
  for (const std::uint16_t value : answer.values)
    lines.push_back(about_.registers ? fmt::format("  R{:05}  16#{:04X} {:>6}", place++, value, value)
                                     : fmt::format("  16#{:05X}  16#{:02X} {:>6}", place++, value, value));
  return lines;
}

std::vector<std::string> HppcRequest::monitored_lines(const serial::Answer& answer) const {
  std::vector<std::string> lines{"  " + westinghouse::hppc_status_text(answer.bytes[0])};
  const auto& [single, words, doubles] = about_.monitored;
  std::array<std::size_t, 3> place{1, 1 + single.size(), 1 + single.size() + 2 * words.size()}, next{};
  for (const std::size_t size : about_.asked) {
    const std::size_t bytes = std::size_t{1} << size;
    std::uint32_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | answer.bytes[place[size] + i];
    lines.push_back(
        fmt::format("  16#{:05X}  16#{:0{}X} {:>6}", about_.monitored[size][next[size]++], value, 2 * bytes, value));
    place[size] += bytes;
  }
  return lines;
}

nlohmann::ordered_json HppcRequest::subject_json(Data request) const {
  nlohmann::ordered_json json = empty_subject();
  if (!raw_.empty()) return json;
  json["function"] = request[westinghouse::kHppcHeader - 1];
  if (about_.registers) {
    json["area"] = "holding";
    json["first"] = about_.registers->first;
    json["notation"] = fmt::format("R{:05}", about_.registers->first);
    json["count"] = about_.registers->count;
  } else if (about_.first) {
    json["area"] = "bytes";
    json["first"] = *about_.first;
    json["notation"] = fmt::format("16#{:05X}", *about_.first);
    json["count"] = about_.count;
  }
  return json;
}

std::uint32_t hppc_address(const std::string& text) {
  return static_cast<std::uint32_t>(parse_number(text, 0, kLastAddress, "address"));
}

class HppcParser final : public WordParser {
 public:
  explicit HppcParser(const ProtocolUse& use) : WordParser(use.station, UINT8_MAX), form_(form_of(use)) {}

  std::vector<MasterAction> parse(const Words& words);

  void read(const Words& operands);
  void write(const Words& operands);
  void bits(const Words& operands);
  void registers(const Words& operands);
  void set_registers(const Words& operands);
  void parameters(const Words& operands);
  void monitor(const Words& operands);
  void resync(const Words&) { add({.operands = westinghouse::hppc_read(0, 0, form_.layout), .first = 0}); }
  void raw(const Words& operands);

 private:
  void add(HppcRequest::About about) { WordParser::add(std::make_shared<HppcRequest>(std::move(about), form_)); }
  void add_registers(Registers registers);
  void refuse_without_address(std::string_view why) const;

  Form form_;
};

using HppcVerb = Verb<HppcParser>;

constexpr std::array kHppcVerbs{
    HppcVerb{"read", "ADDRESS[:COUNT]…", "bytes of memory, up to 255 at once: read 16#80000:4 (0C)", 1, kMany,
             &HppcParser::read},
    HppcVerb{"write", "ADDRESS=BYTE,…", "the same, written (0B)", 1, kMany, &HppcParser::write},
    HppcVerb{"bits", "ADDRESS=PATTERN/MASK…", "those bits of a word that are in the mask (0A)", 1, kMany, &HppcParser::bits},
    HppcVerb{"read-register", "NUMBER[:COUNT]…", "holding registers from 1, where the parameter table says they are", 1,
             kMany, &HppcParser::registers},
    HppcVerb{"write-register", "NUMBER=VALUE,…", "the same, written", 1, kMany, &HppcParser::set_registers},
    HppcVerb{"parameters", "[COUNT]", "where the parameter table is, and that many bytes of it [52] (0D)", 0, 1,
             &HppcParser::parameters},
    HppcVerb{"monitor", "[NETWORK] SIZE:ADDRESS…", "values of one scan; SIZE is b, w or d for 1, 2 or 4 bytes (09)", 1,
             kMany, &HppcParser::monitor},
    HppcVerb{"resync", "", "reads nothing, to be in step again", 0, 0, &HppcParser::resync},
    HppcVerb{"raw", "HEX…", "messages as they are", 1, kMany, &HppcParser::raw},
    HppcVerb{"wait", "TIME", "before the next action", 1, 1, &HppcParser::wait},
};

std::vector<MasterAction> HppcParser::parse(const Words& words) {
  return parse_with(*this, std::span<const HppcVerb>(kHppcVerbs), words, "read-register 1:2");
}

std::string bytes_text(std::uint32_t first, std::size_t count) {
  if (count == 1) return fmt::format("byte 16#{:05X}", first);
  return fmt::format("bytes 16#{:05X}…{:05X}", first, first + count - 1);
}

void HppcParser::refuse_without_address(std::string_view why) const {
  if (form_.layout.read_request == HppcLayout::ReadRequest::AddressAndNumber) return;
  refuse(fmt::format("{}: not with {} {}: {}", text_, kReadRequest, kReadRequestWords[1], why));
}

void HppcParser::read(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, ':');
    text_ = "read " + operand;
    const std::uint32_t first = hppc_address(parts ? parts->first : operand);
    const auto count = static_cast<std::uint8_t>(parts ? parse_number(parts->second, 1, UINT8_MAX, "count") : 1);
    if (first != 0) refuse_without_address("a read has no address then, and begins at 16#00000");
    add({.operands = westinghouse::hppc_read(first, count, form_.layout),
         .subject = bytes_text(first, count),
         .first = first,
         .count = count});
  }
}

void HppcParser::write(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example 16#ABFFE=5", stl::shortened(operand)));
    text_ = "write " + operand;
    const std::uint32_t first = hppc_address(parts->first);
    Bytes data;
    for (const std::int64_t value : values_of(parts->second, INT8_MIN, UINT8_MAX))
      data.push_back(static_cast<std::uint8_t>(value));
    if (data.size() > UINT8_MAX) refuse(fmt::format("{}: {} bytes; a message writes 255 at most", text_, data.size()));
    add({.opcode = HppcOpcode::Write,
         .operands = westinghouse::hppc_write(first, data),
         .subject = bytes_text(first, data.size()),
         .first = first,
         .count = data.size()});
  }
}

void HppcParser::bits(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto sides = split_at(operand, '=');
    const auto words = sides ? split_at(sides->second, '/') : std::nullopt;
    if (!words)
      refuse(fmt::format("'{}' is not a pattern with its mask; write for example 16#ABFFE=16#01/16#0F",
                         stl::shortened(operand)));
    text_ = "bits " + operand;
    const std::uint32_t first = hppc_address(sides->first);
    const auto pattern = static_cast<std::uint16_t>(parse_number(words->first, 0, UINT16_MAX, "pattern"));
    const auto mask = static_cast<std::uint16_t>(parse_number(words->second, 0, UINT16_MAX, "mask"));
    add({.opcode = HppcOpcode::BitWrite,
         .operands = westinghouse::hppc_bit_write(first, pattern, mask, form_.layout),
         .subject = fmt::format("bits of the word at 16#{:05X}", first),
         .first = first,
         .count = 2});
  }
}

void HppcParser::add_registers(Registers registers) {
  constexpr std::uint16_t kMost = UINT8_MAX / 2;
  if (registers.count > kMost)
    refuse(fmt::format("{}: {} registers; a message has {} at most", text_, registers.count, kMost));
  std::string subject = fmt::format("register {}", registers.first);
  if (registers.count > 1) subject = fmt::format("registers {}…{}", registers.first, registers.first + registers.count - 1);
  add({.subject = std::move(subject), .registers = std::move(registers)});
}

void HppcParser::registers(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, ':');
    text_ = "read-register " + operand;
    refuse_without_address("registers cannot be read without their address");
    add_registers({static_cast<std::uint16_t>(parse_number(parts ? parts->first : operand, 1, UINT16_MAX, "register")),
                   static_cast<std::uint16_t>(parts ? parse_number(parts->second, 1, UINT16_MAX, "count") : 1)});
  }
}

void HppcParser::set_registers(const Words& operands) {
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example 1=5", stl::shortened(operand)));
    text_ = "write-register " + operand;
    Registers registers{.first = static_cast<std::uint16_t>(parse_number(parts->first, 1, UINT16_MAX, "register"))};
    for (const std::int64_t value : values_of(parts->second, INT16_MIN, UINT16_MAX))
      registers.values.push_back(static_cast<std::uint16_t>(value));
    registers.count = static_cast<std::uint16_t>(registers.values.size());
    add_registers(std::move(registers));
  }
}

void HppcParser::parameters(const Words& operands) {
  const auto count =
      static_cast<std::uint8_t>(operands.empty() ? kWholeTable : parse_number(operands[0], 0, UINT8_MAX, "count"));
  add({.opcode = HppcOpcode::Parameters, .operands = {count}, .count = count});
}

void HppcParser::monitor(const Words& operands) {
  constexpr std::string_view kSizes = "bwd";
  HppcRequest::About about{.opcode = HppcOpcode::Monitor};
  std::uint32_t network = 0;
  for (const std::string& operand : operands) {
    const auto parts = split_at(operand, ':');
    const std::size_t size = parts && parts->first.size() == 1 ? kSizes.find(parts->first[0]) : std::string_view::npos;
    if (!parts && &operand == &operands.front()) {
      network = hppc_address(operand);
      continue;
    }
    if (size == std::string_view::npos)
      refuse(fmt::format("'{}' is not a size with an address; write for example w:16#ABFFE", stl::shortened(operand)));
    about.monitored[size].push_back(hppc_address(parts->second));
    about.asked.push_back(size);
  }
  const auto& [bytes, words, double_words] = about.monitored;
  const std::size_t sum = bytes.size() + 2 * words.size() + 4 * double_words.size();
  if (sum == 0 || sum > UINT8_MAX + 1U) refuse(fmt::format("{}: {} bytes; a monitor takes 1 to 256", text_, sum));
  if (bytes.size() > UINT8_MAX) refuse(fmt::format("{}: {} addresses of one size; there may be 255", text_, bytes.size()));
  about.operands = westinghouse::hppc_monitor(network, bytes, words, double_words, form_.layout);
  if (network != 0) about.subject = fmt::format("network {}", network);
  add(std::move(about));
}

void HppcParser::raw(const Words& operands) {
  for (const std::string& operand : operands) {
    serial::Frame frame = parse_hex(operand);
    const std::uint8_t first = frame.front().byte;
    add_raw(operand, first, std::make_shared<HppcRequest>(std::move(frame), form_));
  }
}

serial::Frame resynchronisation(const ProtocolUse& use) {
  const Form form = form_of(use);
  return frame_of(HppcOpcode::Read, westinghouse::hppc_read(0, 0, form.layout), form.table);
}

constexpr std::uint8_t kLinkError = 0x01;

}  // namespace

const Protocol& hppc_protocol() {
  static const Protocol protocol{
      .name = "hppc",
      .meaning = "Westinghouse HPPC1500 and HPPC1700 at their loader port",
      .station = {},
      .format = {.parity = Parity::None},
      .over_modbus_tcp = false,
      .options = {word_option(
                      kFcs, "TABLE",
                      fmt::format("frame check: {}, with the odd entry of its table, or {}", kFcsWords[0], kFcsWords[1]),
                      "a frame check", kFcsWords),
                  word_option(kReadRequest, "FORM",
                              fmt::format("operands of a read: {}", fmt::join(kReadRequestWords, ", ")), "a form of a read",
                              kReadRequestWords),
                  word_option(kBitWrite, "FORM",
                              fmt::format("order of the words of a bit write: {}", fmt::join(kBitWriteWords, ", ")),
                              "an order of the words of a bit write", kBitWriteWords),
                  word_option(kMonitorAddress, "BYTES",
                              fmt::format("of each address of a monitor: {}", fmt::join(kMonitorAddressWords, ", ")),
                              "a length of an address", kMonitorAddressWords),
                  {kNoResync, "", "nothing is read from location zero before a request is repeated", {}, nullptr}},
      .actions_help =
          "Actions of --protocol hppc; in brackets its opcodes:\n" + verbs_help(std::span<const HppcVerb>(kHppcVerbs)),
      .action_words = verb_words(std::span<const HppcVerb>(kHppcVerbs)),
      .actions = [](const Words& words, const ProtocolUse& use) { return HppcParser(use).parse(words); },
      .is_complete = westinghouse::is_whole_hppc,
      .patience = {.timeout = kSecond,
                   .retries = 2,
                   .pause = 500 * kMillisecond,
                   .first = resynchronisation,
                   .without_first = kNoResync,
                   .repeats = [](std::uint16_t code) { return code == kLinkError; }},
      .choices =
          "--timeout, --retries, --before-retry, --no-resync [H9], --read-request [H4], --bit-write [H5], "
          "--monitor-address-bytes [H6]",
      .plcs = westinghouse::find_plc("hppc")};
  return protocol;
}

}  // namespace s7200::tools
