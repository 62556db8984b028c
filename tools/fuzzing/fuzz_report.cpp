#include <fmt/format.h>

#include "interpreter/base/text/counted.hpp"
#include "tools/fuzzing/fuzz.hpp"
#include "tools/trials/trial_text.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kShown = 20;  ///< contacts that were not seen both ways

std::string_view kind_word(FuzzFinding::Kind kind) {
  constexpr std::string_view kWords[]{"fatal", "stop", "error", "write", "unanswered", "rule"};
  return kWords[static_cast<std::size_t>(kind)];
}

std::string_view end_word(FuzzResult::End end) {
  constexpr std::string_view kWords[]{"runs", "seconds", "interrupted"};
  return kWords[static_cast<std::size_t>(end)];
}

double a_second(const FuzzResult& result) {
  return result.host_seconds > 0 ? static_cast<double>(result.runs) / result.host_seconds : 0;
}

std::string finding_text(const Inspection& inspection, const FuzzFinding& finding, std::size_t number) {
  std::string text = fmt::format("\n{}. {}\n", number, wrapped_at(finding.what, 3, 3));
  if (finding.op)
    text += fmt::format("   {}  {}\n", place_in_words(inspection, *finding.op), instruction_text(inspection, *finding.op));
  text += fmt::format("   {} after power-up", format_duration(finding.at, 3));
  text += finding.trial.empty() ? ", without any input\n" : ", after\n" + trial_text(finding.trial, finding.begun);
  return text + (finding.comes_again ? "" : "   it did not come again when these inputs were given from power-up\n");
}

std::string listening_text(const FuzzResult& result) {
  if (!result.listens) return "  it receives at no port: only inputs, memory that a panel sets, and time were tried\n";
  const std::string ports =
      fmt::format("  it receives at port {}{}", result.port, result.both_ports ? " and the other one" : "");
  if (result.requests == 0) return ports + ", and has answered no request of Modbus RTU\n";
  return fmt::format("{}, and answers {} of Modbus RTU\n", ports, counted(result.requests, "known request"));
}

std::string contacts_text(const Inspection& inspection, const FuzzResult& result) {
  std::string text = fmt::format("  {} of {} seen both ways\n", result.both_ways, counted(result.contacts, "contact"));
  for (std::size_t i = 0; i < result.never.size() && i < kShown; ++i) {
    const ContactsSeen::Never& never = result.never[i];
    const char* const seen = never.open ? "never closed" : never.closed ? "never open" : "never executed";
    text += row_text(inspection, fmt::format("    {:<15}", seen), never.op);
  }
  if (result.never.size() > kShown) text += fmt::format("    … and {} more\n", result.never.size() - kShown);
  return text;
}

}  // namespace

std::string fuzz_text(const Inspection& inspection, const FuzzResult& result) {
  std::string text =
      fmt::format("{}; {} of simulated time{}\n", counted(result.runs, "run"), format_duration(result.simulated, 3),
                  result.end == FuzzResult::End::Interrupted ? "; interrupted" : "");
  text += listening_text(result) + contacts_text(inspection, result);
  if (result.findings.empty()) return text + "\nNothing was found.\n";
  for (std::size_t i = 0; i < result.findings.size(); ++i) text += finding_text(inspection, result.findings[i], i + 1);
  return text;
}

ordered_json fuzz_json(const Inspection& inspection, const FuzzResult& result) {
  ordered_json json{{"runs", result.runs}, {"ended_by", end_word(result.end)}, {"host_seconds", result.host_seconds}};
  json["runs_a_second"] = a_second(result);
  json["simulated_ns"] = result.simulated;
  json["port"] = result.listens ? ordered_json(result.port) : ordered_json();
  json["requests"] = result.requests;
  json["contacts"] = result.contacts;
  json["both_ways"] = result.both_ways;
  json["never"] = ordered_json::array();
  for (const ContactsSeen::Never& never : result.never) {
    ordered_json entry = place_json(inspection, never.op);
    entry["seen_open"] = never.open;
    entry["seen_closed"] = never.closed;
    json["never"].push_back(std::move(entry));
  }
  json["findings"] = ordered_json::array();
  for (const FuzzFinding& finding : result.findings) {
    ordered_json entry{{"kind", kind_word(finding.kind)}, {"what", finding.what}, {"at_ns", finding.at}};
    entry["code"] = finding.code != 0 ? ordered_json(fmt::format("{:04X}", finding.code)) : ordered_json();
    entry["by"] = finding.op ? place_json(inspection, *finding.op) : ordered_json();
    entry["comes_again"] = finding.comes_again;
    entry["inputs"] = trial_json(finding.trial, finding.begun);
    json["findings"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace s7200::tools
