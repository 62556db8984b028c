#include "tools/plan/reading/plc_key_reader.hpp"

#include <fmt/format.h>

#include "tools/yaml/names.hpp"

namespace s7200::tools {

void PlcKeyReader::read(const YamlNode& map, PlcKey::Stage stage, const AddressSpace& space, PlcSettings& settings) {
  for (const PlcKey& key : plc_keys()) {
    const bool may_stand = in_system_ ? key.of_system : key.of_scenario;
    if (key.take && may_stand && key.stage == stage && map.find(key.name)) read_key(map, key, space, settings);
  }
}

void PlcKeyReader::take(const YamlNode& place, const PlcKey& key, const std::string& text, const AddressSpace& space,
                        PlcSettings& settings) {
  WrongValueOfKey wrong = key.take(settings, text, &space);
  if (!wrong.message.empty()) values_.wrong(place, std::move(wrong.message), std::move(wrong.hint));
}

void PlcKeyReader::read_key(const YamlNode& map, const PlcKey& key, const AddressSpace& space, PlcSettings& settings) {
  using Shape = PlcKey::Shape;
  const YamlNode& node = *map.find(key.name);
  if (!key.option.needs.empty() && !map.find(key.option.needs))
    values_.wrong(node, fmt::format("there is no '{}' that it could be about", key.option.needs));
  const bool is_of_shape = key.shape == Shape::List ? node.is_list() : key.shape != Shape::Map || node.is_map();
  if (!is_of_shape)
    return values_.wrong(
        node, fmt::format("'{}' is a {}, not {}", key.name, key.shape == Shape::List ? "list" : "map", to_text(node)),
        fmt::format("write for example {}: {}", key.name, key.example));
  switch (key.shape) {
    case Shape::Value:
      if (const auto text = name_from(node, values_); text && (!text->empty() || node.text.empty()))
        take(node, key, *text, space, settings);
      return;
    case Shape::Flag:
      if (values_.truth(&node)) take(node, key, "true", space, settings);
      return;
    case Shape::List:
      for (const YamlNode& item : node.items)
        if (const auto text = values_.text(item)) take(item, key, *text, space, settings);
      return;
    case Shape::Map:
      for (std::size_t i = 0; i < node.keys.size(); ++i)
        if (const auto value = values_.text(node.items[i]))
          take(node.keys[i], key, fmt::format("{}={}", node.keys[i].text, *value), space, settings);
      return;
    case Shape::Read:
    case Shape::Written: {
      const std::string path = path_(map, key.name);
      if (!path.empty() && (key.shape == Shape::Read || may_write_(node, path))) take(node, key, path, space, settings);
      return;
    }
  }
}

}  // namespace s7200::tools
