#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "interpreter/base/text/text.hpp"
#include "tools/yaml/yaml.hpp"

namespace s7200::tools {
namespace {

/// Is thrown when no more of the text can be read.
struct Unreadable {
  stl::Diagnostic diagnostic;
};

/// Converts a place of yaml-cpp, which counts from 0, and in bytes.
stl::Position place(const YAML::Mark& mark, const stl::SourceLines& source) {
  if (mark.is_null()) return {};
  const auto line = static_cast<std::size_t>(std::max(0, mark.line));
  const auto bytes = static_cast<std::size_t>(std::max(0, mark.column));
  if (line >= source.text.size()) return {static_cast<std::uint32_t>(source.text.size()), 0, 1};
  const std::size_t column = stl::count_characters(std::string_view(source.text[line]).substr(0, bytes));
  return {static_cast<std::uint32_t>(line + 1), static_cast<std::uint32_t>(column + 1), 1};
}

// --- what the parser complains about ---

/// The end of a complaint, which the name of the document follows.
constexpr std::string_view kNoPlace = "have no place in ";
constexpr std::string_view kNoAliases = "anchors and aliases (& and *) have no place in ";
constexpr std::string_view kNoTags = "tags (!) have no place in ";
constexpr std::string_view kRepeat = "repeat steps with 'for:' or 'repeat:'";
constexpr std::string_view kQuoteIt = "put the text in quotation marks";
constexpr std::string_view kCloseQuotation = "put the same mark after the text; it may not stand inside it";
constexpr std::string_view kNotOfIt = "this does not belong to the map or list before it";
constexpr std::string_view kIndentAlike =
    "the keys of one map, and the '-' of one list, stand below each other; nothing follows a closing quotation mark";

/// The beginning of a message of yaml-cpp, and our words for it.
struct Complaint {
  std::string_view parser, message, hint;
};
const Complaint kComplaints[] = {
    {YAML::ErrorMsg::MAP_VALUE, "no key can stand here; ': ' makes one of what is before it",
     "a text with ': ' in it needs quotation marks; a key begins a line, indented as those of the same map"},
    {YAML::ErrorMsg::BLOCK_ENTRY, "no list can begin here; '- ' begins one", "begin it on a line of its own, below its key"},
    {YAML::ErrorMsg::MAP_KEY, "no key can stand here; '? ' begins one", kQuoteIt},
    {YAML::ErrorMsg::END_OF_MAP_FLOW, "a { that is never closed", "put a } after the last value"},
    {YAML::ErrorMsg::END_OF_SEQ_FLOW, "a [ that is never closed", "put a ] after the last value"},
    {YAML::ErrorMsg::END_OF_MAP, kNotOfIt, kIndentAlike},
    {YAML::ErrorMsg::END_OF_SEQ, kNotOfIt, kIndentAlike},
    {YAML::ErrorMsg::FLOW_END, "this closes nothing that is open here", "each [ has its ], each { its }"},
    {YAML::ErrorMsg::UNKNOWN_TOKEN, "no text begins with this sign unless it is in quotation marks", kQuoteIt},
    {YAML::ErrorMsg::EOF_IN_SCALAR, "a quotation that is never closed", kCloseQuotation},
    {YAML::ErrorMsg::DOC_IN_SCALAR, "a quotation that is never closed", kCloseQuotation},
    {YAML::ErrorMsg::INVALID_ESCAPE, "not an escape of YAML, which reads \\ in double quotation marks",
     "single quotation marks leave the \\ alone: 'HELLO\\r'"},
    {YAML::ErrorMsg::INVALID_HEX, "two hex digits belong after \\x, four after \\u",
     "single quotation marks leave the \\ alone: 'HELLO\\r'"},
    {YAML::ErrorMsg::INVALID_UNICODE, "there is no such character", "write another number after the \\"},
    {YAML::ErrorMsg::ZERO_INDENT_IN_BLOCK, "the indentation of a block is 1 to 9", "write | or > alone"},
    {YAML::ErrorMsg::CHAR_IN_BLOCK, "nothing but 1 to 9, + and - follows | or >", "begin the text on the next line"},
    {YAML::ErrorMsg::ANCHOR_NOT_FOUND, kNoAliases, kQuoteIt},
    {YAML::ErrorMsg::ALIAS_NOT_FOUND, kNoAliases, kQuoteIt},
    {YAML::ErrorMsg::UNKNOWN_ANCHOR, kNoAliases, kRepeat},
    {YAML::ErrorMsg::CHAR_IN_ANCHOR, kNoAliases, kQuoteIt},
    {YAML::ErrorMsg::CHAR_IN_ALIAS, kNoAliases, kQuoteIt},
    {YAML::ErrorMsg::MULTIPLE_ANCHORS, kNoAliases, kRepeat},
    {YAML::ErrorMsg::ALIAS_CONTENT, kNoAliases, kRepeat},
    {YAML::ErrorMsg::CHAR_IN_TAG_HANDLE, kNoTags, kQuoteIt},
    {YAML::ErrorMsg::TAG_WITH_NO_SUFFIX, kNoTags, kQuoteIt},
    {YAML::ErrorMsg::END_OF_VERBATIM_TAG, kNoTags, kQuoteIt},
    {YAML::ErrorMsg::MULTIPLE_TAGS, kNoTags, kQuoteIt},
    {YAML::ErrorMsg::YAML_DIRECTIVE_ARGS, "directives (%) have no place in ", "leave the line out"},
    {YAML::ErrorMsg::YAML_VERSION, "directives (%) have no place in ", "leave the line out"},
    {YAML::ErrorMsg::YAML_MAJOR_VERSION, "directives (%) have no place in ", "leave the line out"},
    {YAML::ErrorMsg::REPEATED_YAML_DIRECTIVE, "directives (%) have no place in ", "leave the line out"},
    {YAML::ErrorMsg::TAG_DIRECTIVE_ARGS, "directives (%) have no place in ", "leave the line out"},
    {YAML::ErrorMsg::REPEATED_TAG_DIRECTIVE, "directives (%) have no place in ", "leave the line out"},
};

/// The column of a tab in the indentation of a line, from 1; 0 if there is none. The '-' of lists is part of the
/// indentation.
std::uint32_t column_of_tab(std::string_view line) {
  const std::size_t tab = line.substr(0, line.find_first_not_of(" \t-")).find('\t');
  return tab == std::string_view::npos ? 0 : static_cast<std::uint32_t>(tab + 1);
}

stl::Diagnostic to_diagnostic(const YAML::Exception& error, const stl::SourceLines& source) {
  stl::Diagnostic diagnostic{stl::Severity::Error, place(error.mark, source), "", ""};
  const std::uint32_t line = diagnostic.position.line;
  const bool in_text = line > 0 && line <= source.text.size();
  if (const std::uint32_t tab = in_text ? column_of_tab(source.text[line - 1]) : 0; tab != 0) {
    diagnostic.position = {line, tab, 1};
    diagnostic.message = "a tab in the indentation: YAML takes blanks only";
    diagnostic.hint = "replace the tabs by blanks; most editors do so for a whole file";
    return diagnostic;
  }
  for (const Complaint& complaint : kComplaints)
    if (std::string_view(error.msg).starts_with(complaint.parser)) {
      diagnostic.message = complaint.message;
      diagnostic.hint = complaint.hint;
      return diagnostic;
    }
  diagnostic.message = "not YAML: " + error.msg;
  diagnostic.hint = "compare the line with the examples in the description of the format";
  return diagnostic;
}

class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(const stl::SourceLines& source, stl::Diagnostics& diagnostics, std::size_t most_nodes)
      : source_(source), diagnostics_(diagnostics), most_nodes_(most_nodes) {}

