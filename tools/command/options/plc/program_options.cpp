#include "tools/command/options/plc/program_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <span>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/program/loading/dialect.hpp"
#include "interpreter/program/loading/load_times.hpp"
#include "interpreter/stl/text/plain_text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/input.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/measuring/band.hpp"
#include "tools/plan/program_cpu.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/recording.hpp"

namespace s7200::tools {
namespace {

std::string unknown_cpu(std::string_view name) {
  std::string known;
  for (const CpuModel* each : all_cpus()) known.append(known.empty() ? "" : ", ").append(each->name);
  return fmt::format("there is no model of CPU '{}'; modelled: {}", stl::shortened(name), known);
}

}  // namespace

void add_cpu_option(CLI::App& app, std::string& cpu, const std::string& text) {
  std::vector<std::string> names;
  for (const CpuModel* each : all_cpus()) names.emplace_back(each->name);
  offer(app.add_option("--cpu", cpu, text), names)
      ->check([](const std::string& name) { return find_cpu(name) ? "" : unknown_cpu(name); })
      ->type_name("TYPE")
      ->group(help_group::kProgram);
}

void add_no_skip_option(CLI::App& app, bool& every_scan) {
  app.add_flag(kNoSkip, every_scan, "run every scan, instead of passing over those that are all alike; only slower");
}

void add_repair_option(CLI::App& app, Repairs& repairs) {
  app.add_option_function<std::string>(
         "--repair", [&repairs](const std::string& text) { repairs = parse_repairs(text).value_or(Repairs{}); },
         "slips of a published listing to repair, by their numbers as `s7200 check` names them: R1,R2 or all")
      ->check([](const std::string& text) { return parse_repairs(text).why(); })
      ->type_name("LIST");
}

bool repair(SourceText& text, const Repairs& repairs) {
  stl::Source& source = text.parsed.source;
  std::vector<std::string> unknown;
  const std::vector<Slip> slips = repair(source, repairs, unknown);
  for (const Slip& slip : slips) print_note(to_text(slip, source));
  for (const std::string& id : unknown)
    print_error(fmt::format("--repair {}: {} has no such slip{}", id, source.name,
                            slips.empty() ? "; it is not a listing that is known here" : ""));
  return unknown.empty();
}

void CpuOptions::add_cpu_and_times_to(CLI::App& app, const std::string& meaning) {
  add_cpu_option(app, cpu, meaning);
  std::vector<std::string> tables;
  for (const NamedTimes& times : named_times()) tables.emplace_back(times.name);
  offer_beside_files(
      app.add_option("--times", times_table, "table of execution times: a name (s7200 help times) or a CSV file"), tables)
      ->type_name("TABLE");
}

void CpuOptions::add_to(CLI::App& app) {
  add_cpu_and_times_to(app, fmt::format("CPU to run on {}", kCpuFound));
  system_block_.add_to(app, PlcKey::Stage::Cpu);
  add_repair_option(app, repairs);
  add_no_stand_ins_option(app, no_stand_ins);
  add_no_skip_option(app, every_scan);
}

const CpuModel* CpuOptions::model() const {
  const CpuModel* found = cpu.empty() ? &cpu214() : find_cpu(cpu);
  if (!found) print_error(unknown_cpu(cpu));
  return found && system_block(*found) ? found : nullptr;
}

const CpuModel* CpuOptions::model_for(const SourceText& text, const std::string& path) const {
  if (!cpu.empty()) return model();
  const ProgramCpu found = cpu_of_program(text, path, host_files());
  if (!found.model) return print_error(found.why), nullptr;
  print_note_if_any(found.note);
  return system_block(*found.model) ? found.model : nullptr;
}

std::optional<TimeTable> CpuOptions::times(const CpuModel& model) const {
  std::vector<std::string> errors;
  auto times = load_times(model, times_table, host_files(), errors);
  for (const std::string& error : errors) print_error(error);
  return times;
}

std::optional<TimesBand> CpuOptions::band(const CpuModel& model, const BandSettings& settings) const {
  std::vector<std::string> errors;
  auto tables = load_band(model, times_table, host_files(), settings, errors);
  for (const std::string& error : errors) print_error(error);
  return tables;
}

std::optional<SystemBlock> CpuOptions::system_block(const CpuModel& model) const {
  PlcSettings settings;
  const AddressSpace of_cpu = model;
  return system_block_.read(settings, &of_cpu) ? std::optional(settings.system_block) : std::nullopt;
}

std::string how_to_give(const std::string& file) {
  const char* const quote = file.find(' ') == std::string::npos ? "" : "\"";
  return fmt::format("another file of the program's project is given with --with {0}{1}{0}", quote, file);
}

void ProgramOptions::add_to(CLI::App& app) {
  app.add_option("PROGRAM", path, "STL file (.stl, .awl, .txt) or published document with STL in it; - is standard input")
      ->required();
  add_parts_to(app);
  CpuOptions::add_to(app);
}

void ProgramOptions::add_files_to(CLI::App& app) {
  app.add_option_function<std::vector<std::string>>(
         "PROGRAM",
         [this](const std::vector<std::string>& files) {
           path = files.front();
           parts.insert(parts.end(), std::next(files.begin()), files.end());
         },
         "STL file or published document, and the other files of its project; - is standard input")
      ->required();
}

void ProgramOptions::add_parts_to(CLI::App& app) {
  app.add_option("--with", parts, "another file of the program's project: symbol table, data block, block (repeatable)")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(help_group::kProgram);
}

std::shared_ptr<const Program> ProgramOptions::load(int& exit_code) const {
  exit_code = kUnusable;
  auto text = cpu.empty() || model() ? read_project(path, parts) : std::nullopt;
  return text ? load(std::move(*text), exit_code) : nullptr;
}

std::shared_ptr<const Program> ProgramOptions::load(SourceText text, int& exit_code) const {
  exit_code = kUnusable;
  const CpuModel* found = model_for(text, path);
  const auto table = found ? times(*found) : std::nullopt;
  return table ? load(std::move(text), *found, *table, exit_code) : nullptr;
}

std::shared_ptr<const Program> ProgramOptions::load(SourceText text, const CpuModel& model, const TimeTable& table,
                                                    int& exit_code) const {
  exit_code = kUnusable;
  if (!repair(text, repairs)) return nullptr;
  print_notes(reading_notes(text));
  CheckResult result = check(text.parsed, model, table);
  std::erase_if(result.diagnostics, [](const auto& d) { return d.severity == stl::Severity::Warning; });
  print_diagnostics(result.diagnostics, result.source);
  if (!result.program) print_error(fmt::format("{} has errors; nothing was run", result.source.name));
  exit_code = result.program ? kFine : kCheckFailed;
  auto program = std::move(result.program);
  if (program && !accept_stand_ins(*program, no_stand_ins)) {
    exit_code = kCheckFailed;
    return nullptr;
  }
  const SystemBlock block = *system_block(model);
  if (program && block != SystemBlock{}) program = with_system_block(*program, block);
  return every_scan && program ? with_every_scan(*program) : program;
}

std::optional<std::vector<TitledTimes>> load_all(const std::vector<std::string>& tables, const CpuModel& model) {
  std::vector<TitledTimes> loaded;
  std::vector<std::string> errors;
  for (const std::string& table : tables)
    if (auto times = load_times(model, table, host_files(), errors)) loaded.push_back({table, std::move(*times)});
  for (const std::string& error : errors) print_error(error);
  return errors.empty() ? std::optional(loaded) : std::nullopt;
}

namespace {

bool has_statements(const SourceText& text) {
  return std::ranges::any_of(text.parsed.source.lines,
                             [](const stl::Line& line) { return std::holds_alternative<stl::Statement>(line); });
}

/// The levels of a line, or packets, in a text: no program looks like them, even if there is no frame in them.
std::string form_of_capture(std::string_view bytes) {
  const auto form = std::ranges::find_if(recording_forms(),
                                         [&](const RecordingForm& each) { return !each.is_log && each.looks_like(bytes); });
  return form != recording_forms().end() && bytes.find('\0') == std::string_view::npos ? std::string(form->name)
                                                                                       : std::string();
}

/// What `s7200 decode` reads a file as that has no statements; empty if it reads no frame in it. Any text with a few numbers
/// may be a log, a table only if it has columns of one.
std::string form_of_recording(std::string_view bytes, const std::optional<SourceText>& text) {
  constexpr std::string_view kPlainLog = "text";
  constexpr std::size_t kEnoughOfText = 1 << 20;
  const auto recording = read_recording(is_text(bytes) ? bytes.substr(0, kEnoughOfText) : bytes, {});
  if (!recording) return form_of_capture(bytes);
  const bool any =
      !std::ranges::all_of(recording->frames, [](const RecordedFrame& frame) { return frame.doubt != nullptr; });
  const bool table = text && text->kind != SourceKind::Listing && text->kind != SourceKind::Document;
  return any && !(table && recording->form == kPlainLog) ? recording->form : std::string();
}

}  // namespace

std::optional<SourceText> read_program_text(const std::string& path, bool force_document) {
  if (is_system_file(path)) {
    print_error(
        fmt::format("{} is a system file, which 's7200 run', 'send', 'master', 'test', 'debug', 'view' and 'dap' take; name "
                    "one PROGRAM here",
                    path));
    return {};
  }
  std::string name;
  const auto bytes = read_input(path, name);
  if (!bytes) return {};
  auto text = read_source(*bytes, name, force_document);
  const bool program = text && (text->kind == SourceKind::Blocks || has_statements(*text) || begins_as_step7(*bytes) ||
                                other_dialect(stl::PlainText(*bytes).text()));
  if (const std::string form = program ? std::string() : form_of_recording(*bytes, text.if_any()); !form.empty()) {
    print_error(
        fmt::format("cannot read {0}: it is a recording of a line ({1}), not a program: s7200 decode {0}", name, form));
    return {};
  }
  if (!text) print_error(fmt::format("cannot read {}: {}", name, text.why()));
  return std::move(text).if_any();
}

std::optional<SourceText> read_project(const std::string& path, const std::vector<std::string>& parts) {
  std::vector<SourceText> files;
  const auto add = [&files](const std::string& file) {
    auto text = read_program_text(file);
    if (!text) return false;
    files.push_back(std::move(*text));
    return true;
  };
  bool all = add(path);
  for (const std::string& part : parts) all &= add(part);
  if (!all) return {};
  return join_files(std::move(files));
}

std::vector<ProgramFiles> read_programs(const std::vector<std::string>& paths, int& exit_code) {
  std::vector<ProgramFiles> programs, parts;
  for (const std::string& path : paths) {
    auto text = read_program_text(path);
    if (text)
      (text->is_program() ? programs : parts).push_back({path, std::move(*text)});
    else
      exit_code = kUnusable;
  }
  if (programs.empty() && !parts.empty()) {
    programs.push_back(std::move(parts.front()));
    parts.erase(parts.begin());
  }
  for (auto& [path, text] : programs) {
    std::vector<SourceText> files;
    files.push_back(std::move(text));
    for (const ProgramFiles& part : parts) files.push_back(part.text);
    text = join_files(std::move(files));
  }
  return programs;
}

std::vector<std::string> reading_notes(const SourceText& text) {
  std::vector<std::string> notes = text.parsed.notes;
  constexpr std::size_t kShown = 20;
  const std::vector<std::uint32_t>& lines = text.parsed.left_out;
  if (lines.empty()) return notes;
  const auto shown = std::span(lines).first(std::min(kShown, lines.size()));
  notes.push_back(fmt::format("{}: {} of its listing left out as text: {}{}", text.parsed.source.name,
                              counted(lines.size(), "line"), fmt::join(shown, ", "), lines.size() > kShown ? ", …" : ""));
  return notes;
}

void print_diagnostics(const stl::Diagnostics& diagnostics, const stl::SourceLines& source) {
  print_message_lines(stl::render(diagnostics, source, colour_wanted(stderr)));
}

}  // namespace s7200::tools
