#include "tools/master/action.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"

namespace s7200::tools {
namespace {

using modbus::Area;
using modbus::Reference;

using Words = std::vector<std::string>;

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument(why); }

/// `text` up to `separator`, and what comes after it; nothing if it is not there.
std::optional<std::pair<std::string, std::string>> split_at(const std::string& text, char separator) {
  const std::size_t place = text.find(separator);
  if (place == std::string::npos) return {};
  return std::pair{text.substr(0, place), text.substr(place + 1)};
}

std::uint16_t word(const std::string& text, std::string_view what) {
  return static_cast<std::uint16_t>(parse_number(text, 0, UINT16_MAX, what));
}

class Parser {
 public:
  explicit Parser(const ActionRules& rules) : rules_(rules), station_(rules.station) {}

  std::vector<MasterAction> parse(const Words& words);

  void read(const Words& operands);
  void write(const Words& operands);
  void loopback(const Words& operands);
  void diagnostics(const Words& operands);
  void exception_status(const Words&) { add(modbus::read_exception_status()); }
  void slave_id(const Words&) { add(modbus::report_slave_id()); }
  void read_file(const Words& operands) { add(modbus::read_file_record(to_read(operands, modbus::kFileReference))); }
  void write_file(const Words& operands) { add(modbus::write_file_record(to_write(operands, modbus::kFileReference))); }
  void general_read(const Words& operands) {
    add(modbus::read_file_record(to_read(operands, modbus::kExtendedMemoryReference)));
  }
  void general_write(const Words& operands) {
    add(modbus::write_file_record(to_write(operands, modbus::kExtendedMemoryReference)));
  }
  void function(const Words& operands);
  void raw(const Words& operands);
  void station(const Words& operands);
  void wait(const Words& operands);

 private:
  MasterAction& add(Bytes pdu);
  void check_limits(const MasterAction& action) const;

  /// The address of an operand: an area was named before, or the notation names it.
  modbus::DataAddress address(const std::string& text) const;
  /// Takes the name of an area off the operands, if they begin with one.
  Words without_area(const Words& operands);

  static std::vector<Reference> to_read(const Words& operands, std::uint8_t type);
  static std::vector<Reference> to_write(const Words& operands, std::uint8_t type);

