#include "tools/command/options/choices.hpp"

#include <CLI/CLI.hpp>

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

/// `{even,none,odd}`, as CLI::IsMember describes itself.
bool is_set(const std::string& text) { return text.starts_with('{') && text.ends_with('}'); }

}  // namespace

CLI::Option* offer(CLI::Option* option, const std::vector<std::string>& values) {
  // In the name: the description of a validator is printed in the help.
  return option->check([](const std::string&) { return std::string(); }, "", CLI::detail::generate_set(values));
}

std::vector<std::string> offered_by(CLI::Option& option) {
  for (int i = 0; const CLI::Validator* validator = validator_at(option, i); ++i)
    for (const std::string& set : {validator->get_name(), validator->get_description()})
      if (is_set(set)) return CLI::detail::split(set.substr(1, set.size() - 2), ',');
  return {};
}

}  // namespace s7200::tools
