// Modbus RTU and Modbus TCP for a master.
#include <algorithm>
#include <array>
#include <iterator>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/line_turns.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/master/words.hpp"
#include "tools/master/written_values.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/register_text.hpp"

namespace s7200::tools {
namespace {

using modbus::Reference;
using Data = std::span<const std::uint8_t>;

constexpr std::string_view kAs = "--as", kLowWordFirst = "--low-word-first", kAlways15 = "--always-15",
                           kAlways16 = "--always-16", kCrc = "--crc", kBeyondLimits = "--beyond-limits";

/// The name of a range: `holding registers 10…11`, `coil 3`
std::string range_text(const modbus::DataAddress& first, std::uint16_t count) {
  const std::string_view object = modbus::row_of(first.area).singular;
  if (count <= 1) return fmt::format("{} {}", object, first.address);
  return fmt::format("{}s {}…{}", object, first.address, first.address + count - 1);
}

/// Columns: the address in the notation of 5 digits, on the wire, value.
std::string value_line(const modbus::DataAddress& address, const std::string& value) {
  return fmt::format("{:>7} {:>7}  {}", modbus::notation(address), address.address, value);
}

class ModbusRequest : public ProtocolRequest {
 public:
  struct About {
    bool raw = false;
    bool answered = true;                        ///< neither a broadcast nor a subfunction that is never answered
    std::optional<modbus::DataAddress> first{};  ///< of reads and writes of data
    std::uint16_t count = 0;
    ValueFormat format{};
  };

  ModbusRequest(serial::Frame frame, const About& about) : frame_(std::move(frame)), about_(about) {}

  serial::Frame frame() override { return frame_; }

  std::optional<Time> turnaround() const override {
    return about_.answered ? std::nullopt : std::optional(modbus::LineTurns::kTurnaround);
  }

  serial::Answer judge(Data request, Data response) const override { return modbus::check_answer(request, response); }

  std::string_view error_name(std::uint16_t code) const override { return modbus::exception_name(code); }
  std::string error_text(std::uint16_t code) const override {
    return fmt::format("exception {}: {}", code, error_name(code));
  }

  std::string subject() const override;
  std::string in_short(const serial::Answer& answer, Data request, Data response) const override;
  std::vector<std::string> in_lines(const serial::Answer& answer, Data request, Data response) const override;
  nlohmann::ordered_json subject_json(Data request) const override;

  nlohmann::ordered_json decoded_json(const serial::Answer& answer) const override {
    return about_.first && has_bits() ? nlohmann::ordered_json(answer.values) : values_json(answer.values, about_.format);
  }

 private:
  bool has_bits() const { return modbus::row_of(about_.first->area).bits; }
  bool shows_values(const serial::Answer& answer) const { return about_.first && !answer.values.empty(); }

