#include "tools/views/streamed_results.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/views/escapes.hpp"

namespace s7200::tools {
namespace {

/// The JSON as a part of a text that is indented by `indent` already.
std::string text_of(const nlohmann::ordered_json& json, std::size_t indent) {
  std::string text = with_escapes(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
    text.insert(at + 1, indent, ' ');
  return text;
}

}  // namespace

StreamedResults::StreamedResults(nlohmann::ordered_json results, std::string_view list, std::size_t indent)
    : results_(std::move(results)), list_(list), indent_(indent) {}

std::string StreamedResults::key_and_value(const std::string& key, const nlohmann::ordered_json& value) const {
  return fmt::format("{:{}}{}: {}", "", indent_ + 2, nlohmann::ordered_json(key).dump(), text_of(value, indent_ + 2));
}

std::string StreamedResults::head() const {
  std::string text = "{\n";
  for (const auto& [key, value] : results_.items()) text += key_and_value(key, value) + ",\n";
  return text + fmt::format("{:{}}\"{}\": [", "", indent_ + 2, list_);
}

std::string StreamedResults::before_entry() {
  const std::string before = any_ ? "," : head();
  any_ = true;
  return fmt::format("{}\n{:{}}", before, "", indent_ + 4);
}

std::string StreamedResults::entry(const nlohmann::ordered_json& entry) {
  return before_entry() + text_of(entry, indent_ + 4);
}

std::string StreamedResults::end(const nlohmann::ordered_json& rest) {
  std::string text = any_ ? fmt::format("\n{:{}}]", "", indent_ + 2) : head() + "]";
  for (const auto& [key, value] : rest.items()) text += ",\n" + key_and_value(key, value);
  return text + fmt::format("\n{:{}}}}{}", "", indent_, indent_ == 0 ? "\n" : "");
}

}  // namespace s7200::tools
