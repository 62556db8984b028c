// Objects of JSON: one in each line, after whatever a logger puts before it, or lists of them, also over several lines.
// Nodes of Node-RED, loggers and our own users write such.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/json/json.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/named_fields.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

using json = nlohmann::ordered_json;

constexpr JsonLimits kLimits{.bytes = std::size_t{1} << 20, .depth = 16, .members = 1000};
constexpr std::string_view kLineEnds = "\r\n", kBetween = " \t\r\n,[]";

/// An object, which may go on in lines below its first; or a line with something else, or with an object that has no end.
struct Piece {
  enum class Kind : std::uint8_t { Object, NoEnd, Other } kind = Kind::Other;
  std::string_view before{};  ///< what stands in the line before the object
  std::string_view text{};
  std::size_t number = 0;  ///< of the line
  std::string why{};       ///< it is beyond the limits; empty: nothing is known
};

std::size_t count_lines(std::string_view text) {
  std::size_t lines = 0;
  for (std::size_t at = text.find_first_of(kLineEnds); at != std::string_view::npos;
       at = text.find_first_of(kLineEnds, at + 1))
    lines += text[at] == '\n' || !text.substr(at).starts_with("\r\n");
  return lines;
}

/// The place of an object that begins with `{"` or `{ "`, or with a brace at the end of its line.
std::size_t begin_of_object(std::string_view line) {
  for (std::size_t at = line.find('{'); at != std::string_view::npos; at = line.find('{', at + 1)) {
    const std::size_t next = line.find_first_not_of(" \t", at + 1);
    if (next == std::string_view::npos || line[next] == '"') return at;
  }
  return std::string_view::npos;
}

/// The length of an object up to its last brace; 0 if it does not end within its line, or not far below it. Trouble
/// if it is too deep. A string of JSON ends in its line.
Result<std::size_t> length_of_object(std::string_view text) {
  constexpr std::size_t kFarthest = std::size_t{1} << 16;
  std::size_t depth = 0;
  bool quoted = false, in_first_line = true;
  for (std::size_t i = 0; i < text.size() && (in_first_line || i < kFarthest); ++i) {
    const char c = text[i];
    const bool ends_line = kLineEnds.find(c) != std::string_view::npos;
    in_first_line = in_first_line && !ends_line;
    if (quoted && ends_line) return 0;
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && (c == '{' || c == '['))
      ++depth;
    else if (!quoted && (c == '}' || c == ']'))
      --depth;
    if (depth == 0) return i + 1;
    if (depth > kLimits.depth) return trouble("it is JSON of more than {} maps and lists inside each other", kLimits.depth);
  }
  return 0;
}

/// The pieces of a text, one after the other.
class Pieces {
 public:
  explicit Pieces(std::string_view text) : rest_(text) {}

  /// The next piece; nothing at the end.
  std::optional<Piece> next() {
    pass(std::min(rest_.find_first_not_of(kBetween), rest_.size()));
    if (rest_.empty()) return {};
    const std::string_view line = first_line(rest_);
    const std::size_t begin = begin_of_object(line);
    Piece piece{.text = stl::trim(line), .number = number_};
    std::size_t end = line.size();
    if (begin != std::string_view::npos) {
      const auto object = length_of_object(rest_.substr(begin));
      piece.why = object.why();
      const std::size_t length = object.value_or(0);
      const std::string_view after = first_line(rest_.substr(begin + length));
      const std::size_t more = std::min(after.find_first_not_of(kBetween), after.size());
      const bool ends = length > 0 && (more == after.size() || begin_of_object(after.substr(more)) == 0);
      piece.kind = ends ? Piece::Kind::Object : Piece::Kind::NoEnd;
      piece.before = line.substr(0, begin);
      if (ends) piece.text = rest_.substr(begin, length), end = begin + length;
    }
    pass(end);
    return piece;
  }

