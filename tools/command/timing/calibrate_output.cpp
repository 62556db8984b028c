#include "tools/command/timing/calibrate_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string_view>
#include <vector>

#include "interpreter/model/times/named_times.hpp"
#include "tools/command/timing/measuring_target.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

std::string today() {
  const std::time_t now = std::time(nullptr);
  const std::tm local = *std::localtime(&now);
  return fmt::format("{}-{:02}-{:02}", local.tm_year + 1900, local.tm_mon + 1, local.tm_mday);
}

/// SMB6 has the type of the CPU in its upper half.
int type_in(std::uint8_t identification) { return identification & 0xF0; }

std::vector<std::string_view> cpus_of_type(std::uint8_t identification) {
  std::vector<std::string_view> names;
  for (const CpuModel* each : all_cpus())
    if (type_in(each->identification) == type_in(identification)) names.push_back(each->name);
  return names;
}

/// `CALL + RET = 41.00 us ± 0.12, and as far as is known CALL 23.00 ± 4.60, RET 18.00 ± 4.60`
std::string sum_text(const Fit& fit, std::size_t sum) {
  std::vector<std::string> parts;
  for (const Fitted& each : fit.forms)
    if (each.sum == sum)
      parts.push_back(fmt::format("{} {:.2f} ± {:.2f}", each.form.mnemonic, each.ns / 1000, each.within / 1000));
  return fmt::format("{} = {:.2f} us ± {:.2f}, and as far as is known {}\n", fit.sums[sum].text, fit.sums[sum].ns / 1000,
                     fit.sums[sum].within / 1000, fmt::join(parts, ", "));
}

nlohmann::ordered_json sum_to_json(const Fit& fit, std::size_t sum) {
  nlohmann::ordered_json json{
      {"of", fit.sums[sum].text}, {"us", fit.sums[sum].ns / 1000}, {"within_us", fit.sums[sum].within / 1000}};
  json["parts"] = nlohmann::ordered_json::array();
  for (const Fitted& each : fit.forms)
    if (each.sum == sum)
      json["parts"].push_back({{"name", each.form.mnemonic}, {"us", each.ns / 1000}, {"within_us", each.within / 1000}});
  return json;
}

}  // namespace

nlohmann::ordered_json to_json(const CpuModel& model, const Measurement& measurement, const Fit& fit) {
  auto results = results_of("calibrate");
  results["cpu"] = model.name;
  results["identification"] = measurement.identification;
  results["loops"] = measurement.loops.size();
  results["residual_us"] = fit.residual / 1000;
  results["contradiction_us"] = std::max(0.0, fit.contradiction) / 1000;
  results["found"] = nlohmann::ordered_json::array();
  for (const Fitted& each : fit.forms)
    if (each.found)
      results["found"].push_back({{"mnemonic", each.form.mnemonic},
                                  {"form", each.form.row->form},
                                  {"per_unit", each.form.per_unit},
                                  {"us", each.ns / 1000},
                                  {"within_us", each.within / 1000}});
  const auto ratio = ratio_to_known(fit);
  results["ratio"] = ratio ? nlohmann::ordered_json(*ratio) : nullptr;
  results["sums"] = nlohmann::ordered_json::array();
  for (std::size_t sum = 0; sum < fit.sums.size(); ++sum) results["sums"].push_back(sum_to_json(fit, sum));
  results["not_measured"] = nlohmann::ordered_json::array();
  for (const auto& [name, why] : not_measured(fit, model)) results["not_measured"].push_back({{"name", name}, {"why", why}});
  return results;
}

std::string source_of(const CpuModel& model, const Measurement& measurement, const Fit& fit, const std::string& firmware) {
  std::string source = fmt::format("CPU {} (SMB6 = 16#{:02X}{}), measured {}", model.name, measurement.identification,
                                   firmware.empty() ? "" : ", firmware " + firmware, today());
  if (fit.residual > 0) source += fmt::format(", loops agree within {:.0f} ns", std::ceil(fit.residual));
  return source;
}

std::string not_measured_text(const Fit& fit, const CpuModel& model) {
  std::string text;
  for (std::size_t sum = 0; sum < fit.sums.size(); ++sum) text += sum_text(fit, sum);
  const auto ratio = ratio_to_known(fit);
  const std::string_view own = times_of(model).front()->name;
  text += "not measured separately; ";
  text += ratio ? fmt::format("estimated as {:.2f} × the figure of {} (EEPROM save unchanged):", *ratio, own)
                : fmt::format("the figures of {} are kept, as fewer than half of all were measured:", own);
  std::vector<NotMeasured> missing = not_measured(fit, model);
  while (!missing.empty()) {
    const std::string_view why = missing.front().why;
    text += fmt::format("\n  {}:", why);
    for (const NotMeasured& each : missing)
      if (each.why == why) text += ' ' + each.name;
    std::erase_if(missing, [&](const NotMeasured& each) { return each.why == why; });
  }
  return text;
}

void refuse_another_cpu(const CpuModel& model, std::uint8_t identification) {
  const auto alike = cpus_of_type(identification);
  if (type_in(model.identification) == type_in(identification) || alike.empty()) return;
  throw WrongCpu(fmt::format("SMB6 = 16#{:02X} belongs to CPU {}, not to CPU {}: run again with --cpu", identification,
                             fmt::join(alike, ", "), model.name));
}

std::string doubt_about_cpu(const CpuModel& model, std::uint8_t identification, bool known) {
  const auto alike = cpus_of_type(identification);
  const std::string of = fmt::format("{}", fmt::join(alike, ", "));
  if (alike.empty())
    return fmt::format("SMB6 = 16#{:02X} belongs to no known CPU; the times of CPU {} were used", identification,
                       model.name);
  if (known || alike.size() == 1) return {};
  return fmt::format(
      "SMB6 = 16#{:02X} belongs to CPU {}; the times of CPU {} were used: if it is another, run again with --cpu",
      identification, of, model.name);
}

std::string interruption_note(const Measurement& measurement, std::size_t loops) {
  if (measurement.loops.size() == loops) return {};
  return fmt::format("{} after {} of {} loops: the rest of the table is not measured",
                     measurement.broken_off.empty() ? "interrupted" : "broken off", measurement.loops.size(), loops);
}

std::string contradiction_note(const Fit& fit) {
  if (fit.contradiction <= 0) return {};
  return fmt::format("loops contradict each other by {:.2f} us: some time depends on more than the instruction",
                     fit.contradiction / 1000);
}

}  // namespace s7200::tools
