#include "tools/command/options/plc/plc_key_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "tools/command/options/help_groups.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools {
namespace {

const char* heading_of(PlcKey::Group group) {
  switch (group) {
    case PlcKey::Group::More:
      break;
    case PlcKey::Group::Memory:
      return help_group::kMemory;
    case PlcKey::Group::Results:
      return help_group::kResults;
  }
  return help_group::kMore;
}

std::string in_one_line(const WrongValueOfKey& wrong) {
  return wrong.hint.empty() ? wrong.message : fmt::format("{}; {}", wrong.message, wrong.hint);
}

CLI::Option* add_option(CLI::App& app, const PlcKey& key, std::vector<std::string>& values) {
  const std::string name = option_of(key.name);
  switch (key.shape) {
    case PlcKey::Shape::Flag:
      return app.add_flag_callback(
          name, [&values] { values = {"true"}; }, key.option.text);
    case PlcKey::Shape::List:
    case PlcKey::Shape::Map:
      return app.add_option(name, values, key.option.text)->allow_extra_args(false);
    case PlcKey::Shape::Value:
    case PlcKey::Shape::Read:
    case PlcKey::Shape::Written:
      break;
  }
  const auto take = [&values, &key](const std::string& value) {
    PlcSettings alone;
    if (const WrongValueOfKey wrong = key.take(alone, value, nullptr); !wrong.message.empty())
      throw CLI::ValidationError(option_of(key.name), in_one_line(wrong));
    values = {value};
  };
  return app.add_option_function<std::string>(name, take, key.option.text);
}

/// The items of `VW10,VW20` for a list and of `VW10=1,VW12=2` for a map; quoted text stays whole.
std::vector<std::string> items_of(const PlcKey& key, const std::string& value) {
  const bool list = key.shape == PlcKey::Shape::List, map = key.shape == PlcKey::Shape::Map;
  return list || map ? parts_between_commas(value, map) : std::vector<std::string>{value};
}

}  // namespace

void PlcKeyOptions::add_to(CLI::App& app, PlcKey::Stage stage) {
  for (const PlcKey& key : plc_keys()) {
    if (!key.is_option() || key.stage != stage) continue;
    CLI::Option* const option = add_option(app, key, given_.emplace_back(Given{&key}).values);
    option->group(heading_of(key.option.group));
    if (key.shape != PlcKey::Shape::Flag) option->type_name(std::string(key.option.type));
    if (!key.option.needs.empty()) option->needs(app.get_option(option_of(key.option.needs)));
    if (!key.option.excludes.empty()) option->excludes(app.get_option(option_of(key.option.excludes)));
  }
}

bool PlcKeyOptions::given(std::string_view key) const {
  return std::ranges::any_of(given_, [&](const Given& each) { return each.key->name == key && !each.values.empty(); });
}

bool PlcKeyOptions::read(PlcSettings& settings, const AddressSpace* space) const {
  for (const auto& [key, values] : given_)
    for (const std::string& value : values)
      for (const std::string& item : items_of(*key, value))
        if (const WrongValueOfKey wrong = key->take(settings, item, space); !wrong.message.empty())
          return print_error(fmt::format("{}: {}", option_of(key->name), in_one_line(wrong))), false;
  return true;
}

}  // namespace s7200::tools