 private:
  void pass(std::size_t bytes) {
    number_ += count_lines(rest_.substr(0, bytes));
    rest_.remove_prefix(bytes);
  }

  std::string_view rest_;
  std::size_t number_ = 1;
};

/// Numbers from 0 to 255, or bytes in texts.
std::optional<Bytes> bytes_of_list(const json& list) {
  Bytes bytes;
  for (const json& each : list) {
    if (const auto byte = number_from<std::uint8_t>(each))
      bytes.push_back(*byte);
    else if (const auto some = each.is_string() ? bytes_of_text(each.get_ref<const std::string&>()) : std::nullopt)
      bytes.insert(bytes.end(), some->begin(), some->end());
    else
      return {};
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

/// Adds the fields of an object. Fields of an object within it come with the outer name before their own.
void add_fields(const json& object, const std::string& outer, NamedFields& fields) {
  for (const auto& [key, value] : object.items()) {
    const std::string name = outer.empty() ? key : outer + ' ' + key;
    if (value.is_object())
      add_fields(value, name, fields);
    else if (value.is_array())
      fields.push_back({.name = name, .value = in_one_line(value), .bytes = bytes_of_list(value)});
    else
      fields.push_back({.name = name,
                        .value = value.is_string() ? value.get<std::string>() : in_one_line(value),
                        .quoted = value.is_string()});
  }
}

/// A field of a layer of a packet, as tshark names it with -T json, `tcp.payload`, and with -T ek, `tcp_tcp_payload`; `raw`:
/// in hex, as -T jsonraw and -x write it before the place of its bytes, `tcp.payload_raw`. Empty if it is not there.
std::string field_in(const json& layers, const std::string& layer, const std::string& name, bool raw = false) {
  const auto of_layer = layers.find(layer);
  if (of_layer == layers.end() || !of_layer->is_object()) return {};
  const std::string plain = layer + '.' + name, raw_name = plain + "_raw", of_ek = layer + '_' + layer + '_' + name;
  const auto text = [](const json& value) { return value.is_string() ? value.get<std::string>() : std::string(); };
  if (const auto member = of_layer->find(raw_name);
      raw && member != of_layer->end() && member->is_array() && !member->empty())
    return text(member->front());
  for (const std::string& each : {plain, of_ek})
    if (const auto member = of_layer->find(each); !raw && member != of_layer->end()) return text(*member);
  return {};
}

std::string bytes_in_packet(const json& layers, const std::string& layer, const std::string& name) {
  const std::string plain = field_in(layers, layer, name);
  return plain.empty() ? field_in(layers, layer, name, true) : plain;
}

std::optional<std::uint16_t> port_in(const json& layers, const std::string& name) {
  if (const auto port = parse_decimal<std::uint16_t>(field_in(layers, "tcp", name))) return port;
  const std::string raw = field_in(layers, "tcp", name, true);
  constexpr std::size_t kDigits = 4;
  if (raw.size() != kDigits || !bytes_of_text(raw)) return {};
  return static_cast<std::uint16_t>(hex_number(raw));
}

/// The fields of a packet of tshark -T json, jsonraw or ek and of Wireshark's export: what TCP or a serial line carries. The
/// server has the lower port. Nothing for any other object.
std::optional<NamedFields> fields_of_packet(const json& object) {
  const auto source = object.find("_source");
  const json& packet = source != object.end() && source->is_object() ? *source : object;
  const auto layers = packet.find("layers");
  if (layers == packet.end() || !layers->is_object()) return {};
  NamedFields fields;
  for (const char* const name : {"time_relative", "time_epoch"})
    if (fields.empty() && !field_in(*layers, "frame", name).empty())
      fields.push_back({.name = "time", .value = field_in(*layers, "frame", name), .quoted = true});
  const auto from = port_in(*layers, "srcport"), to = port_in(*layers, "dstport");
  if (from && to) fields.push_back({.name = "dir", .value = *to < *from ? "tx" : "rx", .quoted = true});
  const std::string payload = bytes_in_packet(*layers, "tcp", "payload");
  const std::string data = payload.empty() ? bytes_in_packet(*layers, "data", "data") : payload;
  if (!data.empty()) fields.push_back({.name = "data", .value = data, .quoted = true});
  return fields;
}

/// The records of an object: those in a list that it has, otherwise itself.
void add_records(const json& object, std::vector<NamedFields>& records) {
  if (auto packet = fields_of_packet(object)) return records.push_back(*std::move(packet));
  for (const json& value : object) {
    const bool is_list = value.is_array() && !value.empty() && std::ranges::all_of(value, &json::is_object);
    if (!is_list) continue;
    for (const json& each : value) add_records(each, records);
    return;
  }
  add_fields(object, "", records.emplace_back());
}

/// A number of JSON that no arithmetic holds, `1e400`; empty if there is none.
std::string_view number_too_large(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789", kOfNumber = "0123456789+-.eE";
  bool quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '\\') ++at;
    if (at < text.size() && text[at] == '"') quoted = !quoted;
    if (quoted || at >= text.size() || kDigits.find(text[at]) == std::string_view::npos) continue;
    const std::string_view number = text.substr(at, std::min(text.find_first_not_of(kOfNumber, at), text.size()) - at);
    if (is_real_number(number) && !parse_decimal<double>(number)) return number;
    at += number.size() - 1;
  }
  return {};
}

