#include "tools/command/debugging/dap_debuggee.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/file_source.hpp"
#include "interpreter/base/result.hpp"
#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "tools/command/debugging/debug_session.hpp"
#include "tools/command/debugging/debuggee_run.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/running/rig_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/usage.hpp"
#include "tools/faces/dap/requests/sources.hpp"
#include "tools/faces/files/host_files.hpp"
#include "tools/json/json.hpp"
#include "tools/plan/bridge_kinds.hpp"
#include "tools/plan/plc_keys.hpp"
#include "tools/views/state/faults.hpp"

namespace s7200::tools {
namespace {

using dap::Json;

/// A rig, and the bridge that its line may be joined to.
class RigDebuggee final : public dap::Debuggee {
 public:
  RigDebuggee(std::shared_ptr<DebuggeeOptions> options, std::unique_ptr<RecordedRig> rig, SystemBridges bridges,
              StopToken stop_request, bool may_use_files)
      : options_(std::move(options)),
        rig_(std::move(rig)),
        files_(rig_->files()),
        may_use_files_(may_use_files),
        live_(*rig_, *options_, std::move(bridges),
              {[this](const std::string& text) { say_(text); }, [this](const std::string& text) { say_(text); }},
              stop_request) {}

  /// The past begins with the bridges attached.
  Result<> start() {
    if (const auto done = live_.start(); !done) return done;
    history_.emplace(options_->rig.stations(*rig_), live_.history());
    if (live_.has_bridges()) say_(kMastersWait);
    return {};
  }

  std::string source() const override {
    return options_->rig.is_system() ? options_->program.path : rig_->plan().plcs.front().program->source.name;
  }
  History& history() override { return *history_; }
  SessionSetup setup() override {
    SessionSetup setup = session_setup(*options_, *rig_, live_, may_use_files_ ? &files_ : nullptr);
    setup.why_no_files = fmt::format(
        "this server lets no command read or write files; s7200 dap --listen PORT --allow {} does", kFilesOfCommands);
    return setup;
  }

  bool follows_clock() const override { return live_.follows_clock(); }

  void when_saying(std::function<void(const std::string&)> say) override {
    say_ = std::move(say);
    for (const std::string& text : std::exchange(unsaid_, {})) say_(text);
  }

  std::vector<std::string> finish() override {
    std::vector<std::string> said = fault_notes(*rig_);
    const std::vector<std::string> problems = rig_->finish();
    said.insert(said.end(), problems.begin(), problems.end());
    if (const std::string dump = dump_text(*rig_); !dump.empty()) said.push_back(dump);
    return said;
  }