  const ActionRules& rules_;
  std::uint8_t station_;
  std::string text_;                       // of the action at hand
  const modbus::AreaRow* area_ = nullptr;  // that it names
  std::vector<MasterAction> actions_;
};

struct Verb {
  std::string_view word, operands, meaning;
  std::size_t least, most;  // operands
  void (Parser::*parse)(const Words&);
};

constexpr std::size_t kMany = SIZE_MAX;

constexpr std::array kVerbs{
    Verb{"read", "ADDRESS[:COUNT]…", "data; the address selects the function (1 to 4)", 1, kMany, &Parser::read},
    Verb{"write", "ADDRESS=VALUE,…", "coils: on, off, 1, 0; registers: 1234, -5, 16#04D2, 2#1010 (5, 6, 15, 16)", 1, kMany,
         &Parser::write},
    Verb{"loopback", "[DATA,…]", "what is sent comes back; without DATA another word each time (8)", 0, 1,
         &Parser::loopback},
    Verb{"diagnostics", "SUB [DATA,…]", "a subfunction, with a word 0 if no DATA is given (8)", 1, 2, &Parser::diagnostics},
    Verb{"exception-status", "", "eight bits of which the slave's maker says what they mean (7)", 0, 0,
         &Parser::exception_status},
    Verb{"slave-id", "", "who it is and whether it runs (17)", 0, 0, &Parser::slave_id},
    Verb{"read-file", "FILE:RECORD:COUNT…", "registers of files, several references in one request (20)", 1, kMany,
         &Parser::read_file},
    Verb{"write-file", "FILE:RECORD=VALUE,…", "the same, written (21)", 1, kMany, &Parser::write_file},
    Verb{"general-read", "SEGMENT:OFFSET:COUNT…", "bytes of extended memory, references of kind 16#33 (20)", 1, kMany,
         &Parser::general_read},
    Verb{"general-write", "SEGMENT:OFFSET=BYTE,…", "the same, written (21)", 1, kMany, &Parser::general_write},
    Verb{"function", "NUMBER [HEX]", "any function, with data in hex", 1, 2, &Parser::function},
    Verb{"raw", "HEX…", "frames as they are; --crc appends the CRC", 1, kMany, &Parser::raw},
    Verb{"station", "NUMBER", "the actions after it go to this station; 0 is all of them", 1, 1, &Parser::station},
    Verb{"wait", "TIME", "before the next action", 1, 1, &Parser::wait},
};

const Verb* find_verb(const std::string& word) {
  const auto verb = std::find_if(kVerbs.begin(), kVerbs.end(), [&](const Verb& v) { return v.word == word; });
  return verb == kVerbs.end() ? nullptr : &*verb;
}

std::string known_verbs() {
  std::string text;
  for (const Verb& verb : kVerbs) text.append(text.empty() ? "" : ", ").append(verb.word);
  return text;
}

std::vector<MasterAction> Parser::parse(const Words& words) {
  if (words.empty()) refuse("nothing to do: give actions, for example read 40001:10");
  for (std::size_t place = 0; place < words.size();) {
    const Verb* verb = find_verb(words[place]);
    if (verb == nullptr) refuse(fmt::format("'{}' is not an action; there are {}", stl::shortened(words[place]), known_verbs()));
    const auto first = words.begin() + static_cast<std::ptrdiff_t>(place) + 1;
    const auto last = std::find_if(first, words.end(), [](const std::string& word) { return find_verb(word) != nullptr; });
    const Words operands(first, last);
    if (operands.size() < verb->least || operands.size() > verb->most)
      refuse(fmt::format("write it as: {}{}{}", verb->word, verb->operands.empty() ? "" : " ", verb->operands));
    text_ = fmt::format("{}{}{}", verb->word, operands.empty() ? "" : " ", fmt::join(operands, " "));
    area_ = nullptr;
    (this->*verb->parse)(operands);
    place += 1 + operands.size();
  }
  return std::move(actions_);
}

MasterAction& Parser::add(Bytes pdu) {
  MasterAction action{.text = text_, .pdu = std::move(pdu), .station = station_};
  const std::uint8_t function = action.pdu[0];
  const modbus::FunctionRow* row = modbus::find_function(function);
  constexpr std::uint8_t kListenOnly = 4;
  const bool listen_only = row != nullptr && row->shape == modbus::Shape::Diagnostics && action.pdu.size() > 2 &&
                           action.pdu[1] == 0 && action.pdu[2] == kListenOnly;
  action.answer_expected = station_ != modbus::kBroadcast && !listen_only;
  check_limits(action);
  actions_.push_back(std::move(action));
  return actions_.back();
}

void Parser::check_limits(const MasterAction& action) const {
  const std::size_t size = action.pdu.size() + 3;
  if (size > serial::kLongestRawFrame)
    refuse(fmt::format("{}: a frame of {} bytes; {} is the most that can be sent", text_, size, serial::kLongestRawFrame));
  if (rules_.beyond_limits) return;
  std::string why = modbus::beyond_limits(action.pdu);
  if (why.empty() && size > modbus::kLongestRtuFrame)
    why = fmt::format("a frame of {} bytes: the specification allows {}", size, modbus::kLongestRtuFrame);
  const modbus::FunctionRow* row = modbus::find_function(action.pdu[0]);
  if (why.empty() && action.station == modbus::kBroadcast && row != nullptr && !row->broadcast)
    why = fmt::format("station 0 is all stations, and none of them answers a broadcast: function {} ({}) needs one station",
                      action.pdu[0], row->name);
  if (!why.empty()) refuse(fmt::format("{}: {}; --beyond-limits sends it all the same", text_, why));
}

Words Parser::without_area(const Words& operands) {
  for (const modbus::AreaRow& row : modbus::areas())
    if (row.word == operands[0]) {
      area_ = &row;
      if (operands.size() == 1) refuse(fmt::format("{}: write it as {} 0, counted from 0", text_, text_));
      return {operands.begin() + 1, operands.end()};
    }
  return operands;
}

modbus::DataAddress Parser::address(const std::string& text) const {
  if (area_ != nullptr) return {area_->area, word(text, fmt::format("address of {}s", area_->singular))};
  std::string why;
  const auto parsed = modbus::parse_address(text, why);
  if (!parsed) {
    std::string words;
    for (const modbus::AreaRow& row : modbus::areas()) words.append(words.empty() ? "" : ", ").append(row.word);
    refuse(fmt::format("{}; or name the area ({}) and count from 0", why, words));
  }
  return *parsed;
}

void Parser::read(const Words& operands) {
  for (const std::string& operand : without_area(operands)) {
    const auto parts = split_at(operand, ':');
    const modbus::DataAddress first = address(parts ? parts->first : operand);
    const std::uint16_t count = parts ? word(parts->second, "count") : std::uint16_t{1};
    text_ = area_ != nullptr ? fmt::format("read {} {}", area_->word, operand) : "read " + operand;
    const auto function = static_cast<std::uint8_t>(modbus::row_of(first.area).read);
    Bytes pdu = modbus::read_coils(first.address, count);  // reads differ in nothing but their number
    pdu[0] = function;
    MasterAction& action = add(std::move(pdu));
    action.first = first;
    action.count = count;
  }
}

void Parser::write(const Words& operands) {
  for (const std::string& operand : without_area(operands)) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example 40001=5", stl::shortened(operand)));
    const modbus::DataAddress first = address(parts->first);
    const modbus::AreaRow& row = modbus::row_of(first.area);
    text_ = area_ != nullptr ? fmt::format("write {} {}", area_->word, operand) : "write " + operand;
    if (!row.write_one) refuse(fmt::format("{}: {}s can only be read", text_, row.singular));
    const auto values = row.bits ? parse_bits(parts->second) : parse_registers(parts->second, rules_.format);
    const bool single = values.size() == 1 && !(row.bits ? rules_.always_15 : rules_.always_16);
    Bytes pdu;
    if (row.bits)
      pdu = single ? modbus::write_coil(first.address, values[0] != 0)
                   : modbus::write_coils(first.address, std::vector<bool>(values.begin(), values.end()));
    else
      pdu = single ? modbus::write_register(first.address, values[0]) : modbus::write_registers(first.address, values);
    MasterAction& action = add(std::move(pdu));
    action.first = first;
    action.count = static_cast<std::uint16_t>(values.size());
  }
}

