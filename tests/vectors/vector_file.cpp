#include "tests/vectors/vector_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

namespace s7200::vectors {
namespace {

std::optional<std::uint32_t> number(std::string_view text, int base = 10) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

std::optional<std::uint32_t> value_of(std::string_view text) {
  if (text.starts_with("16#")) return number(text.substr(3), 16);
  if (!text.starts_with('-')) return number(text);
  const auto positive = number(text.substr(1));
  if (!positive) return {};
  return 0u - *positive;
}

std::uint32_t element_size(std::string_view area) { return area == "T" || area == "C" ? 2 : 4; }

/// `T33`, `C4.bit`, `AC0`, `HC1`
std::optional<Assignment> parse_numbered(std::string_view text, std::string_view area) {
  text.remove_prefix(area.size());
  const bool of_bit = text.ends_with(".bit");
  if (of_bit) text.remove_suffix(4);
  const auto n = number(text);
  if (!n || (of_bit && element_size(area) == 4)) return {};
  Assignment result{std::string(area)};
  if (of_bit) {
    result.area += ".bit";
    result.at = *n / 8;
    result.bit = static_cast<std::uint8_t>(*n % 8);
    result.width = 0;
  } else {
    result.at = *n * element_size(area);
    result.width = static_cast<std::uint8_t>(element_size(area));
  }
  return result;
}

/// `VW100`, `M0.3`, `PIB0`
std::optional<Assignment> parse_in_bytes(std::string_view text, std::string_view area) {
  text.remove_prefix(area.size());
  Assignment result{std::string(area)};
  if (const std::size_t dot = text.find('.'); dot != std::string_view::npos) {
    const auto byte = number(text.substr(0, dot)), bit = number(text.substr(dot + 1));
    if (!byte || !bit || *bit > 7) return {};
    result.at = *byte;
    result.bit = static_cast<std::uint8_t>(*bit);
    result.width = 0;
    return result;
  }
  const std::size_t size = std::string_view(" BW D").find(text.empty() ? '?' : text[0]);
  const auto byte = number(text.empty() ? text : text.substr(1));
  if (!byte || size == std::string_view::npos || size == 0) return {};
  result.at = *byte;
  result.width = static_cast<std::uint8_t>(size);
  return result;
}

std::optional<Assignment> parse_address(std::string_view text) {
  for (const std::string_view area : {"AC", "HC", "T", "C"})
    if (text.starts_with(area)) return parse_numbered(text, area);
  for (const std::string_view area : {"AI", "AQ", "PI", "PQ", "SM", "S", "I", "Q", "M", "V", "L"})
    if (text.starts_with(area)) return parse_in_bytes(text, area);
  return {};
}

std::string address_text(const Assignment& a) {
  if (a.area.ends_with(".bit")) return fmt::format("{}{}.bit", a.area.substr(0, 1), a.at * 8 + a.bit);
  if (a.area == "T" || a.area == "C" || a.area == "AC" || a.area == "HC")
    return fmt::format("{}{}", a.area, a.at / element_size(a.area));
  if (a.width == 0) return fmt::format("{}{}.{}", a.area, a.at, a.bit);
  return fmt::format("{}{}{}", a.area, a.width == 1 ? 'B' : a.width == 2 ? 'W' : 'D', a.at);
}

// --- times ---

std::int64_t parse_time(std::string_view text) {
  const double scale = text.ends_with(" us") ? 1e3 : text.ends_with(" ms") ? 1e6 : 0;
  double value = 0;
  const char* const last = text.data() + text.size() - std::min<std::size_t>(3, text.size());
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (scale == 0 || error != std::errc{} || end != last) throw std::runtime_error("no time");
  return std::llround(value * scale);
}

std::string time_text(std::int64_t ns) {
  if (ns % 1'000'000 == 0 && ns != 0) return fmt::format("{} ms", ns / 1'000'000);
  return fmt::format("{} us", static_cast<double>(ns) / 1e3);
}

// --- lines ---

std::vector<Assignment> parse_assignments(const std::string& text) {
  std::vector<Assignment> result;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    const auto assignment = parse_assignment(word);
    if (!assignment) throw std::runtime_error("no assignment: " + word);
    result.push_back(*assignment);
  }
  return result;
}

Levels parse_levels(const std::string& text) {
  Levels levels;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    if ((word != "0" && word != "1") || levels.size() == 9) throw std::runtime_error("no logic stack");
    levels.push_back(word == "1");
  }
  return levels;
}