  std::optional<YamlNode> take() { return std::move(root_); }

  /// The place of the map or list that is being read; nothing at the top.
  std::optional<stl::Position> innermost() const {
    return open_.empty() ? std::nullopt : std::optional(open_.back().node.position);
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  /// A value that is not written has the place of its key; the parser gives the place of what comes next.
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const bool has_key = !open_.empty() && open_.back().node.is_map() && !open_.back().key_next;
    if (!has_key) return scalar(mark, "", anchor, "");
    look_at(mark, "", anchor);
    add({.position = open_.back().node.keys.back().position});
  }
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
  [[noreturn]] void no_aliases(const YAML::Mark& mark) const { fail(mark, std::string(kNoAliases), std::string(kRepeat)); }

  void look_at(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != 0) no_aliases(mark);
    if (!tag.empty() && tag != "?" && tag != "!")
      fail(mark, std::string(kNoTags), "put quotation marks around a text that begins with !");
    if (++nodes_ > most_nodes_)
      fail(mark, fmt::format("more than {} values in one file", most_nodes_), "divide it into several files");
  }

  void scalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) {
    look_at(mark, tag, anchor);
    YamlNode node{.position = place(mark, source_), .text = value};
    if (tag == "!" && !is_closed(node.position))
      fail(mark, "a quotation that is never closed", std::string(kCloseQuotation));
    node.position.length = underline(node);
    node.text_column = text_column(node);
    add(std::move(node));
  }

  std::string_view rest_of_line(const stl::Position& from) const {
    std::string_view rest = source_.text[from.line - 1];
    for (std::uint32_t column = 1; column < from.column; ++column) rest.remove_prefix(stl::first_character(rest).bytes);
    return rest;
  }

  std::uint32_t text_column(const YamlNode& node) const {
    if (node.position.column == 0) return 0;
    const std::string_view rest = rest_of_line(node.position);
    const std::uint32_t mark = rest.starts_with('"') || rest.starts_with('\'') ? 1 : 0;
    return rest.substr(mark).starts_with(node.text) ? node.position.column + mark : 0;
  }

  /// The parser takes the end of the file for the end of a quotation.
  bool is_closed(const stl::Position& begin) const {
    if (begin.column == 0) return true;
    std::size_t line = begin.line - 1;
    std::string_view rest = rest_of_line(begin);
    const char mark = rest.empty() ? ' ' : rest.front();
    if (mark != '\'' && mark != '"') return true;
    for (rest.remove_prefix(1);; rest = source_.text[line]) {
      for (std::size_t i = 0; i < rest.size(); ++i) {
        if (mark == '"' && rest[i] == '\\')
          ++i;
        else if (rest[i] == mark && mark == '\'' && i + 1 < rest.size() && rest[i + 1] == mark)
          ++i;
        else if (rest[i] == mark)
          return true;
      }
      if (++line == source_.text.size()) return false;
    }
  }

  /// The number of characters to underline: those of the node, as far as the line has them.
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

  const stl::SourceLines& source_;
  stl::Diagnostics& diagnostics_;
  std::vector<Open> open_;
  std::optional<YamlNode> root_;
  std::size_t nodes_ = 0, most_nodes_;
};

}  // namespace