/// The records of a piece; none if it cannot be read.
std::vector<NamedFields> records_of(const Piece& piece) {
  std::vector<NamedFields> records;
  const auto object = piece.kind == Piece::Kind::Object ? parse_json(piece.text, kLimits) : std::nullopt;
  if (object) add_records(*object, records);
  return records;
}

/// The reason for a piece that has no records.
std::string why_unreadable(const Piece& piece) {
  if (!piece.why.empty()) return piece.why;
  const std::string_view number = number_too_large(piece.text);
  return number.empty() ? not_understood(piece.text)
                        : fmt::format("its number {} is too large", stl::printable(stl::shortened(number)));
}

/// The number of records at the beginning that are so.
std::size_t count_records(std::string_view bytes, bool (*is_so)(const NamedFields& fields)) {
  Pieces pieces(beginning_of(bytes));
  std::size_t count = 0;
  while (const auto piece = pieces.next())
    count += static_cast<std::size_t>(std::ranges::count_if(records_of(*piece), is_so));
  return count;
}

/// Whether a text begins with an object, be it readable or not.
bool begins_with_object(std::string_view bytes) {
  const auto first = Pieces(beginning_of(bytes)).next();
  return first && first->kind != Piece::Kind::Other && first->before.empty() && bytes.find('"') != std::string_view::npos;
}

}  // namespace

bool looks_like_json_lines(std::string_view bytes) {
  if (!is_text(bytes)) return false;
  return begins_with_object(bytes) || count_records(bytes, has_frame) > 0 || count_records(bytes, has_characters) > 0 ||
         count_records(bytes, has_base64) > 0;
}

Result<LineRecording> read_json_lines(std::string_view bytes, const ReadingChoices& choices) {
  NamedFieldsReader reader;
  if (count_records(bytes, has_characters) > 0)
    reader.take_characters();
  else if (count_records(bytes, has_base64) > count_records(bytes, has_frame))
    reader.take_base64();
  Pieces pieces(bytes);
  while (const auto piece = choices.stop.stop_requested() ? std::nullopt : pieces.next()) {
    const auto records = records_of(*piece);
    for (const NamedFields& fields : records) reader.take(fields, piece->before, piece->number);
    if (piece->kind == Piece::Kind::Other)
      reader.take_other(piece->number);
    else if (records.empty())
      reader.take_unreadable(piece->number, why_unreadable(*piece));
  }
  return reader.finish();
}

}  // namespace s7200::tools
