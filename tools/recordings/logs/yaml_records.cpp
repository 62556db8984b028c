// Records in YAML, as people and scripts note flows: a list of maps, or a document for each, in block or flow style. Only
// what such records need of YAML is read; no record refers to another.
//
//   - dir: tx
//     data: "01 03 00 00 00 02 C4 0B"
//   - {dir: rx, time: 0.05, data: [0x01, 0x03]}
#include <algorithm>
#include <vector>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/named_fields.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kYamlBinary = "!!binary";

/// The line without its comment: `#` begins one after a blank, outside of quotes.
std::string_view without_yaml_comment(std::string_view line) {
  char quote = '\0';
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (quote != '\0' ? c == quote : c == '"' || c == '\'') quote = quote != '\0' ? '\0' : c;
    if (c == '#' && quote == '\0' && (at == 0 || is_any_of(line[at - 1], " \t"))) return stl::trim_end(line.substr(0, at));
  }
  return stl::trim_end(line);
}

struct KeyAndValue {
  std::string_view key{}, value{};
};

/// `dir: tx`, `"dir": "tx"`, `request:`. The key is a name, so that `10:00:00 TX: 01` is none.
std::optional<KeyAndValue> key_and_value(std::string_view text) {
  const bool quoted = text.starts_with('"') || text.starts_with('\'');
  const std::size_t close = quoted ? text.find(text.front(), 1) : 0;
  if (close == text.npos) return {};
  const std::size_t colon = text.find(':', close);
  if (colon == text.npos || (colon + 1 < text.size() && !is_any_of(text[colon + 1], " \t"))) return {};
  const std::string_view key = quoted ? text.substr(1, close - 1) : stl::trim_end(text.substr(0, colon));
  const auto is_of_name = [](char c) { return is_word_sign(c) || is_any_of(c, ".-@ "); };
  const bool is_name = !key.empty() && !stl::is_digit(key.front()) && std::ranges::all_of(key, is_of_name);
  return is_name ? std::optional(KeyAndValue{key, stl::trim(text.substr(colon + 1))}) : std::nullopt;
}

/// The parts of a text between commas, outside of quotes and brackets.
std::vector<std::string_view> parts_between_commas(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t from = 0, depth = 0;
  char quote = '\0';
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != '\0' ? c == quote : c == '"' || c == '\'') quote = quote != '\0' ? '\0' : c;
    if (quote != '\0') continue;
    if (is_any_of(c, "[{")) ++depth;
    if (is_any_of(c, "]}") && depth > 0) --depth;
    if (c != ',' || depth > 0) continue;
    parts.push_back(stl::trim(text.substr(from, at - from)));
    from = at + 1;
  }
  if (const std::string_view last = stl::trim(text.substr(from)); !last.empty()) parts.push_back(last);
  return parts;
}

/// How many of the brackets in a text are not closed in it.
std::ptrdiff_t open_brackets(std::string_view text) {
  std::ptrdiff_t open = 0;
  char quote = '\0';
  for (const char c : text) {
    if (quote != '\0' ? c == quote : c == '"' || c == '\'') quote = quote != '\0' ? '\0' : c;
    if (quote == '\0') open += is_any_of(c, "[{") ? 1 : is_any_of(c, "]}") ? -1 : 0;
  }
  return open;
}

