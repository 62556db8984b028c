#include "tools/scenario_yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "interpreter/stl/text.hpp"

namespace s7200::tools {
namespace {

/// Nothing more can be made of the text.
struct Unreadable {
  stl::Diagnostic diagnostic;
};

/// yaml-cpp counts from 0, and bytes.
stl::Position place(const YAML::Mark& mark, const stl::Source& source) {
  if (mark.is_null()) return {};
  const auto line = static_cast<std::size_t>(std::max(0, mark.line));
  const auto bytes = static_cast<std::size_t>(std::max(0, mark.column));
  if (line >= source.text.size()) return {static_cast<std::uint32_t>(source.text.size()), 0, 1};
  const std::size_t column = stl::count_characters(std::string_view(source.text[line]).substr(0, bytes));
  return {static_cast<std::uint32_t>(line + 1), static_cast<std::uint32_t>(column + 1), 1};
}

class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(const stl::Source& source, stl::Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {}

  std::optional<YamlNode> take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { scalar(mark, "", anchor, ""); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { no_aliases(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) override {
    scalar(mark, tag, anchor, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(YamlNode::Kind::List, mark, tag, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(YamlNode::Kind::Map, mark, tag, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    YamlNode node;
    bool key_next = true;  ///< of a map
  };

  [[noreturn]] void fail(const YAML::Mark& mark, std::string message, std::string hint) const {
    throw Unreadable{{stl::Severity::Error, place(mark, source_), std::move(message), std::move(hint)}};
  }
  [[noreturn]] void no_aliases(const YAML::Mark& mark) const {
    fail(mark, "anchors and aliases (& and *) have no place in a scenario", "repeat steps with 'for:' or 'repeat:'");
  }

  void look_at(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != 0) no_aliases(mark);
    if (!tag.empty() && tag != "?" && tag != "!")
      fail(mark, "tags (!) have no place in a scenario", "put quotation marks around a text that begins with !");
    if (++nodes_ > kMostYamlNodes)
      fail(mark, fmt::format("more than {} values in one file", kMostYamlNodes), "divide it into several files");
  }

  void scalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) {
    look_at(mark, tag, anchor);
    YamlNode node{.position = place(mark, source_), .text = value};
    node.position.length = underline(node);
    add(std::move(node));
  }

  /// As many characters as stand there, as far as they do.
  std::uint32_t underline(const YamlNode& node) const {
    if (node.position.column == 0) return 1;
    const std::size_t rest = stl::count_characters(source_.text[node.position.line - 1]) - (node.position.column - 1);
    return static_cast<std::uint32_t>(
        std::clamp<std::size_t>(stl::count_characters(node.text), 1, std::max<std::size_t>(1, rest)));
  }

  void begin(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    look_at(mark, tag, anchor);
    if (open_.size() == kDeepestYaml)
      fail(mark, fmt::format("more than {} maps and lists inside each other", kDeepestYaml), "");
    open_.push_back({.node = {.kind = kind, .position = place(mark, source_)}});
  }
  void end() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(node));
  }

  void add(YamlNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.is_list()) {
      parent.node.items.push_back(std::move(node));
    } else if (std::exchange(parent.key_next, !parent.key_next)) {
      add_key(parent.node, std::move(node));
    } else {
      parent.node.items.push_back(std::move(node));
    }
  }

  void add_key(YamlNode& map, YamlNode key) {
    if (!key.is_scalar() || key.text.empty())
      throw Unreadable{{stl::Severity::Error, key.position, "a key is a word, not " + to_text(key), ""}};
    if (map.keys.size() == kMostYamlKeys)
      throw Unreadable{{stl::Severity::Error, key.position, fmt::format("more than {} keys in one map", kMostYamlKeys), ""}};
    const auto same = std::find_if(map.keys.begin(), map.keys.end(), [&](const YamlNode& k) { return k.text == key.text; });
    if (same != map.keys.end())
      diagnostics_.push_back(
          {stl::Severity::Error, key.position,
           fmt::format("'{}' stands here a second time, first in line {}", stl::shortened(key.text), same->position.line),
           "a key may stand once in a map; what is to be done several times is a list"});
    map.keys.push_back(std::move(key));
  }

  const stl::Source& source_;
  stl::Diagnostics& diagnostics_;
  std::vector<Open> open_;
  std::optional<YamlNode> root_;
  std::size_t nodes_ = 0;
};

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].text == key) return &items[i];
  return nullptr;
}

std::string to_text(const YamlNode& node) {
  if (node.is_map()) return "a map";
  if (node.is_list()) return "a list";
  return node.text.empty() ? "nothing" : fmt::format("'{}'", stl::shortened(node.text));
}

std::optional<YamlNode> read_yaml(const std::string& text, const stl::Source& source, stl::Diagnostics& diagnostics) {
  const auto fail = [&](stl::Diagnostic diagnostic) {
    diagnostics.push_back(std::move(diagnostic));
    return std::nullopt;
  };
  if (text.size() > kLongestYaml)
    return fail(
        {stl::Severity::Error, {}, fmt::format("longer than {} bytes", kLongestYaml), "divide it into several files"});
  if (!stl::is_valid_utf8(text)) return fail({stl::Severity::Error, {}, "no UTF-8 text", "save it as UTF-8"});
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    TreeBuilder builder(source, diagnostics);
    if (!parser.HandleNextDocument(builder))
      return fail({stl::Severity::Error, {}, "nothing in it", "a scenario has at least 'program:' and 'steps:'"});
    std::optional<YamlNode> root = builder.take();
    if (parser.HandleNextDocument(builder))
      return fail({stl::Severity::Error, builder.take()->position, "a second document", "one document (---) in a file"});
    return root;
  } catch (const Unreadable& unreadable) {
    return fail(unreadable.diagnostic);
  } catch (const YAML::Exception& error) {
    return fail({stl::Severity::Error, place(error.mark, source), "no YAML: " + error.msg, ""});
  }
}

}  // namespace s7200::tools
