#include "tools/master/report.hpp"

#include <fmt/format.h>

#include "tools/master/statistics.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

using serial::Verdict;

std::string fault_text(const MasterResult& result) {
  const serial::Answer& answer = result.answer;
  switch (answer.verdict) {
    case Verdict::Silent:
      return "no answer";
    case Verdict::Exception:
      return result.action->request->error_text(answer.exception);
    default:
      return answer.fault;
  }
}

std::string not_asked_text(const MasterResult& result) {
  return result.answer.verdict == Verdict::Right ? "sent; no answer expected" : fault_text(result);
}

bool has_right_answer(const MasterResult& result) {
  return result.answer.verdict == Verdict::Right && !result.exchange.response.empty();
}

}  // namespace

serial::Answer assess(const MasterAction& action, const serial::Exchange& exchange, bool broadcasts_are_silent) {
  const bool expected = !action.request->turnaround();
  serial::Answer answer = action.request->judge(serial::bytes_of(exchange.request), exchange.response_bytes());
  const auto wrong = [](std::string_view fault) {
    serial::Answer judged;
    judged.verdict = Verdict::Wrong;
    judged.fault = fault;
    return judged;
  };
  if (!expected && exchange.response.empty()) {
    answer.verdict = Verdict::Right;
    return answer;
  }
  if (exchange.response.empty()) return answer;
  if (const std::string_view damage = exchange.damage(); !damage.empty()) return wrong(damage);
  if (!expected && broadcasts_are_silent) return wrong("an answer to what is never answered");
  return answer;
}

std::string short_text(const MasterResult& result) {
  const std::string text = has_right_answer(result)
                               ? result.action->request->in_short(result.answer, serial::bytes_of(result.exchange.request),
                                                                  result.exchange.response_bytes())
                               : not_asked_text(result);
  return result.remark.empty() ? text : fmt::format("{} ({})", text, result.remark);
}

std::string heading(const MasterResult& result) {
  const MasterAction& action = *result.action;
  std::string text = action.text;
  if (const std::string subject = action.request->subject(); !subject.empty()) text += "   " + subject;
  if (const auto latency = result.exchange.latency()) text += "   after " + format_duration(*latency);
  if (result.attempts > 1) text += fmt::format("   at attempt {}", result.attempts);
  return text;
}

std::vector<std::string> lines(const MasterResult& result) {
  std::vector<std::string> lines{"  " + not_asked_text(result)};
  if (has_right_answer(result))
    lines = result.action->request->in_lines(result.answer, serial::bytes_of(result.exchange.request),
                                             result.exchange.response_bytes());
  if (!result.remark.empty()) lines.push_back("  note: " + result.remark);
  return lines;
}

std::string frames_text(const MasterResult& result) {
  const serial::Exchange& exchange = result.exchange;
  return fmt::format("  request  {}\n  answer   {}\n", serial::to_hex(exchange.request),
                     exchange.response.empty() ? "none" : serial::to_hex(exchange.response_bytes()));
}

nlohmann::ordered_json to_json(const MasterResult& result) {
  const ProtocolRequest& asked = *result.action->request;
  const serial::Exchange& exchange = result.exchange;
  const serial::Answer& answer = result.answer;
  const Bytes request = serial::bytes_of(exchange.request);
  nlohmann::ordered_json json{{"action", result.action->text},
                              {"at_us", static_cast<double>(exchange.request_start) / kMicrosecond}};
  json.update(asked.subject_json(request));
  json.update({{"request", plain_hex(request)},
               {"response", nullptr},
               {"latency_us", nullptr},
               {"attempts", result.attempts},
               {"verdict", verdict_name(answer.verdict)},
               {"fault", nullptr},
               {"exception", nullptr},
               {"values", nullptr},
               {"decoded", nullptr},
               {"bytes", nullptr},
               {"remark", nullptr}});
  if (!exchange.response.empty()) {
    json["response"] = plain_hex(exchange.response_bytes());
    json["latency_us"] = static_cast<double>(*exchange.latency()) / kMicrosecond;
  }
  if (answer.verdict == Verdict::Wrong) json["fault"] = answer.fault;
  if (answer.verdict == Verdict::Exception)
    json["exception"] = {{"code", answer.exception}, {"name", asked.error_name(answer.exception)}};
  if (!answer.values.empty()) {
    json["values"] = answer.values;
    json["decoded"] = asked.decoded_json(answer);
  }
  if (!answer.bytes.empty()) json["bytes"] = plain_hex(answer.bytes);
  if (!result.remark.empty()) json["remark"] = result.remark;
  return json;
}

}  // namespace s7200::tools
