#include "tools/plan/program_cpu.hpp"

#include <fmt/format.h>

#include <optional>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/loading/cpu_choice.hpp"
#include "interpreter/stl/tables/symbols.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {
namespace {

/// A complaint about the file, at its line.
ProgramCpu wrong(const std::string& file, std::uint32_t line, const std::string& why) {
  return {.why = fmt::format("{}:{}: {}", stl::printable(file), line, why)};
}

ProgramCpu read_settings(const std::string& file, const FileSource& files) {
  const auto text = files.read_text(file);
  if (!text) return {.why = fmt::format("cannot read {}: {}", stl::printable(file), text.why())};
  stl::Diagnostics diagnostics;
  const auto source = source_of(*text, file);
  const auto root = read_yaml(*text, *source, diagnostics, {"the settings of a folder", "'cpu:'"});
  if (!root) return wrong(file, diagnostics.front().position.line, diagnostics.front().message);
  if (!root->is_map()) return wrong(file, 1, "write for example cpu: 224");
  for (const YamlNode& key : root->keys)
    if (key.text != "cpu")
      return wrong(file, key.position.line,
                   fmt::format("there is no setting '{}'; a folder has one: cpu", stl::printable(stl::shortened(key.text))));
  YamlValues values(diagnostics);
  const auto name = values.optional_text(*root, "cpu");
  if (!name) return wrong(file, 1, "write for example cpu: 224");
  const CpuModel* const model = find_cpu(*name);
  if (!model)
    return wrong(file, root->find("cpu")->position.line,
                 fmt::format("there is no model of CPU '{}'; modelled: {}", stl::printable(stl::shortened(*name)),
                             stl::joined(all_cpus(), &CpuModel::name)));
  return {.model = model};
}

/// Of one that is not modelled, or of the CN series.
std::string note_on_head(const std::string& in_head, const std::string& file, const CpuModel& taken) {
  if (in_head.empty()) return {};
  constexpr std::string_view kSeries = " CN";
  if (in_head.ends_with(kSeries) && taken.name.starts_with(in_head.substr(0, in_head.size() - kSeries.size())))
    return fmt::format("{} names a CPU {} in its head, which is taken for a CPU {}", file, in_head, taken.name);
  return fmt::format("{} names a CPU {} in its head, which is not modelled; CPU {} is assumed, --cpu names another", file,
                     stl::shortened(in_head), taken.name);
}

}  // namespace

ProgramCpu cpu_of_program(const SourceText& text, const std::string& path, const FileSource& files) {
  const std::string name = stl::printable(text.parsed.source.name), in_head = unmodelled_cpu_in_head(text.parsed.source);
  if (const CpuModel* named = cpu_in_head(text.parsed.source))
    return {.model = named, .note = note_on_head(in_head, name, *named)};
  const std::string settings = beside(path, std::string(kFolderSettings));
  if (!is_standard_input(path) && files.exists(settings)) return read_settings(settings, files);
  const CpuModel& first = first_cpu_for(text.parsed);
  if (!in_head.empty()) return {.model = &first, .note = note_on_head(in_head, name, first)};
  const bool said = !stl::symbol_of_smart(text.parsed.source).empty() && &first == &cpu226();  // in a note of the text
  if (&first == &cpu214() || said) return {.model = &first};
  return {.model = &first,
          .note = fmt::format("{} does not run on a CPU 214; CPU {} is assumed, --cpu names another", name, first.name)};
}

}  // namespace s7200::tools
