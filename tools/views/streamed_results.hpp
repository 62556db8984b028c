// The results of a verb whose list grows as long as it runs: printed as they come, so that they need no memory. The text is
// what lines_of() would make of the whole.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace s7200::tools {

class StreamedResults {
 public:
  /// `list` is the key of the list that follows the keys of `results`. `indent` is the indentation if this is an entry of
  /// another list.
  StreamedResults(nlohmann::ordered_json results, std::string_view list, std::size_t indent = 0);

  /// The text to print next: for one more entry of the list, ...
  std::string entry(const nlohmann::ordered_json& entry);
  /// ... before an entry that comes in pieces, ...
  std::string before_entry();
  /// ... and for the end, with the keys that follow the list.
  std::string end(const nlohmann::ordered_json& rest);

 private:
  std::string head() const;
  std::string key_and_value(const std::string& key, const nlohmann::ordered_json& value) const;

  nlohmann::ordered_json results_;
  std::string list_;
  std::size_t indent_;
  bool any_ = false;
};

}  // namespace s7200::tools
