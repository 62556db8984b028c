#include "tools/command/options/master_options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>

#include "interpreter/base/text.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "tools/command/options/line_options.hpp"
#include "tools/command/options/number_option.hpp"

namespace s7200::tools {
namespace {

using Kind = SlaveTarget::Kind;

void refuse_options(const std::vector<CLI::Option*>& options, const char* need) {
  for (const CLI::Option* option : options)
    if (option->count() > 0) throw std::invalid_argument(fmt::format("{} needs {}", option->get_name(), need));
}

/// The options that `add` adds.
template <typename Add>
std::vector<CLI::Option*> added_by(CLI::App& app, Add add) {
  const auto before = app.get_options();
  add();
  std::vector<CLI::Option*> added = app.get_options();
  std::erase_if(added, [&](const CLI::Option* option) { return std::ranges::find(before, option) != before.end(); });
  return added;
}

std::string form_names() {
  std::string text;
  for (const ValueFormName& form : value_forms()) text.append(text.empty() ? "" : ", ").append(form.name);
  return text;
}

}  // namespace

void MasterOptions::add_to(CLI::App& app) {
  app.add_option("TARGET", target, "a PROGRAM to run in simulation, a device, or an address; see below")->required();
  app.add_option("ACTION", words, "what to do, see below");
  add_whole_number(app, "--station", station, {0, UINT8_MAX},
                   "station to ask; 0 is all of them, which do not answer; above 247 only over Modbus TCP", "1");
  app.add_option("--as", form, "how registers are shown: " + form_names())
      ->check([](const std::string& name) {
        return std::ranges::any_of(value_forms(), [&](const ValueFormName& known) { return known.name == name; })
                   ? std::string()
                   : fmt::format("'{}' is not a form; there are {}", stl::shortened(name), form_names());
      })
      ->capture_default_str()
      ->type_name("FORM");
  app.add_flag("--low-word-first", rules.format.low_word_first, "in values of 32 bits the first register is the low one");
  app.add_flag("--always-15", rules.always_15, "write single coils with function 15 too");
  app.add_flag("--always-16", rules.always_16, "write single registers with function 16 too");
  app.add_flag("--crc", rules.crc, "append the CRC to raw frames");
  app.add_flag("--beyond-limits", rules.beyond_limits, "send what the specification forbids, to test a slave");
  auto* interval = add_duration(app, "--every", every, "repeat all actions at this interval, in a table",
                                {kMicrosecond, kLongestDuration});
  app.add_flag("--continuous", continuous, "repeat all actions without a pause; only failures and statistics are shown")
      ->excludes(interval);
  add_whole_number(app, "--count", count, {1, UINT64_MAX}, "how often to repeat", "until Ctrl-C");
  add_whole_number(app, "--retries", retries, {0, 1'000'000},
                   "ask again so often after silence, a wrong answer, or a lost connection", "0");
  const std::string quiet = serial::default_quiet_text();
  add_duration(app, "--pause", pause, fmt::format("pause between an answer and the next request [in simulation {}]", quiet));
  app.add_flag("-v,--verbose", verbose,
               "show requests and answers in hex, over Modbus TCP too as they are on a serial line");
  app.add_flag("--json", json, "print all exchanges and the statistics as JSON");

  const auto line = added_by(app, [&] { add_master_options(app, master); });
  for (CLI::Option* option : line) {
    const std::string name = option->get_name();
    if (name == "--gap") for_rtu_.push_back(option);
    if (name != "--gap" && name != "--timeout") for_lines_.push_back(option);
  }
  for_rtu_.push_back(add_duration(app, "--silence", silence,
                                  "silence that ends an answer [3.5 characters; outside simulation 20ms if that is more]"));
  for_programs_ = added_by(app, [&] {
    program.add_parts_to(app);
    program.CpuOptions::add_to(app);
    rig.add_to(app);
    add_duration(app, "--after", after,
                 fmt::format("when to send the first request [after the first scan and {} of silence]", quiet));
  });
}

void MasterOptions::refuse_what_does_not_fit(Kind kind) const {
  // In simulation nothing but the reader slows down what would be written for ever.
  const bool floods = open_ended() && (polls() || json || verbose) && !isatty(STDOUT_FILENO);
  if (kind == Kind::Program && floods)
    throw std::invalid_argument(
        fmt::format("{} without --count never ends, and a simulation writes as fast as it can: say how often with --count N",
                    polls() ? "--every" : "--continuous"));
  if (kind != Kind::Program) refuse_options(for_programs_, "a PROGRAM to run in simulation");
  if (kind == Kind::Tcp || kind == Kind::ModbusTcp)
    refuse_options(for_lines_, "a serial line; the target is a connection over TCP");
  if (kind == Kind::ModbusTcp) refuse_options(for_rtu_, "Modbus RTU; Modbus TCP sends whole frames");
}

std::vector<MasterAction> MasterOptions::actions(bool over_tcp) {
  for (const ValueFormName& name : value_forms())
    if (name.name == form) rules.format.form = name.form;
  // 255 is a Modbus TCP server itself, not a station behind it (Modbus Messaging on TCP/IP, 4.4.2).
  rules.last_station = rules.beyond_limits || over_tcp ? UINT8_MAX : modbus::kLastStation;
  rules.station = static_cast<std::uint8_t>(parse_number(std::to_string(station), 0, rules.last_station, "--station"));
  return parse_actions(words, rules);
}

std::uint64_t MasterOptions::rounds() const { return open_ended() ? UINT64_MAX : std::max<std::uint64_t>(count, 1); }

SessionSettings MasterOptions::session(bool broadcasts_are_silent) const {
  return {master,
          rounds(),
          every,
          retries,
          pause,
          silence == kNever ? std::nullopt : std::optional(silence),
          broadcasts_are_silent};
}

MasterOutputSettings MasterOptions::output() const { return {json, verbose, continuous, every, rounds(), rules.format}; }

}  // namespace s7200::tools