std::uint32_t parse_number(const std::string& text, int base = 10) {
  const auto value = number(text, base);
  if (!value) throw std::runtime_error("no number: " + text);
  return *value;
}

void parse_next(const std::string& text, Vector& vector) {
  vector.ends = text == "end";
  vector.stops = text == "stop";
  if (!vector.ends && !vector.stops) vector.next = parse_number(text);
}

std::string parse_reason(const std::string& text) {
  if (text.empty()) throw std::runtime_error("no reason");
  return text;
}

void read_line(const std::string& key, const std::string& text, Vector& vector) {
  if (key == "op")
    vector.ops.push_back(text);
  else if (key == "before")
    std::ranges::copy(parse_assignments(text), std::back_inserter(vector.before));
  else if (key == "after")
    std::ranges::copy(parse_assignments(text), std::back_inserter(vector.after));
  else if (key == "stack")
    vector.stack = parse_levels(text);
  else if (key == "leaves")
    vector.leaves = parse_levels(text);
  else if (key == "steps")
    vector.steps = parse_number(text);
  else if (key == "until")
    vector.until = parse_time(text);
  else if (key == "next")
    parse_next(text, vector);
  else if (key == "error")
    vector.error = static_cast<int>(parse_number(text, 16));
  else if (key == "fatal")
    vector.fatal = static_cast<int>(parse_number(text, 16));
  else if (key == "time")
    vector.time = parse_time(text);
  else if (key == "source")
    vector.source = text;
  else if (key == "expected_failure")
    vector.expected_failure = parse_reason(text);
  else
    throw std::runtime_error("unknown key " + key);
}

/// Reads line after line and puts finished vectors into the file.
class Reader {
 public:
  void line(const std::string& text, std::size_t number) {
    if (text.empty()) return finish();
    if (text[0] == '#') return comment(text);
    std::istringstream in(text);
    std::string key, rest;
    in >> key >> std::ws;
    std::getline(in, rest);
    if (vector_.ops.empty()) vector_.line = number;
    if (key == "cpu" && in_heading_) {
      file_.cpu = rest;
      return;
    }
    read_line(key, rest, vector_);
  }

  File result() {
    finish();
    return std::move(file_);
  }

 private:
  void comment(const std::string& text) {
    const std::string words = text.substr(std::min<std::size_t>(2, text.size()));
    if (in_heading_)
      file_.heading.push_back(words);
    else
      vector_.title = words;
  }

  void finish() {
    in_heading_ = false;
    vector_.cpu = file_.cpu;
    if (!vector_.ops.empty()) file_.vectors.push_back(std::move(vector_));
    vector_ = {};
  }

  File file_;
  Vector vector_;
  bool in_heading_ = true;
};

std::string levels_text(const Levels& levels) {
  std::string text;
  for (const bool level : levels) text += level ? " 1" : " 0";
  return text.substr(1);
}

std::string assignments_text(std::string_view key, const std::vector<Assignment>& assignments) {
  std::string text, line;
  for (const Assignment& assignment : assignments) {
    const std::string word = to_text(assignment);
    if (line.size() + word.size() > 110) {
      text += fmt::format("{:<6}{}\n", key, line);
      line.clear();
    }
    line += " " + word;
  }
  return line.empty() ? text : text + fmt::format("{:<6}{}\n", key, line);
}

}  // namespace

std::optional<Assignment> parse_assignment(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return {};
  auto result = parse_address(text.substr(0, equals));
  const auto value = value_of(text.substr(equals + 1));
  if (!result || !value) return {};
  result->value = *value;
  return result;
}

