#include "tools/master/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/master/statistics.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

using modbus::Verdict;

bool shows_values(const MasterResult& result) {
  return result.answer.verdict == Verdict::Right && result.action->first && !result.answer.values.empty();
}

std::string fault_text(const MasterResult& result) {
  const modbus::Answer& answer = result.answer;
  switch (answer.verdict) {
    case Verdict::Silent:
      return "no answer";
    case Verdict::Exception:
      return fmt::format("exception {}: {}", answer.exception, modbus::exception_name(answer.exception));
    default:
      return answer.fault;
  }
}

std::string right_text(const MasterResult& result) {
  if (result.exchange.response.empty()) return "sent; no answer expected";
  return modbus::describe(serial::bytes_of(result.exchange.request), result.exchange.response_bytes());
}

/// Columns: the address in the notation of 5 digits, on the wire, value.
std::string value_line(const modbus::DataAddress& address, const std::string& value) {
  return fmt::format("{:>7} {:>7}  {}", modbus::notation(address), address.address, value);
}

}  // namespace

modbus::Answer assess(const MasterAction& action, const serial::Exchange& exchange, bool broadcasts_are_silent) {
  modbus::Answer answer = modbus::check_answer(serial::bytes_of(exchange.request), exchange.response_bytes());
  const auto wrong = [&](const char* fault) {
    answer = {};
    answer.verdict = Verdict::Wrong;
    answer.fault = fault;
    return answer;
  };
  if (!action.answer_expected && exchange.response.empty()) {
    answer.verdict = Verdict::Right;
    return answer;
  }
  if (exchange.response.empty()) return answer;
  if (exchange.too_long) return wrong("an answer without end, cut off");
  if (exchange.parity_error()) return wrong("characters with wrong parity");
  if (exchange.framing_error()) return wrong("characters with framing errors");
  if (!action.answer_expected && broadcasts_are_silent) return wrong("an answer to what is never answered");
  return answer;
}

std::string short_text(const MasterResult& result, const ValueFormat& format) {
  std::string text;
  if (result.answer.verdict != Verdict::Right) {
    text = fault_text(result);
  } else if (!shows_values(result)) {
    text = right_text(result);
  } else if (modbus::row_of(result.action->first->area).bits) {
    text = bits_line(result.answer.values);
  } else {
    const ValueFormat brief{format.form == ValueForm::HexAndDecimal ? ValueForm::Hex : format.form, format.low_word_first};
    for (std::string value : value_lines(result.answer.values, brief)) {
      value.erase(0, value.find_first_not_of(' '));
      text += (text.empty() ? "" : " ") + value;
    }
  }
  return result.remark.empty() ? text : fmt::format("{} ({})", text, result.remark);
}

std::string heading(const MasterResult& result) {
  const MasterAction& action = *result.action;
  std::string text = action.text;
  if (action.kind != MasterAction::Kind::Raw) {
    const std::uint8_t function = action.pdu[0];
    text += fmt::format("   {}, function {}",
                        action.station == modbus::kBroadcast ? "all stations" : fmt::format("station {}", action.station),
                        function);
    if (action.first) text += ", " + range_text(*action.first, action.count);
  }
  if (const auto latency = result.exchange.latency()) text += "   after " + format_duration(*latency);
  if (result.attempts > 1) text += fmt::format("   at attempt {}", result.attempts);
  return text;
}

std::vector<std::string> lines(const MasterResult& result, const ValueFormat& format) {
  std::vector<std::string> lines;
  if (!shows_values(result)) {
    lines.push_back("  " + (result.answer.verdict == Verdict::Right ? right_text(result) : fault_text(result)));
  } else {
    const std::span<const std::uint16_t> values = result.answer.values;
    const bool bits = modbus::row_of(result.action->first->area).bits;
    constexpr std::size_t kBitsInALine = 16;
    const std::vector<std::string> texts = bits ? std::vector<std::string>{} : value_lines(values, format);
    const std::size_t step = bits ? kBitsInALine : format.registers();
    modbus::DataAddress address = *result.action->first;
    for (std::size_t place = 0, row = 0; place < values.size(); ++row) {
      const std::size_t left = values.size() - place;
      const std::size_t size = step == 0 ? left : left < step && !bits ? 1 : std::min(step, left);
      lines.push_back(value_line(address, bits ? bits_line(values.subspan(place, size)) : texts[row]));
      place += size;
      address.address = static_cast<std::uint16_t>(address.address + size);
    }
  }
  if (!result.remark.empty()) lines.push_back("  note: " + result.remark);
  return lines;
}

std::string frames_text(const MasterResult& result) {
  const serial::Exchange& exchange = result.exchange;
  return fmt::format("  request  {}\n  answer   {}\n", serial::to_hex(exchange.request),
                     exchange.response.empty() ? "none" : serial::to_hex(exchange.response_bytes()));
}

nlohmann::ordered_json to_json(const MasterResult& result, const ValueFormat& format) {
  const MasterAction& action = *result.action;
  const serial::Exchange& exchange = result.exchange;
  const modbus::Answer& answer = result.answer;
  const Bytes request = serial::bytes_of(exchange.request);
  nlohmann::ordered_json json{{"action", action.text},
                              {"at_us", static_cast<double>(exchange.request_start) / kMicrosecond},
                              {"station", request[0]},
                              {"function", nullptr},
                              {"area", nullptr},
                              {"first", nullptr},
                              {"notation", nullptr},
                              {"count", nullptr},
                              {"request", plain_hex(request)},
                              {"response", nullptr},
                              {"latency_us", nullptr},
                              {"attempts", result.attempts},
                              {"verdict", verdict_name(answer.verdict)},
                              {"fault", nullptr},
                              {"exception", nullptr},
                              {"values", nullptr},
                              {"decoded", nullptr},
                              {"bytes", nullptr},
                              {"remark", nullptr}};
  if (request.size() > 1) json["function"] = request[1];
  if (action.first) {
    json["area"] = modbus::row_of(action.first->area).word;
    json["first"] = action.first->address;
    if (const std::string notation = modbus::notation(*action.first); !notation.empty()) json["notation"] = notation;
    json["count"] = action.count;
  }
  if (!exchange.response.empty()) {
    json["response"] = plain_hex(exchange.response_bytes());
    json["latency_us"] = static_cast<double>(*exchange.latency()) / kMicrosecond;
  }
  if (answer.verdict == Verdict::Wrong) json["fault"] = answer.fault;
  if (answer.verdict == Verdict::Exception)
    json["exception"] = {{"code", answer.exception}, {"name", modbus::exception_name(answer.exception)}};
  if (!answer.values.empty()) {
    json["values"] = answer.values;
    const bool bits = action.first && modbus::row_of(action.first->area).bits;
    json["decoded"] = bits ? nlohmann::ordered_json(answer.values) : values_json(answer.values, format);
  }
  if (!answer.bytes.empty()) json["bytes"] = plain_hex(answer.bytes);
  if (!result.remark.empty()) json["remark"] = result.remark;
  return json;
}

}  // namespace s7200::tools
