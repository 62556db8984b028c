#include "tools/master/report.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "tools/master/statistics.hpp"
#include "tools/slave/host_link.hpp"
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
  return modbus::describe(modbus::bytes_of(result.exchange.request), result.exchange.response_bytes());
}

/// Columns: the address in the notation of 5 digits, on the wire, value.
std::string value_line(const modbus::DataAddress& address, const std::string& value) {
  return fmt::format("{:>7} {:>7}  {}", modbus::notation(address), address.address, value);
}

constexpr Time kRedraw = 50 * kMillisecond;

std::size_t rows_of_terminal() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_row : 0;
}

}  // namespace

modbus::Answer assess(const MasterAction& action, const serial::Exchange& exchange, bool broadcasts_are_silent) {
  modbus::Answer answer = modbus::check_answer(modbus::bytes_of(exchange.request), exchange.response_bytes());
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
  return fmt::format("  request  {}\n  answer   {}\n", modbus::to_hex(exchange.request),
                     exchange.response.empty() ? "none" : modbus::to_hex(exchange.response_bytes()));
}

nlohmann::ordered_json to_json(const MasterResult& result, const ValueFormat& format) {
  const MasterAction& action = *result.action;
  const serial::Exchange& exchange = result.exchange;
  const modbus::Answer& answer = result.answer;
  const modbus::Bytes request = modbus::bytes_of(exchange.request);
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

PollingTable::PollingTable(std::string title, const ValueFormat& format, bool in_place, bool colour)
    : title_(std::move(title)), format_(format), in_place_(in_place), colour_(colour) {}

std::string PollingTable::marked(const std::string& line, bool changed) const {
  if (!changed) return "  " + line;
  return colour_ ? fmt::format("* \x1b[1m{}\x1b[0m", line) : "* " + line;
}

void PollingTable::add(const MasterResult& result, Time at) {
  if (in_place_) {
    now_.push_back({heading(result), lines(result, format_)});
  } else {
    now_.push_back({{}, {short_text(result, format_)}});
    const std::vector<std::string>& shown = now_[place_].lines;
    const bool changed = place_ < before_.size() && before_[place_].lines != shown;
    const auto latency = result.exchange.latency();
    fmt::print("{:12.6f} s  {:>12}  {}\n", static_cast<double>(at) / kSecond, latency ? format_duration(*latency) : "-",
               marked(fmt::format("{}: {}", result.action->text, shown[0]), changed));
  }
  ++place_;
}

void PollingTable::end_round(const std::string& footer) {
  if (in_place_) {
    to_draw_ = table(footer);
    if (host_time() - drawn_at_ >= kRedraw) draw();
  } else {
    std::fflush(stdout);
  }
  before_ = std::exchange(now_, {});
  place_ = 0;
}

void PollingTable::finish() {
  if (!to_draw_.empty()) draw();
}

std::string PollingTable::table(const std::string& footer) const {
  std::string text = title_ + "\n";
  for (std::size_t place = 0; place < now_.size(); ++place) {
    text += now_[place].heading + "\n";
    for (std::size_t line = 0; line < now_[place].lines.size(); ++line) {
      const bool known = place < before_.size() && line < before_[place].lines.size();
      text += marked(now_[place].lines[line], known && before_[place].lines[line] != now_[place].lines[line]) + "\n";
    }
  }
  return text + footer;
}

void PollingTable::draw() {
  const auto height = static_cast<std::size_t>(std::ranges::count(to_draw_, '\n'));
  const std::size_t rows = rows_of_terminal();
  const bool fits = drawn_ < rows && height < rows;  // else the lines above cannot be reached any more
  // ECMA-48: cursor up, erase to the end of the screen; lines that are too long are cut instead of wrapped.
  if (fits && drawn_ > 0) fmt::print("\x1b[{}A", drawn_);
  fmt::print("\x1b[?7l\r\x1b[J{}\x1b[?7h", std::exchange(to_draw_, {}));
  std::fflush(stdout);
  drawn_ = height;
  drawn_at_ = host_time();
}

}  // namespace s7200::tools