  serial::Frame frame_;
  About about_;
};

std::string ModbusRequest::subject() const {
  if (about_.raw) return {};
  const Bytes bytes = serial::bytes_of(frame_);
  std::string text = fmt::format(
      "{}, function {}", bytes[0] == modbus::kBroadcast ? "all stations" : fmt::format("station {}", bytes[0]), bytes[1]);
  if (about_.first) text += ", " + range_text(*about_.first, about_.count);
  return text;
}

std::string ModbusRequest::in_short(const serial::Answer& answer, Data request, Data response) const {
  if (!shows_values(answer)) return modbus::describe(request, response);
  if (has_bits()) return bits_line(answer.values);
  const ValueForm form = about_.format.form;
  const ValueFormat brief{form == ValueForm::HexAndDecimal ? ValueForm::Hex : form, about_.format.low_word_first};
  std::string text;
  for (std::string value : value_lines(answer.values, brief)) {
    value.erase(0, value.find_first_not_of(' '));
    text += (text.empty() ? "" : " ") + value;
  }
  return text;
}

std::vector<std::string> ModbusRequest::in_lines(const serial::Answer& answer, Data request, Data response) const {
  if (!shows_values(answer)) return {"  " + in_short(answer, request, response)};
  const std::span<const std::uint16_t> values = answer.values;
  const bool bits = has_bits();
  constexpr std::size_t kBitsInALine = 16;
  const std::vector<std::string> texts = bits ? std::vector<std::string>{} : value_lines(values, about_.format);
  const std::size_t step = bits ? kBitsInALine : about_.format.registers();
  std::vector<std::string> lines;
  modbus::DataAddress address = *about_.first;
  for (std::size_t place = 0, row = 0; place < values.size(); ++row) {
    const std::size_t left = values.size() - place;
    const std::size_t size = step == 0 ? left : left < step && !bits ? 1 : std::min(step, left);
    lines.push_back(value_line(address, bits ? bits_line(values.subspan(place, size)) : texts[row]));
    place += size;
    address.address = static_cast<std::uint16_t>(address.address + size);
  }
  return lines;
}

nlohmann::ordered_json ModbusRequest::subject_json(Data request) const {
  nlohmann::ordered_json json = empty_subject();
  json["station"] = request[0];
  if (request.size() > 1) json["function"] = request[1];
  if (!about_.first) return json;
  json["area"] = modbus::row_of(about_.first->area).word;
  json["first"] = about_.first->address;
  if (const std::string notation = modbus::notation(*about_.first); !notation.empty()) json["notation"] = notation;
  json["count"] = about_.count;
  return json;
}

/// Function 8 with a word that is another each time, over all such requests of a session.
class Loopback final : public ModbusRequest {
 public:
  Loopback(std::uint8_t station, const About& about, std::shared_ptr<std::uint16_t> next)
      : ModbusRequest(framed(station, *next), about), station_(station), next_(std::move(next)) {}

  serial::Frame frame() override { return framed(station_, (*next_)++); }

 private:
  static serial::Frame framed(std::uint8_t station, std::uint16_t word) {
    return serial::to_frame(modbus::rtu_frame(station, modbus::diagnostics(0, std::array{word})));
  }

  std::uint8_t station_;
  std::shared_ptr<std::uint16_t> next_;
};

std::uint16_t word(const std::string& text, std::string_view what) {
  return static_cast<std::uint16_t>(parse_number(text, 0, UINT16_MAX, what));
}

ValueFormat value_format(const ProtocolUse& use) {
  ValueFormat format{.low_word_first = use.has(kLowWordFirst)};
  const auto form = use.given.find(kAs);
  for (const ValueFormName& known : value_forms())
    if (form != use.given.end() && form->second == known.name) format.form = known.form;
  return format;
}

// 255 is a Modbus TCP server itself, not a station behind it (Modbus Messaging on TCP/IP, 4.4.2). Westinghouse PLCs have
// stations from 1 to 255.
std::uint8_t last_station(const ProtocolUse& use) {
  return use.has(kBeyondLimits) || use.over_modbus_tcp || use.of_another_make ? UINT8_MAX : modbus::kLastStation;
}

class ModbusParser final : public WordParser {
 public:
  explicit ModbusParser(const ProtocolUse& use);

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

 private:
  using About = ModbusRequest::About;

  /// A request of the station at hand, within the limits of the specification.
  void add(const Bytes& pdu, About about = {});
  void add_loopback();
  /// Checks a request: throws if it goes beyond the limits, and returns whether it is answered.
  bool check(const Bytes& pdu) const;

  /// The address of an operand: an area was named before, or the notation names it.
  modbus::DataAddress address(const std::string& text) const;
  /// Takes the name of an area off the operands, if they begin with one.
  Words without_area(const Words& operands);

  static std::vector<Reference> to_read(const Words& operands, std::uint8_t type);
  static std::vector<Reference> to_write(const Words& operands, std::uint8_t type);