std::string_view without_yaml_quotes(std::string_view text) {
  const bool quoted = text.size() > 1 && is_any_of(text.front(), "\"'") && text.back() == text.front();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// The bytes of a list: numbers of YAML, `1`, `0x0B`, or pairs of hex digits if each is one and some can be nothing else.
std::optional<Bytes> bytes_of_yaml_list(const std::vector<std::string_view>& items) {
  const auto is_pair = [](std::string_view item) {
    return item.size() == 2 && is_hex_digit(item[0]) && is_hex_digit(item[1]);
  };
  const auto only_pair = [](std::string_view item) {
    return item.front() == '0' || !std::ranges::all_of(item, stl::is_digit);
  };
  std::vector<std::string_view> plain;
  for (const std::string_view item : items) plain.push_back(without_yaml_quotes(item));
  const bool pairs = std::ranges::all_of(plain, is_pair) && std::ranges::any_of(plain, only_pair);
  Bytes bytes;
  for (const std::string_view item : plain) {
    const auto marked = pairs || item.starts_with("0x") || item.starts_with("0X") ? bytes_of_text(item) : std::nullopt;
    const auto number = marked ? std::nullopt : parse_decimal<std::uint8_t>(item);
    if (marked)
      bytes.insert(bytes.end(), marked->begin(), marked->end());
    else if (number)
      bytes.push_back(*number);
    else
      return {};
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

/// Reads a text line by line, and hands each record on once it is complete.
class YamlRecords {
 public:
  explicit YamlRecords(std::string_view text, StopToken stop = {}) : text_(text), stop_(stop) {}

  /// Calls `see` with the fields of each record and the number of its first line, and `other` with the number of each line
  /// that is no YAML of this kind.
  template <typename See, typename Other>
  void read(See see, Other other) {
    std::size_t number = 0;
    const auto flush = [&] {
      end_value();
      if (!fields_.empty()) see(fields_, first_);
      fields_.clear();
      keys_.clear();
    };
    for (const std::string_view whole : Lines(text_, stop_)) {
      ++number;
      if (in_block(whole)) continue;
      const std::string_view line = without_yaml_comment(whole);
      if (stl::trim(line).empty() || line.starts_with('%')) continue;
      if (open_ > 0) {  // a list or a map that goes on
        pending_.append(" ").append(stl::trim(line));
        if ((open_ += open_brackets(line)) <= 0) take_value(pending_);
        continue;
      }
      if (line == "---" || line == "...") {
        flush();
        in_item_ = false;
        continue;
      }
      std::size_t indent = line.find_first_not_of(" \t");
      std::string_view text = line.substr(indent);
      bool item = false;
      while (text.starts_with("- ") || text == "-") {
        item = true;
        const std::size_t next = std::min(text.find_first_not_of(" \t", 1), text.size());
        indent += next;
        text.remove_prefix(next);
      }
      const auto pair = text.starts_with('{') ? std::nullopt : key_and_value(text);
      if (item && !pair && !text.starts_with('{')) {  // of a list of scalars
        list_.emplace_back(text);
        continue;
      }
      if (item) {
        end_value();
        if (!in_item_ && !has_frame(fields_)) fields_.clear();  // settings above the list
        flush();
        in_item_ = true;
        first_ = number;
      }
      if (fields_.empty() && keys_.empty()) first_ = number;
      if (text.starts_with('{')) {
        end_value();
        begin_value("", indent, text);
      } else if (pair) {
        end_value();
        begin_value(pair->key, indent, pair->value);
      } else {
        other(number);
      }
    }
    flush();
  }

 private:
  struct Key {
    std::size_t indent;
    std::string name;
  };

  /// Whether a line belongs to the text of several lines after `|`, `>` or `!!binary |`.
  bool in_block(std::string_view line) {
    if (!block_) return false;
    const std::size_t indent = std::min(line.find_first_not_of(" \t"), line.size());
    if (indent < line.size() && indent <= keys_.back().indent) {
      block_ = false;
      add(block_text_);
      return false;
    }
    block_text_.append(binary_ || block_text_.empty() ? "" : " ").append(stl::trim(line));
    return true;
  }

  void begin_value(std::string_view key, std::size_t indent, std::string_view value) {
    while (!keys_.empty() && keys_.back().indent >= indent) keys_.pop_back();
    keys_.push_back({indent, std::string(key)});
    binary_ = value.starts_with(kYamlBinary);
    if (binary_) value = stl::trim(value.substr(kYamlBinary.size()));
    if (value.starts_with('|') || value.starts_with('>')) {
      block_ = true;
      block_text_.clear();
      return;
    }
    pending_ = value;
    open_ = open_brackets(value);
    if (open_ <= 0 && !value.empty()) take_value(pending_);
  }

  std::string name() const {
    std::string name;
    for (const Key& key : keys_)
      if (!key.name.empty()) name.append(name.empty() ? "" : " ").append(key.name);
    return name + (binary_ ? " base64" : "");
  }

  void add(std::string_view value) {
    const std::string_view plain = without_yaml_quotes(value);
    fields_.push_back({.name = name(), .value = std::string(plain), .quoted = plain.size() < value.size() || binary_});
  }

  void add_list(const std::vector<std::string_view>& items, std::string_view written) {
    fields_.push_back({.name = name(), .value = std::string(written), .bytes = bytes_of_yaml_list(items)});
  }

  /// Takes a scalar, or a list or a map in flow style that is complete.
  void take_value(std::string_view value) {
    constexpr std::size_t kDeepest = 16;
    open_ = 0;
    const std::string_view inner = value.size() > 1 ? value.substr(1, value.size() - 2) : std::string_view();
    if (value.starts_with('[') && value.ends_with(']')) return add_list(parts_between_commas(inner), value);
    if (!value.starts_with('{') || !value.ends_with('}') || keys_.size() > kDeepest) return add(value);
    for (const std::string_view part : parts_between_commas(inner)) {
      const auto pair = key_and_value(part);
      if (!pair) {
        add(part);
        continue;
      }
      keys_.push_back({keys_.back().indent, std::string(pair->key)});
      binary_ = pair->value.starts_with(kYamlBinary);
      take_value(binary_ ? stl::trim(pair->value.substr(kYamlBinary.size())) : pair->value);
      keys_.pop_back();
    }
  }

  /// Ends a list of scalars in lines of their own, or a text of several lines.
  void end_value() {
    if (block_) add(block_text_);
    block_ = false;
    if (!list_.empty() && !keys_.empty()) {
      const std::vector<std::string_view> items(list_.begin(), list_.end());
      std::string written;
      for (const std::string_view item : items) written.append(written.empty() ? "" : " ").append(item);
      add_list(items, written);
    }
    list_.clear();
  }

  std::string_view text_;
  StopToken stop_;
  NamedFields fields_{};
  std::vector<Key> keys_{};  ///< around the value that is being read
  std::vector<std::string> list_{};
  std::string pending_{}, block_text_{};
  std::ptrdiff_t open_ = 0;
  std::size_t first_ = 0;
  bool block_ = false, binary_ = false;
  bool in_item_ = false;
};

/// Whether a text has a row of a list that is a map, `- dir: tx`, `- {dir: tx}`, or several documents.
bool has_marks_of_yaml(std::string_view text) {
  std::size_t documents = 0;
  for (const std::string_view whole : Lines(text)) {
    const std::string_view line = stl::trim(without_yaml_comment(whole));
    documents += line == "---" ? 1U : 0U;
    if (documents > 1) return true;
    if (!line.starts_with("- ")) continue;
    const std::string_view item = stl::trim(line.substr(1));
    if ((item.starts_with('{') && item.find(':') != item.npos) || key_and_value(item)) return true;
  }
  return false;
}

}  // namespace

bool looks_like_yaml_records(std::string_view bytes) {
  const std::string_view beginning = beginning_of(bytes);
  if (!is_text(bytes) || !has_marks_of_yaml(beginning)) return false;
  std::size_t frames = 0, others = 0;
  YamlRecords(beginning).read([&](const NamedFields& fields, std::size_t) { frames += has_frame(fields) ? 1U : 0U; },
                              [&](std::size_t) { ++others; });
  return frames > others;
}

Result<LineRecording> read_yaml_records(std::string_view bytes, const ReadingChoices& choices) {
  NamedFieldsReader reader;
  YamlRecords(bytes, choices.stop)
      .read([&](const NamedFields& fields, std::size_t number) { reader.take(fields, "", number); },
            [&](std::size_t number) { reader.take_other(number); });
  return reader.finish();
}

}  // namespace s7200::tools
