#include "tools/command/options/verb/master_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "serial_sim/peers/quiet_time.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/line_options.hpp"
#include "tools/host/console.hpp"
#include "tools/host/files/files.hpp"

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

/// What holds without an option: `0; pc1000-lan, hppc: 2`; nothing of a protocol without it.
std::string usual(std::string (*of)(const Protocol&)) {
  const std::string first = of(*protocols().front());
  std::vector<std::pair<std::string, std::string>> others;  // value, names
  for (const Protocol* protocol : protocols().subspan(1)) {
    if (of(*protocol) == first || of(*protocol).empty()) continue;
    const auto known = std::ranges::find(others, of(*protocol), &std::pair<std::string, std::string>::first);
    if (known == others.end())
      others.emplace_back(of(*protocol), protocol->name);
    else
      known->second.append(", ").append(protocol->name);
  }
  std::string text = first;
  for (const auto& [value, names] : others) text += fmt::format("; {}: {}", names, value);
  return text;
}

bool has_option(const Protocol& protocol, std::string_view name) {
  return std::ranges::any_of(protocol.options, [&](const ProtocolOption& option) { return option.name == name; });
}

}  // namespace

void MasterOptions::add_to(CLI::App& app) {
  offer_other_plcs(
      app.add_option("TARGET", target, "a PROGRAM to run in simulation, a serial device, or an address: s7200 help targets")
          ->required());
  std::vector<OfferedWith> actions;
  for (const Protocol* one : protocols()) actions.push_back({std::string(one->name), one->action_words});
  offer_with(
      app.add_option("ACTION", words, "what to do, such as read 40001:4 write 40011=5 slave-id: s7200 help protocols"),
      "--protocol", actions);
  add_protocol_option(app, protocol, {protocols().begin(), protocols().end()}, "what to speak")
      ->group(help_group::kRequests);
  add_whole_number(
      app, "--station", [this](std::uint64_t given) { station_ = static_cast<std::uint8_t>(given); }, {0, UINT8_MAX},
      "station to ask; in Modbus 0 is all, 248 on TCP, other makes",
      usual([](const Protocol& one) { return one.station ? std::to_string(*one.station) : std::string(); }))
      ->group(help_group::kRequests);
  add_protocol_options(app);
  auto* interval = add_duration(app, "--every", every, "repeat all actions at this interval, in a table",
                                {kMicrosecond, kLongestDuration})
                       ->group(help_group::kRequests);
  app.add_flag("--continuous", continuous, "repeat all actions without a pause; only failures and statistics are shown")
      ->excludes(interval)
      ->group(help_group::kRequests);
  add_whole_number(app, "--count", count, {1, UINT64_MAX}, "how often to repeat", "until Ctrl-C")
      ->group(help_group::kRequests);
  add_whole_number(
      app, "--retries", [this](std::uint64_t given) { retries_ = static_cast<int>(given); }, {0, 1'000'000},
      "repeat after silence, wrong answer, lost connection",
      usual([](const Protocol& one) { return std::to_string(one.patience.retries); }));
  add_duration(app, "--before-retry", before_retry_,
               fmt::format("how long to wait before that [{}]",
                           usual([](const Protocol& one) { return format_duration(one.patience.pause); })));
  const std::string quiet = serial::default_quiet_text();
  add_duration(app, "--pause", pause, fmt::format("pause between an answer and the next request [in simulation {}]", quiet));
  app.add_flag("-v,--verbose", verbose, "show requests and answers in hex, over Modbus TCP too as they are on a serial line")
      ->group(help_group::kResults);
  app.add_flag("--json", json, "print all exchanges and the statistics as JSON")->group(help_group::kResults);

  const auto line = added_by(app, [&] { add_master_options(app, master); });
  for (CLI::Option* option : line) {
    const std::string name = option->get_name();
    if (name == "--timeout") timeout_ = option;
    if (name == "--gap") for_rtu_.push_back(option);
    if (name != "--gap" && name != "--timeout") for_lines_.push_back(option);
  }
  timeout_->description(fmt::format("how long to wait for an answer to start [{}]",
                                    usual([](const Protocol& one) { return format_duration(one.patience.timeout); })));
  for_rtu_.push_back(add_duration(app, "--silence", silence,
                                  "silence that ends an answer [3.5 characters; outside simulation 20ms if that is more]"));
  plc_ = other.add_to(app);
  for_programs_ = added_by(app, [&] {
    program.add_parts_to(app);
    program.CpuOptions::add_to(app);
    rig.add_to(app);
    report.add_to(app, "a page for browsers that computes the session again; any moment of it, without s7200");
    rig.add_place_to(app);
    band.add_to(app);
    add_duration(app, "--after", after,
                 fmt::format("when to send the first request [after the first scan and {} of silence]", quiet));
  });
  app.get_option("--with")->group(help_group::kMore);
}

/// Those of all protocols. What several have means the same to each of them.
void MasterOptions::add_protocol_options(CLI::App& app) {
  for (const Protocol* one : protocols())
    for (const ProtocolOption& option : one->options) {
      const std::string name(option.name);
      if (app.get_option_no_throw(name) != nullptr) continue;
      const std::string group = fmt::format("Options of --protocol {}", one->name);
      if (option.value.empty()) {
        app.add_flag_callback(
               name, [this, name] { given_[name]; }, option.meaning)
            ->group(group);
        continue;
      }
      app.add_option_function<std::string>(
             name, [this, name](const std::string& value) { given_[name] = value; }, option.meaning)
          ->check([check = option.check](const std::string& value) { return check(value); })
          ->default_str(option.standard)
          ->type_name(std::string(option.value))
          ->group(group);
    }
}