  ValueFormat format_;
  bool beyond_limits_;
  std::string_view way_beyond_;
  bool always_15_, always_16_, crc_;
  const modbus::AreaRow* area_ = nullptr;  // that the action at hand names
  std::shared_ptr<std::uint16_t> loopback_ =
      std::make_shared<std::uint16_t>(0x3412);  // is looped back next; 34 12 as NLAM-B58, 4.5
};

using ModbusVerb = Verb<ModbusParser>;

constexpr std::array kModbusVerbs{
    ModbusVerb{"read", "ADDRESS[:COUNT]…", "data; the address selects the function (1 to 4)", 1, kMany, &ModbusParser::read},
    ModbusVerb{"write", "ADDRESS=VALUE,…", "coils: on, off, 1, 0; registers: 1234, -5, 16#04D2, 2#1010 (5, 6, 15, 16)", 1,
               kMany, &ModbusParser::write},
    ModbusVerb{"loopback", "[DATA,…]", "what is sent comes back; without DATA another word each time (8)", 0, 1,
               &ModbusParser::loopback},
    ModbusVerb{"diagnostics", "SUB [DATA,…]", "a subfunction, with a word 0 if no DATA is given (8)", 1, 2,
               &ModbusParser::diagnostics},
    ModbusVerb{"exception-status", "", "eight bits of which the slave's maker says what they mean (7)", 0, 0,
               &ModbusParser::exception_status},
    ModbusVerb{"slave-id", "", "who it is and whether it runs (17)", 0, 0, &ModbusParser::slave_id},
    ModbusVerb{"read-file", "FILE:RECORD:COUNT…", "registers of files, several references in one request (20)", 1, kMany,
               &ModbusParser::read_file},
    ModbusVerb{"write-file", "FILE:RECORD=VALUE,…", "the same, written (21)", 1, kMany, &ModbusParser::write_file},
    ModbusVerb{"general-read", "SEGMENT:OFFSET:COUNT…", "bytes of extended memory, references of kind 16#33 (20)", 1, kMany,
               &ModbusParser::general_read},
    ModbusVerb{"general-write", "SEGMENT:OFFSET=BYTE,…", "the same, written (21)", 1, kMany, &ModbusParser::general_write},
    ModbusVerb{"function", "NUMBER [HEX]", "any function, with data in hex", 1, 2, &ModbusParser::function},
    ModbusVerb{"raw", "HEX…", "frames as they are; --crc appends the CRC", 1, kMany, &ModbusParser::raw},
    ModbusVerb{"station", "NUMBER", "the actions after it go to this station; 0 is all of them", 1, 1,
               &ModbusParser::station},
    ModbusVerb{"wait", "TIME", "before the next action", 1, 1, &ModbusParser::wait},
};

ModbusParser::ModbusParser(const ProtocolUse& use)
    : WordParser(static_cast<std::uint8_t>(parse_number(std::to_string(use.station), 0, last_station(use), "--station")),
                 last_station(use)),
      format_(value_format(use)),
      beyond_limits_(use.has(kBeyondLimits)),
      way_beyond_(use.options_are_open ? "; --beyond-limits sends it all the same" : ""),
      always_15_(use.has(kAlways15)),
      always_16_(use.has(kAlways16)),
      crc_(use.has(kCrc)) {}

std::vector<MasterAction> ModbusParser::parse(const Words& words) {
  return parse_with(*this, std::span<const ModbusVerb>(kModbusVerbs), words, "read 40001:10");
}

void ModbusParser::add(const Bytes& pdu, About about) {
  about.answered = check(pdu);
  about.format = format_;
  WordParser::add(std::make_shared<ModbusRequest>(serial::to_frame(modbus::rtu_frame(station_, pdu)), about));
}

void ModbusParser::add_loopback() {
  const About about{.answered = check(modbus::diagnostics(0, std::array{*loopback_})), .format = format_};
  WordParser::add(std::make_shared<Loopback>(station_, about, loopback_));
}

bool ModbusParser::check(const Bytes& pdu) const {
  const std::size_t size = pdu.size() + 3;
  if (size > serial::kLongestRawFrame)
    refuse(fmt::format("{}: a frame of {} bytes; {} is the most that can be sent", text_, size, serial::kLongestRawFrame));
  const modbus::FunctionRow* row = modbus::find_function(pdu[0]);
  std::string why = beyond_limits_ ? std::string() : modbus::beyond_limits(pdu);
  if (!beyond_limits_ && why.empty() && size > modbus::kLongestRtuFrame)
    why = fmt::format("a frame of {} bytes: the specification allows {}", size, modbus::kLongestRtuFrame);
  if (!beyond_limits_ && why.empty() && station_ == modbus::kBroadcast && row != nullptr && !row->broadcast)
    why = fmt::format("station 0 is all stations, and none of them answers a broadcast: function {} ({}) needs one station",
                      pdu[0], row->name);
  if (!why.empty()) refuse(fmt::format("{}: {}{}", text_, why, way_beyond_));
  constexpr std::uint8_t kListenOnly = 4;
  const bool listen_only =
      row != nullptr && row->shape == modbus::Shape::Diagnostics && pdu.size() > 2 && pdu[1] == 0 && pdu[2] == kListenOnly;
  return station_ != modbus::kBroadcast && !listen_only;
}

Words ModbusParser::without_area(const Words& operands) {
  area_ = nullptr;
  for (const modbus::AreaRow& row : modbus::areas())
    if (row.word == operands[0]) {
      area_ = &row;
      if (operands.size() == 1) refuse(fmt::format("{}: write it as {} 0, counted from 0", text_, text_));
      return {operands.begin() + 1, operands.end()};
    }
  return operands;
}

modbus::DataAddress ModbusParser::address(const std::string& text) const {
  if (area_ != nullptr) return {area_->area, word(text, fmt::format("address of {}s", area_->singular))};
  const auto parsed = modbus::parse_address(text);
  if (!parsed)
    refuse(fmt::format("{}; or name the area ({}) and count from 0", parsed.why(),
                       stl::joined(modbus::areas(), &modbus::AreaRow::word)));
  return *parsed;
}

void ModbusParser::read(const Words& operands) {
  for (const std::string& operand : without_area(operands)) {
    const auto parts = split_at(operand, ':');
    const modbus::DataAddress first = address(parts ? parts->first : operand);
    const std::uint16_t count = parts ? word(parts->second, "count") : std::uint16_t{1};
    text_ = area_ != nullptr ? fmt::format("read {} {}", area_->word, operand) : "read " + operand;
    const auto function = static_cast<std::uint8_t>(modbus::row_of(first.area).read);
    Bytes pdu = modbus::read_coils(first.address, count);  // reads differ in nothing but their number
    pdu[0] = function;
    add(pdu, {.first = first, .count = count});
  }
}

void ModbusParser::write(const Words& operands) {
  for (const std::string& operand : without_area(operands)) {
    const auto parts = split_at(operand, '=');
    if (!parts) refuse(fmt::format("'{}': a value is missing; write for example 40001=5", stl::shortened(operand)));
    const modbus::DataAddress first = address(parts->first);
    const modbus::AreaRow& row = modbus::row_of(first.area);
    text_ = area_ != nullptr ? fmt::format("write {} {}", area_->word, operand) : "write " + operand;
    if (!row.write_one) refuse(fmt::format("{}: {}s can only be read", text_, row.singular));
    const auto values = row.bits ? parse_bits(parts->second) : parse_registers(parts->second, format_);
    const bool single = values.size() == 1 && !(row.bits ? always_15_ : always_16_);
    Bytes pdu;
    if (row.bits)
      pdu = single ? modbus::write_coil(first.address, values[0] != 0)
                   : modbus::write_coils(first.address, std::vector<bool>(values.begin(), values.end()));
    else
      pdu = single ? modbus::write_register(first.address, values[0]) : modbus::write_registers(first.address, values);
    add(pdu, {.first = first, .count = static_cast<std::uint16_t>(values.size())});
  }
}

void ModbusParser::loopback(const Words& operands) {
  if (operands.empty())
    add_loopback();
  else
    add(modbus::diagnostics(0, parse_registers(operands[0], {})));
}

void ModbusParser::diagnostics(const Words& operands) {
  const std::uint16_t subfunction = word(operands[0], "subfunction");
  add(modbus::diagnostics(subfunction,
                          operands.size() > 1 ? parse_registers(operands[1], {}) : std::vector<std::uint16_t>{0}));
}

std::vector<Reference> ModbusParser::to_read(const Words& operands, std::uint8_t type) {
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

std::vector<Reference> ModbusParser::to_write(const Words& operands, std::uint8_t type) {
  std::vector<Reference> references;
  for (const std::string& operand : operands) {
    const auto sides = split_at(operand, '=');
    const auto file = sides ? split_at(sides->first, ':') : std::nullopt;
    if (!file)
      refuse(fmt::format("'{}' is not a reference with values; write for example 4:1=10,20", stl::shortened(operand)));
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

void ModbusParser::function(const Words& operands) {
  Bytes pdu{static_cast<std::uint8_t>(parse_number(operands[0], 0, UINT8_MAX, "function"))};
  if (operands.size() > 1) {
    const serial::Frame data = parse_hex(operands[1]);
    if (serial::has_wrong_parity(data)) refuse(fmt::format("{}: wrong parity (p) is for raw frames", text_));
    std::ranges::copy(serial::bytes_of(data), std::back_inserter(pdu));
  }
  if (pdu[0] == 0 || pdu[0] >= modbus::kExceptionFlag) {
    if (!beyond_limits_) refuse(fmt::format("{}: functions are from 1 to 127{}", text_, way_beyond_));
  }
  add(pdu);
}

void ModbusParser::raw(const Words& operands) {
  for (const std::string& operand : operands) {
    serial::Frame frame = parse_hex(operand);
    if (crc_) modbus::append_crc(frame);
    const Bytes bytes = serial::bytes_of(frame);
    const bool broadcast = bytes[0] == modbus::kBroadcast && modbus::crc_ok(bytes);
    const About about{.raw = true, .answered = !broadcast, .format = format_};
    add_raw(operand, bytes[0], std::make_shared<ModbusRequest>(std::move(frame), about));
  }
}

std::string actions_help() {
  std::string text = "Actions, one or several, done in this order; in brackets the functions of Modbus:\n";
  text += verbs_help(std::span<const ModbusVerb>(kModbusVerbs));
  text += "Addresses have 5 or 6 digits, as below; or name the area and count from 0 as on the wire: read holding 0:2\n";
  const auto most = [](modbus::Function function) {
    return modbus::find_function(static_cast<std::uint8_t>(function))->most;
  };
  for (const modbus::AreaRow& row : modbus::areas()) {
    text += fmt::format("  {:05} is the first {:<17} {:<16} up to {} at once", row.base + 1, row.singular, row.word,
                        most(row.read));
    if (row.write_many) text += fmt::format(", {} written", most(*row.write_many));
    text += row.area == modbus::Area::HoldingRegisters ? "; all: 400001 to 465536\n" : "\n";
  }
  return text;
}

std::string form_names() { return stl::joined(value_forms(), &ValueFormName::name); }

std::string fault_of_form(const std::string& name) {
  return std::ranges::any_of(value_forms(), [&](const ValueFormName& known) { return known.name == name; })
             ? std::string()
             : fmt::format("'{}' is not a form; there are {}", stl::shortened(name), form_names());
}

}  // namespace

const Protocol& modbus_protocol() {
  static const Protocol protocol{
      .name = "modbus",
      .meaning = "Modbus RTU, or TCP at modbus-tcp://",
      .station = 1,
      .format = {},
      .over_modbus_tcp = true,
      .options = {{kAs, "FORM", "how registers are shown: " + form_names(), std::string(value_forms().front().name),
                   fault_of_form},
                  {kLowWordFirst, "", "in values of 32 bits the first register is the low one"},
                  {kAlways15, "", "write single coils with function 15 too"},
                  {kAlways16, "", "write single registers with function 16 too"},
                  {kCrc, "", "append the CRC to raw frames"},
                  {kBeyondLimits, "", "send what the specification forbids, to test a slave"}},
      .actions_help = actions_help(),
      .action_words = verb_words(std::span<const ModbusVerb>(kModbusVerbs)),
      .actions = [](const Words& words, const ProtocolUse& use) { return ModbusParser(use).parse(words); },
      .is_complete = modbus::crc_ok,
      .choices = "--timeout, --silence [M16]",
      .refusal = "exception",
      .plcs = westinghouse::find_plc("modbus")};
  return protocol;
}

}  // namespace s7200::tools