void Parser::loopback(const Words& operands) {
  const auto data = operands.empty() ? std::vector<std::uint16_t>{0} : parse_registers(operands[0], {});
  MasterAction& action = add(modbus::diagnostics(0, data));
  if (operands.empty()) action.kind = MasterAction::Kind::Loopback;
}

void Parser::diagnostics(const Words& operands) {
  const std::uint16_t subfunction = word(operands[0], "subfunction");
  add(modbus::diagnostics(subfunction,
                          operands.size() > 1 ? parse_registers(operands[1], {}) : std::vector<std::uint16_t>{0}));
}

std::vector<Reference> Parser::to_read(const Words& operands, std::uint8_t type) {
  std::vector<Reference> references;
  for (const std::string& operand : operands) {
    const auto file = split_at(operand, ':');
    const auto record = file ? split_at(file->second, ':') : std::nullopt;
    if (!record) refuse(fmt::format("'{}' is not a reference; write for example 4:1:2", stl::shortened(operand)));
    references.push_back({.type = type,
                          .file = word(file->first, "file"),
                          .record = word(record->first, "record"),
                          .count = word(record->second, "count")});
  }
  return references;
}

std::vector<Reference> Parser::to_write(const Words& operands, std::uint8_t type) {
  std::vector<Reference> references;
  for (const std::string& operand : operands) {
    const auto sides = split_at(operand, '=');
    const auto file = sides ? split_at(sides->first, ':') : std::nullopt;
    if (!file) refuse(fmt::format("'{}' is not a reference with values; write for example 4:1=10,20", stl::shortened(operand)));
    Reference reference{.type = type, .file = word(file->first, "file"), .record = word(file->second, "record")};
    const auto values = parse_registers(sides->second, {});
    for (const std::uint16_t value : values) {
      if (type == modbus::kFileReference)
        reference.data.push_back(static_cast<std::uint8_t>(value >> 8));
      else if (value > UINT8_MAX)
        refuse(fmt::format("'{}': {} is not a byte", stl::shortened(operand), value));
      reference.data.push_back(static_cast<std::uint8_t>(value & 0xFF));
    }
    reference.count = static_cast<std::uint16_t>(values.size());
    references.push_back(std::move(reference));
  }
  return references;
}

