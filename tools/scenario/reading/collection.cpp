#include "tools/scenario/reading/collection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "interpreter/base/file_path.hpp"
#include "tools/host/files/file_system.hpp"
#include "tools/host/files/files.hpp"
#include "tools/plan/program_cpu.hpp"
#include "tools/scenario/conformance_suite.hpp"
#include "tools/scenario/reading/name_pattern.hpp"
#include "tools/scenario/reading/reader.hpp"
#include "tools/scenario/steps/random_traffic.hpp"
#include "tools/yaml/yaml.hpp"

namespace s7200::tools {
namespace {

namespace fs = std::filesystem;

class Collector {
 public:
  Collector(const SuiteSettings& settings, Messages& messages) : settings_(settings), messages_(messages) {}

  std::optional<std::vector<Scenario>> collect() {
    read_given();
    if (failed_) return {};
    if (!settings_.conformance.empty()) take(std::string(kConformanceSuite), "modbus_rtu_slave.yaml");
    for (const std::string& path : settings_.files) read(path);
    if (failed_) return {};
    if (settings_.random > 0) add_random_traffic();
    for (Scenario& scenario : scenarios_) scenario.line.override_with(settings_.line);
    std::erase_if(scenarios_, [&](const Scenario& s) { return !is_chosen(s); });
    if (scenarios_.empty())
      fail(settings_.only.empty()
               ? "nothing to test: give files or folders, --conformance, or --random with --target"
               : fmt::format("no scenario has '{}' in its name or file; --list shows them", settings_.only));
    return failed_ ? std::nullopt : std::optional(std::move(scenarios_));
  }

 private:
  void fail(std::string text) {
    add_error(messages_, std::move(text));
    failed_ = true;
  }

  void add(const stl::Diagnostics& diagnostics, std::shared_ptr<const stl::SourceLines> source) {
    if (diagnostics.empty()) return;
    messages_.push_back({.kind = Message::Kind::Diagnostics, .diagnostics = diagnostics, .source = std::move(source)});
    failed_ = true;
  }

  std::optional<std::string> text_of(const std::string& path) {
    auto text = read_text(path);
    if (!text) fail(fmt::format("cannot read {}: {}", path, text.why()));
    return std::move(text).if_any();
  }

  /// Values for `${…}`, or the description of a slave.
  void read_given() {
    const std::string& path = settings_.conformance.empty() ? settings_.with : settings_.conformance;
    if (path.empty()) return;
    const auto text = text_of(path);
    if (!text) return;
    stl::Diagnostics diagnostics;
    given_ = read_parameters(*text, path, diagnostics);
    add(diagnostics, source_of(*text, path));
  }

  /// A file, or all those of a folder. What cannot be read ends it, mistakes in one file do not hide those of the next.
  void read(const std::string& path) {
    std::error_code error;
    if (!fs::is_directory(file_path(path), error)) return read_one(path);
    std::vector<std::string> found;
    for (fs::recursive_directory_iterator it(file_path(path), fs::directory_options::skip_permission_denied, error), end;
         it != end && !error; it.increment(error))
      if (is_yaml_file(it->path()) && it->path().filename() != kFolderSettings) found.push_back(it->path().generic_string());
    if (error) return fail(fmt::format("cannot read {}: {}", path, error_text(error)));
    if (found.empty()) return fail(fmt::format("there is no .yaml file in {}", path));
    std::sort(found.begin(), found.end());
    for (const std::string& file : found)
      if (const auto text = text_of(file); text && !is_system(*text)) take(*text, file);
  }

  void read_one(const std::string& path) {
    const auto text = text_of(path);
    if (text && is_system(*text))
      return fail(fmt::format("{0} is a system file, which a scenario names: system: {0}", path));
    if (text) take(*text, path);
  }

  /// System files may stand beside the scenarios that name them.
  static bool is_system(std::string_view text) {
    const auto has = [text](std::string_view key) {
      return text.starts_with(key) || text.find(fmt::format("\n{}", key)) != std::string_view::npos;
    };
    return has("plcs:") || has("lines:");
  }

  void take(const std::string& text, const std::string& path) {
    ScenarioFile file = read_scenarios(text, path, given_ ? &*given_ : nullptr);
    add(file.diagnostics, file.source);
    if (given_ && !file.diagnostics.empty())
      messages_.push_back(
          {.kind = Message::Kind::Note, .text = fmt::format("values for ${{…}} are from {}", given_->source->name)});
    if (given_) add(file.given_diagnostics, given_->source);
    std::set<std::string> told;
    for (const Scenario& scenario : file.scenarios)
      if (!scenario.cpu_note.empty() && told.insert(scenario.cpu_note).second)
        messages_.push_back({.kind = Message::Kind::Note, .text = scenario.cpu_note});
    std::move(file.scenarios.begin(), file.scenarios.end(), std::back_inserter(scenarios_));
  }

  void add_random_traffic() {
    scenarios_.push_back(random_traffic(settings_.random, settings_.seed, settings_.station));
    scenarios_.back().cpu = settings_.random_cpu;
  }

  bool is_chosen(const Scenario& scenario) const {
    if (settings_.only.empty()) return true;
    const std::string anywhere = "*" + settings_.only + "*";
    for (const std::string& text : {scenario.name, scenario.source->name, scenario.rule.id})
      if (matches_pattern(text, anywhere)) return true;
    return false;
  }

  const SuiteSettings& settings_;
  Messages& messages_;
  std::optional<GivenParameters> given_;
  std::vector<Scenario> scenarios_;
  bool failed_ = false;
};

}  // namespace

std::optional<std::vector<Scenario>> collect_scenarios(const SuiteSettings& settings, Messages& messages) {
  return Collector(settings, messages).collect();
}

}  // namespace s7200::tools
