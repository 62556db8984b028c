#include "tools/faces/page/engine/carried_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/json/hex_bytes.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/rig/memory_json.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools::page {
namespace {

// YAML as JSON: maps, lists, and scalars as they were written.

Json tree_json(const YamlNode& node) {
  if (node.is_scalar()) return node.text;
  Json json = node.is_map() ? Json::object() : Json::array();
  for (std::size_t i = 0; i < node.items.size(); ++i)
    if (node.is_map())
      json[node.keys[i].text] = tree_json(node.items[i]);
    else
      json.push_back(tree_json(node.items[i]));
  return json;
}

YamlNode scalar(std::string text) {
  YamlNode node;
  node.text = std::move(text);
  return node;
}

YamlNode tree_from(JsonTaker& taker, const Json& json, int depth = 0) {
  if (!json.is_structured()) return scalar(taker.text(json));
  YamlNode node;
  node.kind = json.is_object() ? YamlNode::Kind::Map : YamlNode::Kind::List;
  if (depth == kDeepestYaml) return taker.fail("a system with too many maps in each other"), node;
  for (const auto& [key, value] : json.items()) {
    if (json.is_object()) node.keys.push_back(scalar(key));
    node.items.push_back(tree_from(taker, value, depth + 1));
  }
  return node;
}

/// Text as it is, other bytes in hex.
Json file_json(const std::string& name, const std::string& bytes) {
  if (stl::is_valid_utf8(bytes) && bytes.find('\0') == std::string::npos) return {{"name", name}, {"text", bytes}};
  return {{"name", name}, {"hex", plain_hex({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()})}};
}

class CarriedFiles final : public FileSource {
 public:
  CarriedFiles(JsonTaker& taker, const Json& files) {
    for (const Json& file : files) {
      const bool in_hex = JsonTaker::has(file, "hex");
      auto bytes = in_hex ? bytes_of_hex(taker.text_at(file, "hex")) : std::optional(taker.text_at(file, "text"));
      if (!bytes) taker.fail("a file in something else than hex");
      bytes_[taker.text_at(file, "name")] = bytes.value_or("");
    }
  }

  Result<std::string> read(const std::string& path) const override {
    const auto found = bytes_.find(path);
    if (found != bytes_.end()) return found->second;
    return Trouble{"the report does not carry it"};
  }
  bool exists(const std::string& path) const override { return bytes_.contains(path); }

 private:
  std::map<std::string, std::string> bytes_{};
};

Json spot_json(const Spot& spot) { return {spot.line, spot.plc, spot.port}; }

Spot take_spot(JsonTaker& taker, const Json& json, const SystemPlan& plan) {
  const Spot spot{.line = taker.number<std::size_t>(taker.element(json, 0)),
                  .plc = taker.number<std::size_t>(taker.element(json, 1)),
                  .port = taker.number<std::uint8_t>(taker.element(json, 2))};
  const bool is_there =
      spot.line < plan.lines.size() && spot.plc < plan.plcs.size() && spot.port < plan.plcs[spot.plc].program->model->ports;
  if (!is_there) taker.fail("a place that the system has not");
  return is_there ? spot : Spot{};
}

void take_kept(JsonTaker& taker, const Json& list, SystemPlan& plan) {
  if (list.size() > plan.plcs.size()) return taker.fail("memory of PLCs that the system has not");
  for (std::size_t plc = 0; plc < list.size(); ++plc)
    if (!list[plc].empty()) plan.plcs[plc].kept = take_kept_memory(taker, list[plc], *plan.plcs[plc].program->model);
}

}  // namespace

Json system_json(const CarriedSystem& system) {
  Json json{{"name", system.path}, {"tree", tree_json(system.root)}, {"files", Json::array()}};
  for (const auto& [name, bytes] : system.files) json["files"].push_back(file_json(name, bytes));
  for (const Spot& spot : system.spots) json["spots"].push_back(spot_json(spot));
  if (!system.kept.empty()) json["kept"] = Json::array();
  for (std::size_t plc = 0; plc < system.kept.size(); ++plc) {
    Json one = Json::object();
    if (system.kept[plc]) add_kept_memory(one, *system.kept[plc], *system.models[plc]);
    json["kept"].push_back(std::move(one));
  }
  return json;
}

Result<OpenedSystem> system_from(const Json& json) {
  JsonTaker taker;
  const std::string path = taker.text_at(json, "name");
  const YamlNode root = tree_from(taker, taker.member(json, "tree"));
  const CarriedFiles files(taker, taker.list_at(json, "files"));
  if (!taker.fine()) return Trouble{taker.why()};
  SystemFile file = read_system(root, path, files);
  if (!file.ok()) {
    const auto& all = file.file.diagnostics;
    const auto error = std::ranges::find(all, stl::Severity::Error, &stl::Diagnostic::severity);
    return trouble("{}: {}", stl::printable(path), error->message);
  }
  OpenedSystem opened{.plan = std::move(file.plan)};
  if (JsonTaker::has(json, "kept")) take_kept(taker, taker.list_at(json, "kept"), opened.plan);
  if (JsonTaker::has(json, "spots"))
    for (const Json& spot : taker.list_at(json, "spots")) opened.spots.push_back(take_spot(taker, spot, opened.plan));
  if (!taker.fine()) return Trouble{taker.why()};
  return opened;
}

}  // namespace s7200::tools::page