void MasterOptions::refuse_what_does_not_fit(Kind kind) const {
  if (band.wanted() && (polls() || continuous || count > 1 || verbose))
    throw std::invalid_argument(
        "--times-band does all actions once with each table: give no --every, --continuous, --count or --verbose");
  // In simulation nothing but the reader slows down what would be written for ever.
  const bool floods = open_ended() && (polls() || json || verbose) && !is_terminal(Standard::Output);
  if ((kind == Kind::Program || kind == Kind::System || kind == Kind::Peer) && floods)
    throw std::invalid_argument(
        fmt::format("{} without --count never ends, and a simulation writes as fast as it can: say how often with --count N",
                    polls() ? "--every" : "--continuous"));
  for (const auto& [name, value] : given_)
    for (const Protocol* one : protocols())
      if (!has_option(*protocol, name) && has_option(*one, name))
        throw std::invalid_argument(fmt::format("{} needs --protocol {}", name, one->name));
  if (station_ && !protocol->station)
    throw std::invalid_argument(fmt::format("--station: messages of {} name no station", protocol->name));
  if (kind == Kind::ModbusTcp && !protocol->over_modbus_tcp)
    throw std::invalid_argument(fmt::format(
        "modbus-tcp:// carries nothing but Modbus; --protocol {} needs a PROGRAM, a serial device, or tcp://HOST:PORT",
        protocol->name));
  refuse_what_a_peer_does_not_take(kind);
  if (kind == Kind::Tcp || kind == Kind::ModbusTcp)
    refuse_options(for_lines_, "a serial line; the target is a connection over TCP");
  if (kind == Kind::ModbusTcp) refuse_options(for_rtu_, "Modbus RTU; Modbus TCP sends whole frames");
}

/// A line with a simulated PLC of another make has its faults, but no program.
void MasterOptions::refuse_what_a_peer_does_not_take(Kind kind) const {
  const bool peer = kind == Kind::Peer;
  if (!peer) refuse_options({plc_}, "westinghouse:MODEL");
  if (peer && protocol->plcs == nullptr) {
    std::string names;
    for (const Protocol* one : protocols_of_other_plcs()) names.append(names.empty() ? "" : ", ").append(one->name);
    throw std::invalid_argument(
        fmt::format("PLCs of westinghouse:MODEL do not speak {}; they speak {}", protocol->name, names));
  }
  if (kind == Kind::Program || kind == Kind::System) return;
  std::vector<CLI::Option*> refused = for_programs_;
  if (peer) std::erase_if(refused, [](const CLI::Option* option) { return is_about_the_line(option->get_name()); });
  refuse_options(refused, "a PROGRAM to run in simulation");
}

/// Other verbs take the files of a project one after the other; here actions follow the PROGRAM.
void MasterOptions::refuse_file_as_action() const {
  if (words.empty() || words.front().find('.') == std::string::npos || !host_files().exists(words.front())) return;
  throw std::invalid_argument(
      fmt::format("'{}' is a file, and an action is expected here; {}", words.front(), how_to_give(words.front())));
}

std::vector<MasterAction> MasterOptions::actions(bool over_tcp) const {
  if (wants_menu()) return {};
  refuse_file_as_action();
  return protocol->actions(words, use(over_tcp));
}

std::string MasterOptions::doubt(const std::vector<MasterAction>& actions, bool over_tcp) const {
  return protocol->doubt == nullptr ? std::string() : protocol->doubt(actions, use(over_tcp));
}

ProtocolUse MasterOptions::use(bool over_tcp) const {
  return {.station = station_.value_or(protocol->station.value_or(1)),
          .over_modbus_tcp = over_tcp,
          .given = given_,
          .of_another_make = parse_slave_target(target).kind == SlaveTarget::Kind::Peer};
}

bool MasterOptions::wants_menu() const {
  if (std::ranges::find(words, "menu") == words.end()) return false;
  if (protocol != &modbus_protocol()) throw std::invalid_argument("menu needs --protocol modbus");
  if (words.size() > 1) throw std::invalid_argument("menu stands alone: what is to be done is typed there");
  if (json || polls() || continuous || count != 0 || verbose || band.wanted())
    throw std::invalid_argument(
        "menu shows everything itself: give no --json, --every, --continuous, --count, --verbose or --times-band");
  if (!is_terminal(Standard::Input) || !is_terminal(Standard::Output))
    throw std::invalid_argument("menu needs a terminal for input and output; elsewhere give actions, such as read 40001:2");
  return true;
}

std::uint64_t MasterOptions::rounds() const { return open_ended() ? UINT64_MAX : std::max<std::uint64_t>(count, 1); }

SessionSettings MasterOptions::session(bool broadcasts_are_silent) const {
  serial::MasterSettings settings = master;
  if (timeout_->count() == 0) settings.timeout = protocol->patience.timeout;
  Patience patience = protocol->patience;
  if (before_retry_ != kNever) patience.pause = before_retry_;
  if (given_.contains(patience.without_first)) patience.first = nullptr;
  return {settings,
          rounds(),
          every,
          retries_.value_or(protocol->patience.retries),
          pause,
          silence == kNever ? std::nullopt : std::optional(silence),
          broadcasts_are_silent,
          patience,
          use(false)};
}

MasterOutputSettings MasterOptions::output() const {
  return {json, verbose, continuous, every, rounds(), protocol->refusal};
}

}  // namespace s7200::tools