std::string to_text(const Assignment& a) {
  const std::string address = address_text(a);
  if (a.width == 0) return fmt::format("{}={}", address, a.value);
  if (a.area == "T" || a.area == "C") return fmt::format("{}={}", address, static_cast<std::int16_t>(a.value));
  return fmt::format("{}=16#{:0{}X}", address, a.value, 2 * a.width);
}

File parse(std::string_view text, const std::string& name) {
  std::istringstream in{std::string(text)};
  Reader reader;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    try {
      reader.line(line, number);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", name, number, error.what()));
    }
  }
  return reader.result();
}

std::string to_text(const File& file) {
  std::string text;
  for (const std::string& line : file.heading) text += "# " + line + "\n";
  if (file.cpu != "214") text += fmt::format("cpu    {}\n", file.cpu);
  for (const Vector& v : file.vectors) {
    text += "\n";
    if (!v.title.empty()) text += "# " + v.title + "\n";
    for (const std::string& op : v.ops) text += "op     " + op + "\n";
    if (v.stack != Levels{true}) text += "stack  " + levels_text(v.stack) + "\n";
    text += assignments_text("before", v.before);
    if (v.steps != 1) text += fmt::format("steps  {}\n", v.steps);
    if (v.until) text += "until  " + time_text(*v.until) + "\n";
    text += assignments_text("after", v.after);
    if (v.leaves) text += "leaves " + levels_text(*v.leaves) + "\n";
    if (v.next) text += fmt::format("next   {}\n", *v.next);
    if (v.ends || v.stops) text += v.ends ? "next   end\n" : "next   stop\n";
    if (v.error != 0) text += fmt::format("error  {:04X}\n", v.error);
    if (v.fatal != 0) text += fmt::format("fatal  {:04X}\n", v.fatal);
    if (v.time) text += "time   " + time_text(*v.time) + "\n";
    text += "source " + v.source + "\n";
    if (!v.expected_failure.empty()) text += "expected_failure " + v.expected_failure + "\n";
  }
  return text;
}

std::string judged(const Vector& vector, const std::string& wrong) {
  if (vector.expected_failure.empty()) return wrong;
  return wrong.empty() ? "  passes although it is an expected failure: remove the mark\n" : "";
}

void keep_marks(const File& from, File& to) {
  const auto text_of = [](Vector vector) {
    vector.expected_failure.clear();
    return to_text(File{.heading = {}, .vectors = {std::move(vector)}});
  };
  for (const Vector& marked : from.vectors) {
    if (marked.expected_failure.empty()) continue;
    for (Vector& vector : to.vectors)
      if (text_of(vector) == text_of(marked)) vector.expected_failure = marked.expected_failure;
  }
}

std::string file_name(std::string_view mnemonic, std::string_view cpu) {
  if (cpu != "214") return file_name(mnemonic).append(".").append(cpu);
  static const std::map<std::string_view, std::string> kWhole{
      {"=", "OUT"},    {"=I", "OUT_I"}, {"+I", "ADD_I"}, {"+D", "ADD_D"}, {"+R", "ADD_R"}, {"-I", "SUB_I"}, {"-D", "SUB_D"},
      {"-R", "SUB_R"}, {"*R", "MUL_R"}, {"/R", "DIV_R"}, {"*I", "MUL_I"}, {"/I", "DIV_I"}, {"*D", "MUL_D"}, {"/D", "DIV_D"}};
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kRelations{
      {{">=", "_GE"}, {"<=", "_LE"}, {"<>", "_NE"}, {"=", "_EQ"}, {"<", "_LT"}, {">", "_GT"}}};
  if (const auto whole = kWhole.find(mnemonic); whole != kWhole.end()) return whole->second;
  for (const auto& [sign, word] : kRelations)
    if (mnemonic.ends_with(sign)) return std::string(mnemonic.substr(0, mnemonic.size() - sign.size())).append(word);
  return std::string(mnemonic);
}

}  // namespace s7200::vectors