 private:
  std::vector<std::string> unsaid_;  ///< before anyone listens
  std::function<void(const std::string&)> say_ = [this](const std::string& text) { unsaid_.push_back(text); };
  std::shared_ptr<DebuggeeOptions> options_;
  std::unique_ptr<RecordedRig> rig_;
  HostFiles files_;  ///< for commands
  bool may_use_files_;
  DebuggeeRun live_;
  std::optional<History> history_;  ///< from start() on
};

namespace fs = std::filesystem;

bool is_option(const std::string& key) {
  return dap::use_of(key) == dap::AttributeUse::Program && key != "program" && key != "with";
}

/// `--modbus-tcp` for `modbusTcp`
std::string option_of_attribute(const std::string& key) {
  std::string option = "--";
  for (const char c : key) {
    if (stl::is_upper(c)) option += '-';
    option += stl::is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return option;
}

[[noreturn]] void refuse_unknown(const std::string& key, const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  const std::string option = option_of_attribute(key).substr(2);
  const std::string_view meant = nearest(option, std::vector<std::string_view>(names.begin(), names.end()));
  throw dap::Refused(
      fmt::format("launch: there is no attribute '{}'{}; the options of s7200 debug are attributes without "
                  "their dashes",
                  stl::shortened(key), meant.empty() ? "" : fmt::format(", did you mean '{}'?", meant)));
}

/// A value as its option takes it: where it names a file, that is a path from `folder` on, or a URI.
std::string as_written(const std::string& value, const std::string& type, const std::string& folder) {
  const bool is_table = type == "TABLE" && std::ranges::find(named_times(), value, &NamedTimes::name) == named_times().end();
  if ((type != "FILE" && type != "LINK" && type != "DEVICE" && !is_table) || is_standard_input(value)) return value;
  const std::string path = dap::path_of(value);
  std::error_code gone;
  return folder.empty()
             ? path
             : (fs::absolute(file_path(dap::path_of(folder)), gone) / file_path(path)).lexically_normal().generic_string();
}

std::string word_of(const Json& value, std::string_view type) {
  if (value.is_string()) return text_of(value);
  if (value.is_number()) return shown(value);
  throw WrongValue(fmt::format("{} is not {}: a text or a number", shown(value), type));
}

/// Gives an option the value of its attribute; nothing if that is off.
void give(CLI::Option& option, const Json& value, const std::string& folder) {
  if (option.get_items_expected_max() == 0) {
    if (truth_of(value)) option.add_result("true");
    return;
  }
  if (value == false) return;
  const std::string type = option.get_type_name();
  Json values = value.is_array() ? value : Json::array({value});
  if (value.is_object() && type.starts_with("ADDRESS=")) {  // `"set": {"VW10": 5}`
    values = Json::array();
    for (const auto& [place, one] : value.items()) values.push_back(fmt::format("{}={}", place, word_of(one, type)));
  }
  if (values.size() > 1 && option.get_items_expected_max() == 1 &&
      option.get_multi_option_policy() == CLI::MultiOptionPolicy::Throw)
    throw WrongValue(fmt::format("{} is not one {}", shown(value), type));
  for (const Json& one : values) option.add_result(as_written(word_of(one, type), type, folder));
}

/// Gives the options the values of their attributes. Returns the files of the program.
std::vector<std::string> take_attributes(const Json& arguments, CLI::App& app) {
  const std::string folder = text_at(arguments, "cwd", "");
  std::error_code gone;
  if (!folder.empty() && !fs::is_directory(file_path(dap::path_of(folder)), gone))
    throw dap::Refused(fmt::format("launch: cwd: '{}' is not a folder", stl::shortened(folder)));
  for (const auto& [key, value] : arguments.items()) {
    if (!is_option(key) || value.is_null()) continue;
    CLI::Option* const known = app.get_option_no_throw(option_of_attribute(key));
    if (!known) refuse_unknown(key, app);
    taken(value, key.c_str(), [&](const Json& of) { return give(*known, of, folder), true; });
  }
  std::vector<std::string> files = texts_at(arguments, "program");
  if (files.empty()) throw dap::Refused("launch: 'program' is missing: the file of the program to debug");
  std::ranges::move(texts_at(arguments, "with"), std::back_inserter(files));
  for (std::string& file : files) {
    file = as_written(file, "FILE", folder);
    app.get_option("PROGRAM")->add_result(file);
  }
  return files;
}

// --- what a launch may do ---

void refuse_to_open(std::string_view what, const LaunchLimits& limits) {
  if (!limits.may_open || std::ranges::find(*limits.may_open, what) != limits.may_open->end()) return;
  throw dap::Refused(
      fmt::format("launch: '{0}' writes a file or opens a port, which this server does not allow; s7200 dap --listen "
                  "PORT --allow {0} does",
                  what));
}

void check_limits(const Json& arguments, const std::vector<std::string>& files, const LaunchLimits& limits) {
  for (const auto& [key, value] : arguments.items())
    for (const std::string& name : writing_attributes())
      if (option_of_attribute(key) == "--" + name && !value.is_null() && value != false) refuse_to_open(name, limits);
  const auto may_run = [&](const std::string& file) {
    std::error_code gone;
    return std::ranges::any_of(
        limits.programs, [&](const std::string& one) { return fs::equivalent(file_path(one), file_path(file), gone); });
  };
  for (const std::string& file : files)
    if (!limits.programs.empty() && !may_run(file))
      throw dap::Refused(fmt::format("launch: {} is not what this server was started with, and it runs nothing else: {}",
                                     file, fmt::join(limits.programs, ", ")));
}

/// A system file opens and writes on its own.
void check_limits(const SystemPlan& plan, const LaunchLimits& limits) {
  for (const BridgePlan& bridge : plan.bridges) refuse_to_open(row_of(bridge.kind).word(), limits);
  for (const LinePlan& line : plan.lines)
    if (!line.captures.empty()) refuse_to_open("capture", limits);
  for (const PlcKey& key : plc_keys())
    for (const PlcPlan& plc : plan.plcs)
      if (key.shape == PlcKey::Shape::Written && !key.text(plc.settings).empty()) refuse_to_open(key.name, limits);
}

}  // namespace

std::shared_ptr<dap::Debuggee> make_debuggee(const CLI::App& app, std::shared_ptr<DebuggeeOptions> options,
                                             StopToken stop_request, int& exit_code, const LaunchLimits& limits) {
  exit_code = kUnusable;
  if (is_standard_input(options->program.path)) {
    print_error("the program cannot come from standard input, where the messages come from");
    return nullptr;
  }
  if (!options->rig.load_all(app, options->program, exit_code)) return nullptr;
  check_limits(options->rig.plan(), limits);
  exit_code = kUnusable;
  options->bridge.set_line(options->master);
  if (!options->bridge.prepare()) return nullptr;
  auto bridges = bridges_of(*options);
  if (!bridges) return nullptr;
  auto rig = options->rig.assemble(true, options->bridge.link());
  if (!rig) {
    exit_code = options->rig.exit_code_without_rig();
    return nullptr;
  }
  if (!has_room_for_bridge(*options, *rig)) return nullptr;
  rig->power_up();
  rig->simulation().stop_when({});  // the debugger looks itself, in front of each instruction
  auto debuggee = std::make_shared<RigDebuggee>(std::move(options), std::move(rig), std::move(*bridges), stop_request,
                                                limits.may_use_files);
  if (const auto done = debuggee->start(); !done) {
    print_error(done.why());
    return nullptr;
  }
  exit_code = kFine;
  return debuggee;
}

std::vector<std::string> writing_attributes() {
  std::vector<std::string> names;
  for (const PlcKey& key : plc_keys())
    if (key.shape == PlcKey::Shape::Written) names.emplace_back(key.name);
  names.emplace_back("capture");
  for (const BridgeRow& row : kBridges) names.emplace_back(row.word());
  names.emplace_back(kFilesOfCommands);
  return names;
}

std::string not_a_writing_attribute(const std::string& word) {
  const std::vector<std::string> names = writing_attributes();
  if (std::ranges::find(names, word) != names.end()) return {};
  return fmt::format("'{}' is not an attribute that writes or opens something; there are {}", stl::shortened(word),
                     fmt::join(names, ", "));
}

std::shared_ptr<dap::Debuggee> launch_debuggee(const Json& arguments, const LaunchLimits& limits, StopToken stop_request) {
  CLI::App app;
  app.set_help_flag();  // there is no one to read it
  auto options = std::make_shared<DebuggeeOptions>();
  options->add_program_to(app);
  options->add_plant_to(app);
  const KeptMessages messages;
  int exit_code = kFine;
  try {
    check_limits(arguments, take_attributes(arguments, app), limits);
    app.parse(std::vector<std::string>{});  // checks the values, and what needs or excludes what
    if (auto debuggee = make_debuggee(app, std::move(options), stop_request, exit_code, limits)) return debuggee;
  } catch (const CLI::ParseError& error) {
    throw dap::Refused(fmt::format("launch: {}", in_our_words(error, app)));
  }
  throw dap::Refused(std::string(stl::trim(messages.text)));
}

}  // namespace s7200::tools
