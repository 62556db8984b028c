#include "tools/session/causes/line/unanswered_causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "tools/session/causes/last/last_decision.hpp"

namespace s7200::tools {
namespace {

/// Of an address that no PLC has, the one beside which the master stands knows that. Where all are Modbus slaves, a frame
/// with a wrong CRC is meant for one, too.
std::vector<std::size_t> stations_concerned(const History& history, std::size_t station,
                                            std::span<const std::uint8_t> request) {
  const std::size_t line = history.requests().line_of(station, history.station(station).port());
  std::vector<std::size_t> here, unknown;
  for (std::size_t plc = 0; plc < history.stations(); ++plc) {
    if (!history.requests().port_on(line, plc)) continue;
    here.push_back(plc);
    if (!history.address_of(plc)) unknown.push_back(plc);
  }
  if (request.empty() || !(is_rtu_frame(request) || unknown.empty())) return here;
  const auto has_it = [&](std::size_t plc) { return history.address_of(plc) == request.front(); };
  if (const auto asked = std::ranges::find_if(here, has_it); asked != here.end()) return {*asked};
  return unknown.empty() ? std::vector{station} : unknown;
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Without moments, numbers of characters, and values met: `no answer to # since #: JMP 255 in line 141 (LDW= AC0, 0:
/// AC0=#)`
std::string without_figures(std::string_view line) {
  std::string text;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = std::min(line.find_first_not_of("0123456789.", at), line.size());
    const std::string_view after = line.substr(end);
    const bool is_moment = after.starts_with(" ms"), is_count = after.starts_with(" character");
    const bool is_value = at > 0 && line[at - 1] == '=' && is_digit(line[at]);
    if (is_digit(line[at]) && (is_moment || is_count)) {
      text += '#';
      at = end;
    } else if (is_value) {
      at = std::min(line.find_first_of(" ;)", at), line.size());
    } else {
      const std::size_t next = is_digit(line[at]) ? end : at + 1;
      text += line.substr(at, next - at);
      at = next;
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> texts_of(const std::vector<CauseOfNoAnswer>& causes) {
  std::vector<std::string> texts;
  for (const CauseOfNoAnswer& cause : causes) texts.push_back(cause.text);
  return texts;
}

std::optional<std::vector<CauseOfNoAnswer>> causes_of_no_answer(History& history, std::size_t station,
                                                                std::span<const std::uint8_t> request, Time timeout,
                                                                StopToken stop_request) {
  std::vector<CauseOfNoAnswer> causes;
  for (const std::size_t plc : stations_concerned(history, station, request)) {
    const DecisionSearch search = find_last_decision(history, plc, timeout, stop_request);
    if (search.interrupted) return {};
    const std::vector<std::string> lines = cause_lines(search);
    for (std::size_t i = 0; i < lines.size(); ++i)
      causes.push_back({history.stations() == 1 ? lines[i] : fmt::format("{}: {}", history.name_of(plc), lines[i]),
                        search.unanswered[i].power});
  }
  return causes;
}

std::size_t DifferentCauses::number_of(const std::vector<CauseOfNoAnswer>& causes) {
  std::string cause;
  for (const CauseOfNoAnswer& one : causes) cause += fmt::format("{} {}\n", without_figures(one.text), one.power);
  const auto known = std::ranges::find(known_, cause);
  const auto number = static_cast<std::size_t>(known - known_.begin());
  if (known == known_.end()) known_.push_back(std::move(cause));
  return number;
}

}  // namespace s7200::tools
