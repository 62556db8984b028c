#include "tools/views/program/check_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "interpreter/program/operands/operands.hpp"

namespace s7200::tools {
namespace {

std::string_view name_of(SourceKind kind) {
  switch (kind) {
    case SourceKind::Document:
      return "document";
    case SourceKind::Blocks:
      return "export";
    case SourceKind::SymbolTable:
      return "symbol table";
    case SourceKind::DataBlock:
      return "data block";
    case SourceKind::StatusChart:
      return "status chart";
    case SourceKind::Listing:
      break;
  }
  return "stl";
}

nlohmann::ordered_json to_json(const stl::Diagnostic& d, const stl::SourceLines& source) {
  const stl::FileLine place = stl::in_file(source, d.position.line);
  nlohmann::ordered_json json{{"severity", d.severity == stl::Severity::Error ? "error" : "warning"}};
  if (!source.further_files.empty()) json["file"] = place.file;
  if (const std::string section = stl::section_at(source, d.position.line); !section.empty()) json["section"] = section;
  json.update({{"line", place.line},
               {"column", d.position.column},
               {"length", d.position.length},
               {"message", d.message},
               {"hint", d.hint},
               {"name", d.name},
               {"cause", d.cause}});
  return json;
}

/// The other CPUs as text: `; fine for CPU 215, 216 or 22x`
std::string other_cpus_text(const std::vector<const CpuModel*>& others) {
  CpuSet fitting = 0;
  for (const CpuModel* model : others) fitting = static_cast<CpuSet>(fitting | model->self);
  return fitting == 0 ? "" : "; fine for " + to_text(fitting);
}

std::vector<std::string_view> names_of(const std::vector<const CpuModel*>& models) {
  std::vector<std::string_view> names;
  for (const CpuModel* model : models) names.push_back(model->name);
  return names;
}

using s7200::counted;

/// The number of errors or warnings with that of their causes: `208 errors with 7 causes`
std::string counted(stl::Severity severity, const stl::Diagnostics& all) {
  stl::Diagnostics of_severity = all;
  std::erase_if(of_severity, [&](const stl::Diagnostic& d) { return d.severity != severity; });
  const std::size_t causes = stl::count_causes(of_severity);
  return counted(of_severity.size(), severity == stl::Severity::Error ? "error" : "warning") +
         (causes == of_severity.size() ? "" : " with " + counted(causes, "cause"));
}

nlohmann::ordered_json stand_ins_json(const CheckResult& result) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const StandIn& stand_in : stand_ins_of(result.source))
    all.push_back({{"file", stand_in.file},
                   {"routines", stand_in.routines},
                   {"memory", fmt::format("VB{}:{}", stand_in.memory, stand_in.bytes)}});
  return all;
}

}  // namespace

nlohmann::ordered_json to_json(const stl::Diagnostics& diagnostics, const stl::SourceLines& source) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const stl::Diagnostic& d : diagnostics) all.push_back(to_json(d, source));
  return all;
}

std::string counted(const stl::Diagnostics& diagnostics) {
  return fmt::format("{}, {}", counted(stl::Severity::Error, diagnostics), counted(stl::Severity::Warning, diagnostics));
}

std::vector<const CpuModel*> fine_for(const SourceText& text, const CheckResult& result, const CpuModel& asked) {
  if (result.program) return {};
  std::vector<const CpuModel*> fitting = cpus_without_errors(text.parsed);
  std::erase(fitting, &asked);
  return fitting;
}

std::string check_summary(const SourceText& text, const CheckResult& result, const CpuModel& model,
                          const std::vector<const CpuModel*>& others) {
  const std::string name = stl::printable(result.source.name);
  const std::string warnings = counted(stl::Severity::Warning, result.diagnostics);
  if (!result.program) {
    return fmt::format("{}: {} for CPU {}{}\n", name, counted(result.diagnostics), model.name, other_cpus_text(others));
  }
  return fmt::format("{}: fine, {} for CPU {}{}{}\n", name, counted(result.program->ops.size(), "instruction"),
                     result.program->model->name, text.as_document() ? ", out of a document" : "",
                     result.diagnostics.empty() ? "" : ", " + warnings);
}

std::string dropped_networks_note(const CheckResult& result, const std::vector<const CpuModel*>& others) {
  constexpr std::size_t kShown = 10;
  if (!others.empty()) return {};
  std::vector<std::string> networks;
  for (const stl::Diagnostic& d : result.diagnostics) {
    const std::string section = stl::section_at(result.source, d.position.line);
    const bool counts = d.severity == stl::Severity::Error && d.cause != kUndefinedSymbols &&
                        section.find(", network ") != std::string::npos;
    if (counts && (networks.empty() || networks.back() != section)) networks.push_back(section);
  }
  if (networks.empty()) return {};
  const std::size_t shown = std::min(kShown, networks.size());
  return fmt::format("{}: on import Micro/WIN would leave out {}: {}{}", stl::printable(result.source.name),
                     counted(networks.size(), "network"),
                     stl::printable(fmt::format(
                         "{}", fmt::join(networks.begin(), networks.begin() + static_cast<std::ptrdiff_t>(shown), "; "))),
                     networks.size() > shown ? "; …" : "");
}

nlohmann::ordered_json check_json(const std::string& path, const SourceText& text, const CheckResult& result,
                                  const CpuModel& model, const std::vector<const CpuModel*>& others) {
  return {{"file", path},
          {"ok", result.program != nullptr},
          {"cpu", model.name},
          {"fine_for", names_of(others)},
          {"kind", name_of(text.kind)},
          {"encoding", text.encoding},
          {"instructions", result.program ? result.program->ops.size() : 0},
          {"left_out", text.parsed.left_out},
          {"notes", text.parsed.notes},
          {"stand_ins", stand_ins_json(result)},
          {"diagnostics", to_json(result.diagnostics, result.source)}};
}

}  // namespace s7200::tools
