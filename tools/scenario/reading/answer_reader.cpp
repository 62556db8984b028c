#include "tools/scenario/reading/answer_reader.hpp"

#include "interpreter/base/text/text.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

std::optional<Expected> text_expected(ValueReader& values, const YamlNode& map) {
  const auto written = text_inside(values, map);
  if (!written) return {};
  auto pattern = parse_text_pattern(*written);
  if (!pattern) {
    values.wrong(map.items[0], pattern.why(), R"(write for example {text: 'T=\?\?\r'})");
    return {};
  }
  return Expected{.kind = Expected::Kind::Frame, .frame = std::move(*pattern)};
}

}  // namespace

std::optional<Expected> read_expected(ValueReader& values, const YamlNode& node) {
  using Kind = Expected::Kind;
  if (node.is_map()) return text_expected(values, node);
  if (node.is_list()) return Expected{.kind = Kind::Values, .values = read_numbers(values, node, 0xFFFF, true)};
  const auto written = values.text(node);
  if (!written) return {};
  const std::string word = stl::lower_case(*written);
  for (const auto& [name, kind] : {std::pair("silence", Kind::Silence),
                                   {"any", Kind::Any},
                                   {"echo", Kind::Echo},
                                   {"accepted", Kind::Accepted},
                                   {"refused", Kind::Refused}})
    if (word == name) return Expected{.kind = kind};
  if (word.starts_with("exception ")) {
    const auto parsed = parse_number(word.substr(10));
    if (parsed && *parsed > 0 && *parsed <= 0xFF)
      return Expected{.kind = Kind::Exception, .exception = static_cast<std::uint8_t>(*parsed)};
    values.wrong(node, fmt::format("'{}' is not an exception", stl::shortened(*written)), "write for example exception 2");
    return {};
  }
  auto pattern = parse_pattern(*written);
  if (!pattern) {
    values.wrong(
        node, fmt::format("'{}' is not an answer: {}", stl::shortened(*written), pattern.why()),
        word == "none" || word == "nothing"
            ? "write silence"
            : "write hex such as 01 03 .. .., {text: 'OK\\r'}, any, silence, echo, accepted, refused, exception 2, or "
              "values such as [16#1234, 0]");
    return {};
  }
  return Expected{.kind = Kind::Frame, .frame = std::move(*pattern)};
}

std::vector<Expected> read_expectations(ValueReader& values, const YamlNode& node) {
  std::vector<Expected> all;
  const YamlNode* one = node.find("expect");
  const YamlNode* several = node.find("expect_one_of");
  if (one && several) values.wrong(*several, "both 'expect' and 'expect_one_of'");
  if (one) {
    if (auto expected = read_expected(values, *one)) all.push_back(std::move(*expected));
  } else if (several && !several->is_list()) {
    values.wrong(*several, "'expect_one_of' is a list, not " + to_text(*several),
                 "write for example [silence, exception 3]");
  } else if (several && several->items.empty()) {
    values.wrong(*several, "'expect_one_of' expects nothing", "write for example [silence, exception 3]");
  } else if (several) {
    for (const YamlNode& each : several->items)
      if (auto expected = read_expected(values, each)) all.push_back(std::move(*expected));
  }
  return all;
}

std::optional<std::string> text_inside(ValueReader& values, const YamlNode& map) {
  if (map.keys.size() == 1 && map.keys[0].text == "text") return values.text(map.items[0]);
  values.wrong(map, "a map here is {text: ...} and nothing else", R"(write for example {text: 'HELLO\r'})");
  return {};
}

std::vector<std::optional<std::uint16_t>> read_numbers(ValueReader& values, const YamlNode& list, std::int64_t largest,
                                                       bool any_allowed) {
  std::vector<std::optional<std::uint16_t>> found;
  if (!list.is_list()) {
    values.wrong(list, "values are a list, not " + to_text(list), "write for example [16#1234, 0]");
    return found;
  }
  constexpr std::size_t kMost = 2040;  // bits that 255 bytes hold
  if (list.items.size() > kMost) values.wrong(list, fmt::format("more than {} values", kMost));
  for (const YamlNode& item : list.items) {
    if (any_allowed && item.is_scalar() && item.text == "..") {
      found.push_back(std::nullopt);
    } else if (const auto one = values.number(&item, largest == 1 ? 0 : -0x8000, largest)) {
      found.push_back(static_cast<std::uint16_t>(*one));
    }
  }
  return found;
}

}  // namespace s7200::tools
