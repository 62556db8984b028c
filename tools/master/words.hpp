// Words of the command line become actions: the common part of all protocols.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/master/protocol.hpp"

namespace s7200::tools {

using Words = std::vector<std::string>;

[[noreturn]] void refuse(const std::string& why);

/// Splits `text` at `separator`; nothing if it has none.
std::optional<std::pair<std::string, std::string>> split_at(const std::string& text, char separator);

/// The parts of `text` between commas, one at least.
std::vector<std::string> split_at_commas(const std::string& text);

/// The numbers of such a list. Throws std::invalid_argument.
std::vector<std::int64_t> values_of(const std::string& text, std::int64_t least, std::int64_t most);

/// The values of bytes, signed or not.
Bytes byte_values_of(const std::string& text);

/// Parses a frame in hex. Throws std::invalid_argument.
serial::Frame parse_hex(const std::string& text);

/// An option that takes one of these words, which live as long as it; without it the first one holds. `kind`: what they are
/// called, `a frame check`.
ProtocolOption word_option(std::string_view name, std::string_view value, std::string meaning, std::string_view kind,
                           std::span<const std::string_view> words);

/// A word that begins an action, the operands it takes, and the member of `Parser` that reads them.
template <class Parser>
struct Verb {
  std::string_view word, operands, meaning;
  std::size_t least, most;  // operands
  void (Parser::*parse)(const Words&);
};

inline constexpr std::size_t kMany = SIZE_MAX;

/// The common part of the parsers of words: a station that an action changes, pauses, and the actions so far.
class WordParser {
 public:
  WordParser(std::uint8_t station, std::uint8_t last_station) : station_(station), last_station_(last_station) {}

  void station(const Words& operands);
  void wait(const Words& operands);

 protected:
  void add(std::shared_ptr<ProtocolRequest> request);
  /// Adds a raw frame; `text` is the frame as the user wrote it.
  void add_raw(const std::string& text, std::uint8_t station, std::shared_ptr<ProtocolRequest> request);

  /// Parses each verb with the words up to the next one. `example` is an action for messages.
  template <class Parser>
  std::vector<MasterAction> parse_with(Parser& parser, std::span<const Verb<Parser>> verbs, const Words& words,
                                       std::string_view example);

  std::string text_;  // of the action at hand
  std::uint8_t station_;

 private:
  std::uint8_t last_station_;
  std::vector<MasterAction> actions_;
};

template <class Parser>
std::vector<MasterAction> WordParser::parse_with(Parser& parser, std::span<const Verb<Parser>> verbs, const Words& words,
                                                 std::string_view example) {
  const auto find_verb = [&](const std::string& word) {
    const auto verb = std::ranges::find_if(verbs, [&](const Verb<Parser>& v) { return v.word == word; });
    return verb == verbs.end() ? nullptr : &*verb;
  };
  if (words.empty()) refuse(fmt::format("nothing to do: give actions, for example {}", example));
  for (std::size_t place = 0; place < words.size();) {
    const Verb<Parser>* verb = find_verb(words[place]);
    if (verb == nullptr)
      refuse(fmt::format("'{}' is not an action; there are {}", stl::shortened(words[place]),
                         stl::joined(verbs, &Verb<Parser>::word)));
    const auto first = words.begin() + static_cast<std::ptrdiff_t>(place) + 1;
    const auto last = std::find_if(first, words.end(), [&](const std::string& word) { return find_verb(word) != nullptr; });
    const Words operands(first, last);
    const std::string form = fmt::format("{}{}{}", verb->word, verb->operands.empty() ? "" : " ", verb->operands);
    if (operands.size() < verb->least) refuse("write it as: " + form);
    if (operands.size() > verb->most)
      refuse(fmt::format("'{}' is neither an action nor part of {}; write it as: {}", stl::shortened(operands[verb->most]),
                         verb->word, form));
    text_ = fmt::format("{}{}{}", verb->word, operands.empty() ? "" : " ", fmt::join(operands, " "));
    (parser.*verb->parse)(operands);
    place += 1 + operands.size();
  }
  return std::move(actions_);
}

template <class Parser>
std::vector<std::string> verb_words(std::span<const Verb<Parser>> verbs) {
  std::vector<std::string> words;
  for (const Verb<Parser>& verb : verbs) words.emplace_back(verb.word);
  return words;
}

/// A table of the verbs for people.
template <class Parser>
std::string verbs_help(std::span<const Verb<Parser>> verbs) {
  std::string text;
  for (const Verb<Parser>& verb : verbs)
    text += fmt::format("  {:<38}{}\n", fmt::format("{} {}", verb.word, verb.operands), verb.meaning);
  return text;
}

}  // namespace s7200::tools
