#include "tools/command/dap_debuggee.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <utility>

#include "interpreter/base/text.hpp"
#include "tools/command/debuggee_run.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/rig_output.hpp"
#include "tools/command/terminal.hpp"
#include "tools/views/faults.hpp"

namespace s7200::tools {
namespace {

using dap::Json;

/// A rig, and the bridge that its line may be joined to.
class RigDebuggee final : public dap::Debuggee {
 public:
  RigDebuggee(std::shared_ptr<DebuggeeOptions> options, std::unique_ptr<Rig> rig, SystemBridges bridges,
              const std::atomic<bool>& stop_request)
      : options_(std::move(options)),
        rig_(std::move(rig)),
        stations_(options_->rig.named_stations(options_->master)),
        live_(*rig_, *options_, std::move(bridges),
              {[this](const std::string& text) { say_(text); }, [this](const std::string& text) { say_(text); }},
              &stop_request) {}

  /// The past begins with the bridges attached.
  bool start(std::string& why) {
    if (!live_.start(why)) return false;
    history_.emplace(options_->rig.stations(*rig_), live_.history());
    if (live_.has_bridges()) say_(kMastersWait);
    return true;
  }

  std::string source() const override {
    return options_->rig.plan() ? options_->program.path : rig_->plan().plcs.front().program->source.name;
  }
  History& history() override { return *history_; }
  std::shared_ptr<const Program> program(std::size_t station) const override { return rig_->plan().plcs[station].program; }
  std::string name(std::size_t station) const override { return rig_->plan().plcs[station].name; }
  std::size_t first_station() const override { return options_->rig.first_station(); }
  const serial::MasterSettings& master(std::size_t station) const override {
    return stations_.empty() ? options_->master : stations_[station].master;
  }
  std::string recorded_files() const override { return options_->rig.recorded_files(); }
  std::string take_failure() override { return live_.take_failure(); }

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
  std::unique_ptr<Rig> rig_;
  std::vector<RigOptions::Station> stations_;
  DebuggeeRun live_;
  std::optional<History> history_;  ///< from start() on
};

bool is_option(const std::string& key) { return dap::use_of(key) == dap::AttributeUse::Program && key != "program"; }

/// `--modbus-tcp` for `modbusTcp`
std::string option_of(const std::string& key) {
  std::string option = "--";
  for (const char c : key) {
    if (stl::is_upper(c)) option += '-';
    option += stl::is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return option;
}

void add_values(const Json& value, const std::function<void(const std::string&)>& add) {
  for (const Json& one : value.is_array() ? value : Json::array({value}))
    add(one.is_string() ? one.get<std::string>() : one.dump());
}

std::vector<std::string> words_of(const Json& arguments, const CLI::App& app) {
  std::vector<std::string> words;
  for (const auto& [key, value] : arguments.items()) {
    if (!is_option(key)) continue;
    const std::string option = option_of(key);
    if (!app.get_option_no_throw(option))
      throw dap::Refused(
          fmt::format("launch: there is no attribute '{}'; the options of s7200 debug are attributes without "
                      "their dashes",
                      stl::shortened(key)));
    if (value.is_boolean() && value == true) words.push_back(option);
    if (!value.is_boolean() && !value.is_null())
      add_values(value, [&](const std::string& text) { words.push_back(option + "=" + text); });
  }
  words.emplace_back("--");
  if (!arguments.contains("program")) throw dap::Refused("launch: 'program' is missing: the file of the program to debug");
  const auto is_name = [](const Json& one) { return one.is_string(); };
  const Json& program = arguments["program"];
  if (!is_name(program) && !(program.is_array() && std::ranges::all_of(program, is_name)))
    throw dap::Refused(fmt::format("launch: 'program' is the name of a file, not {}", program.dump()));
  add_values(program, [&](const std::string& file) { words.push_back(file); });
  return words;
}

}  // namespace

std::shared_ptr<dap::Debuggee> make_debuggee(const CLI::App& app, std::shared_ptr<DebuggeeOptions> options,
                                             const std::atomic<bool>& stop_request, int& exit_code) {
  exit_code = kUnusable;
  if (is_standard_input(options->program.path)) {
    print_error("the program cannot come from standard input, where the messages come from");
    return nullptr;
  }
  if (!options->rig.load_all(app, options->program, exit_code)) return nullptr;
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
  rig->simulation().stop_when(nullptr);  // the debugger looks itself, in front of each instruction
  auto debuggee = std::make_shared<RigDebuggee>(std::move(options), std::move(rig), std::move(*bridges), stop_request);
  if (std::string why; !debuggee->start(why)) {
    print_error(why);
    return nullptr;
  }
  exit_code = kFine;
  return debuggee;
}

std::shared_ptr<dap::Debuggee> launch_debuggee(const Json& arguments, const std::atomic<bool>& stop_request) {
  CLI::App app;
  auto options = std::make_shared<DebuggeeOptions>();
  options->add_program_to(app);
  options->add_plant_to(app);
  const KeptMessages messages;
  int exit_code = kFine;
  try {
    std::vector<std::string> words = words_of(arguments, app);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app.parse(std::move(words));
    if (auto debuggee = make_debuggee(app, std::move(options), stop_request, exit_code)) return debuggee;
  } catch (const CLI::ParseError& error) {
    throw dap::Refused(fmt::format("launch: {}", error.what()));
  }
  throw dap::Refused(std::string(stl::trim(messages.text)));
}

}  // namespace s7200::tools