serial::Frame parse_hex(const std::string& text) {
  serial::ParsedFrame parsed = serial::parse_hex_frame(text);
  if (!parsed.ok())
    refuse(fmt::format("'{}': column {}: {}", stl::shortened(text), parsed.errors[0].column, parsed.errors[0].message));
  return std::move(parsed.frame);
}

void Parser::function(const Words& operands) {
  Bytes pdu{static_cast<std::uint8_t>(parse_number(operands[0], 0, UINT8_MAX, "function"))};
  if (operands.size() > 1) {
    const serial::Frame data = parse_hex(operands[1]);
    if (serial::has_wrong_parity(data)) refuse(fmt::format("{}: wrong parity (p) is for raw frames", text_));
    std::ranges::copy(serial::bytes_of(data), std::back_inserter(pdu));
  }
  if (pdu[0] == 0 || pdu[0] >= modbus::kExceptionFlag) {
    if (!rules_.beyond_limits)
      refuse(fmt::format("{}: functions are from 1 to 127; --beyond-limits sends it all the same", text_));
  }
  add(std::move(pdu));
}

void Parser::raw(const Words& operands) {
  for (const std::string& operand : operands) {
    serial::Frame frame = parse_hex(operand);
    if (rules_.crc) modbus::append_crc(frame);
    const Bytes bytes = serial::bytes_of(frame);
    actions_.push_back({.kind = MasterAction::Kind::Raw,
                        .text = "raw " + operand,
                        .frame = std::move(frame),
                        .station = bytes[0],
                        .answer_expected = bytes[0] != modbus::kBroadcast || !modbus::crc_ok(bytes)});
  }
}

void Parser::station(const Words& operands) {
  station_ = static_cast<std::uint8_t>(parse_number(operands[0], 0, rules_.last_station, "station"));
  actions_.push_back({.kind = MasterAction::Kind::Station, .text = text_, .station = station_});
}

void Parser::wait(const Words& operands) {
  std::string why;
  const auto duration = parse_duration_in(operands[0], {0, kLongestDuration}, why);
  if (!duration) refuse(fmt::format("{}: {}", text_, why));
  actions_.push_back({.kind = MasterAction::Kind::Wait, .text = text_, .station = station_, .duration = *duration});
}

}  // namespace

std::vector<MasterAction> parse_actions(const std::vector<std::string>& words, const ActionRules& rules) {
  return Parser(rules).parse(words);
}

std::vector<std::string> raw_frames(const std::vector<MasterAction>& actions) {
  constexpr std::string_view kWord = "raw ";
  std::vector<std::string> frames;
  for (const MasterAction& action : actions)
    if (action.kind == MasterAction::Kind::Raw) frames.push_back(action.text.substr(kWord.size()));
  return frames;
}

std::string actions_help() {
  std::string text = "Actions, one or several, done in this order; in brackets the functions of Modbus:\n";
  for (const Verb& verb : kVerbs)
    text += fmt::format("  {:<38}{}\n", fmt::format("{} {}", verb.word, verb.operands), verb.meaning);
  text += "Addresses have 5 or 6 digits, as below; or name the area and count from 0 as on the wire: read holding 0:2\n";
  const auto most = [](modbus::Function function) {
    return modbus::find_function(static_cast<std::uint8_t>(function))->most;
  };
  for (const modbus::AreaRow& row : modbus::areas()) {
    text += fmt::format("  {:05} is the first {:<17} {:<16} up to {} at once", row.base + 1, row.singular, row.word,
                        most(row.read));
    if (row.write_many) text += fmt::format(", {} written", most(*row.write_many));
    text += row.area == Area::HoldingRegisters ? "; all: 400001 to 465536\n" : "\n";
  }
  return text;
}

std::string range_text(const modbus::DataAddress& first, std::uint16_t count) {
  const std::string_view object = modbus::row_of(first.area).singular;
  if (count <= 1) return fmt::format("{} {}", object, first.address);
  return fmt::format("{}s {}…{}", object, first.address, first.address + count - 1);
}

}  // namespace s7200::tools
