#include "tools/command/options/fault_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "interpreter/base/text.hpp"
#include "tools/host/terminal.hpp"

namespace s7200::tools {
namespace {

/// Of the text in front of the place, so that the caret is right: a byte that continues a UTF-8 character has no column.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

nlohmann::ordered_json to_json(const serial::Fault& fault, std::uint64_t count, std::uint64_t impossible) {
  return {{"fault", serial::to_text(fault)}, {"count", count}, {"impossible", impossible}};
}

}  // namespace

void FaultOptions::add_to(CLI::App& app) {
  app.add_option("--fault", texts_, "a fault of the line, see below (repeatable)")
      ->type_name("KIND:PARAMETER=VALUE,...")
      ->allow_extra_args(false);
}

bool FaultOptions::prepare() {
  bool fine = true;
  for (const std::string& text : texts_) {
    const serial::ParsedFault parsed = serial::parse_fault(text);
    if (parsed.ok())
      faults_.push_back(parsed.fault);
    else
      print_fault_error(*parsed.error, text);
    fine &= parsed.ok();
  }
  return fine;
}

void FaultOptions::inject(serial::Simulation& simulation) const {
  for (const serial::Fault& fault : faults_) simulation.inject(fault);
}

void print_fault_error(const serial::FaultError& error, std::string_view text) {
  const std::size_t before = std::min(error.column - 1, text.size());
  const std::size_t width = std::max<std::size_t>(columns(text.substr(before, error.length)), 1);
  print_error(fmt::format("--fault, column {}: {}", error.column, error.message));
  fmt::print(stderr, "  {}\n  {}^{}\n", stl::printable(text), std::string(columns(text.substr(0, before)), ' '),
             std::string(width - 1, '~'));
}

std::string fault_help() {
  std::string text = "Faults: KIND or KIND:PARAMETER=VALUE,PARAMETER=VALUE...\n";
  for (const serial::FaultKindInfo& kind : serial::fault_kinds())
    text += fmt::format("  {:<10} {:<58} {}\n", kind.name, kind.meaning, kind.example);
  text += "Their parameters, each where it makes sense; a wrong one is answered with those that a fault has:\n";
  for (const serial::FaultParameter& parameter : serial::fault_parameters())
    text += fmt::format("  {:<12} {:<24} {}\n", parameter.name, parameter.values, parameter.meaning);
  return text;
}

std::string faults_text(const serial::Faults& faults) {
  std::string text;
  for (const serial::Faults::Injected& injected : faults.state().injected) {
    text += fmt::format("s7200: note: fault {}: {}×", serial::to_text(injected.fault), injected.count);
    if (injected.impossible != 0)
      text += fmt::format(", and {}× the format of the character had no such bit", injected.impossible);
    text += '\n';
  }
  return text;
}

nlohmann::ordered_json faults_json(const serial::Faults& faults) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const serial::Faults::Injected& injected : faults.state().injected)
    json.push_back(to_json(injected.fault, injected.count, injected.impossible));
  return json;
}

nlohmann::ordered_json faults_json(const serial::Faults& faults, const serial::Faults::State& since) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < since.injected.size(); ++i) {
    const serial::Faults::Injected &now = faults.state().injected.at(i), &then = since.injected[i];
    if (now.count != then.count || now.impossible != then.impossible)
      json.push_back(to_json(now.fault, now.count - then.count, now.impossible - then.impossible));
  }
  return json;
}

}  // namespace s7200::tools