std::optional<YamlNode> read_yaml(const std::string& text, const stl::SourceLines& source, stl::Diagnostics& diagnostics,
                                  const YamlDocument& document) {
  const auto fail = [&](stl::Diagnostic diagnostic) {
    if (diagnostic.message.ends_with(kNoPlace)) diagnostic.message += document.name;
    diagnostics.push_back(std::move(diagnostic));
    return std::nullopt;
  };
  if (text.size() > document.bytes)
    return fail(
        {stl::Severity::Error, {}, fmt::format("longer than {} bytes", document.bytes), "divide it into several files"});
  if (!stl::is_valid_utf8(text)) return fail({stl::Severity::Error, {}, "not UTF-8 text", "save it as UTF-8"});
  TreeBuilder builder(source, diagnostics, document.nodes);
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    if (!parser.HandleNextDocument(builder))
      return fail(
          {stl::Severity::Error, {}, "nothing in it", fmt::format("{} has at least {}", document.name, document.least)});
    std::optional<YamlNode> root = builder.take();
    if (parser.HandleNextDocument(builder))
      return fail({stl::Severity::Error, builder.take()->position, "a second document", "one document (---) in a file"});
    return root;
  } catch (const Unreadable& unreadable) {
    return fail(unreadable.diagnostic);
  } catch (const YAML::Exception& error) {
    stl::Diagnostic diagnostic = to_diagnostic(error, source);
    const bool at_the_end = diagnostic.position.column == 0;
    if (const auto open = builder.innermost(); open && at_the_end) diagnostic.position = *open;
    return fail(std::move(diagnostic));
  }
}

}  // namespace s7200::tools
