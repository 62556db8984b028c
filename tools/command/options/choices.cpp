#include "tools/command/options/choices.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

namespace s7200::tools {
namespace {

/// CLI11 tells the end of the list by an exception.
const CLI::Validator* validator_at(CLI::Option& option, int index) {
  try {
    return option.get_validator(index);
  } catch (const CLI::OptionNotFound&) {
    return nullptr;
  }
}

/// A validator that takes everything. In its name: the description is printed in the help.
CLI::Option* name_in_validator(CLI::Option* option, const std::string& name) {
  return option->check([](const std::string&) { return std::string(); }, "", name);
}

constexpr std::string_view kFiles = "a file or ";

constexpr std::string_view kWith = "with ";

/// The value of an option; empty if it is not there.
std::string given_in(const std::vector<std::string>& words, const std::string& option) {
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i] == option) return words[i + 1];
    if (words[i].starts_with(option + "=")) return words[i].substr(option.size() + 1);
  }
  return {};
}

/// Of `with --protocol\nmodbus {read,write}\nppi {read,run}` the set for what the option is given.
std::string set_with(const std::string& sets, const std::vector<std::string>& words) {
  const auto lines = CLI::detail::split(sets, '\n');
  const std::string wanted = given_in(words, lines.front().substr(kWith.size())) + ' ';
  const auto found =
      std::find_if(lines.begin() + 1, lines.end(), [&](const auto& line) { return line.starts_with(wanted); });
  const std::string& line = found == lines.end() ? lines.at(1) : *found;
  return line.substr(line.find(' ') + 1);
}

/// `{even,none,odd}`, as CLI::IsMember describes itself.
bool is_set(const std::string& text) { return text.starts_with('{') && text.ends_with('}'); }

}  // namespace

CLI::Option* offer(CLI::Option* option, const std::vector<std::string>& values) {
  return name_in_validator(option, CLI::detail::generate_set(values));
}

CLI::Option* offer_beside_files(CLI::Option* option, const std::vector<std::string>& values) {
  return name_in_validator(option, std::string(kFiles) + CLI::detail::generate_set(values));
}

CLI::Option* offer_with(CLI::Option* option, const std::string& other, const std::vector<OfferedWith>& offers) {
  std::string name = std::string(kWith) + other;
  for (const OfferedWith& each : offers) name += fmt::format("\n{} {}", each.value, CLI::detail::generate_set(each.values));
  return name_in_validator(option, name);
}

std::vector<std::string> offered_by(CLI::Option& option, const std::string& typed, const std::vector<std::string>& words) {
  for (int i = 0; const CLI::Validator* validator = validator_at(option, i); ++i)
    for (std::string set : {validator->get_name(), validator->get_description()}) {
      if (set.starts_with(kWith)) set = set_with(set, words);
      if (set.starts_with(kFiles)) set.erase(0, typed.empty() ? 0 : kFiles.size());
      if (is_set(set)) return CLI::detail::split(set.substr(1, set.size() - 2), ',');
    }
  return {};
}

}  // namespace s7200::tools
