#include "tools/command/reports/reported_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "interpreter/base/file_path.hpp"
#include "tools/host/files/files.hpp"
#include "tools/plan/reading/system_reader.hpp"

namespace s7200::tools {
namespace {

/// Files of this computer; what was read is kept.
class ReadFiles final : public FileSource {
 public:
  Result<std::string> read(const std::string& path) const override {
    auto bytes = host_files().read(path);
    if (bytes) read_[path] = *bytes;
    return bytes;
  }
  bool exists(const std::string& path) const override { return host_files().exists(path); }

  std::map<std::string, std::string> taken() && { return std::move(read_); }

 private:
  mutable std::map<std::string, std::string> read_{};
};

/// Says the CPU of each PLC, which a file of the folder may have decided.
void name_cpus(YamlNode& root, const SystemPlan& plan) {
  const auto list = std::ranges::find(root.keys, "plcs", &YamlNode::text);
  if (list == root.keys.end()) return;
  YamlNode& plcs = root.items[static_cast<std::size_t>(list - root.keys.begin())];
  for (std::size_t i = 0; i < plcs.items.size(); ++i) {
    YamlNode& map = plcs.items[i];
    const std::string& name = plcs.keys[i].text;
    const auto plc = std::ranges::find_if(
        plan.plcs, [&](const PlcPlan& one) { return one.name == name || one.name == name + "1"; });  // the first of `copies`
    if (map.find("cpu") || plc == plan.plcs.end()) continue;
    map.keys.push_back({.text = "cpu"});
    map.items.push_back({.text = std::string(plc->program->model->name)});
  }
}

}  // namespace

Result<std::shared_ptr<const page::CarriedSystem>> reported_system(const std::string& path, const SystemPlan& plan,
                                                                   std::vector<Spot> spots) {
  const auto text = read_text(path);
  if (!text) return trouble("cannot read {}: {}", path, text.why());
  SystemFile read;
  auto root = read_yaml(*text, *source_of(*text, path), read.file.diagnostics, kSystemDocument);
  const ReadFiles files;
  if (root) read = read_system(*root, path, files);
  if (!root || !read.ok()) return trouble("{} is another file by now", path);
  name_cpus(*root, read.plan);
  page::CarriedSystem system{.path = file_path(path).generic_string(), .root = std::move(*root)};
  system.files = ReadFiles(files).taken();
  for (const PlcPlan& plc : plan.plcs) {
    system.models.push_back(plc.program->model);
    system.kept.push_back(plc.kept);
  }
  if (std::ranges::none_of(system.kept, [](const auto& kept) { return kept.has_value(); })) system.kept.clear();
  system.spots = std::move(spots);
  return std::make_shared<const page::CarriedSystem>(std::move(system));
}

}  // namespace s7200::tools
