#include "interpreter/model/times/times.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "interpreter/model/times/times_file.hpp"

namespace s7200 {

std::string_view name_of(SystemTime what) {
  switch (what) {
    case SystemTime::NoPowerFlow:
      return "(no power flow)";
    case SystemTime::IndirectOperand:
      return "(indirect operand)";
    case SystemTime::OperandArea:
      return "(operand area adds)";
    case SystemTime::InterruptEntry:
      return "(interrupt entry)";
    case SystemTime::ScanOverhead:
      return "(scan overhead)";
    case SystemTime::EepromSave:
      return "(EEPROM save)";
  }
  return {};
}

namespace {

TimeRange range_of(Time figure, Time within, const TimeRow& row) {
  const double factor = 1 + row.uncertainty / 100;
  const auto ns = static_cast<double>(figure), beyond = static_cast<double>(within);
  return {std::max(0.0, ns / factor - beyond), ns * factor + beyond};
}

constexpr std::string_view kPlus = " + ";

}  // namespace

TimeRange range_of_base(const TimeRow& row) { return range_of(row.base, row.base_within, row); }

TimeRange range_of_unit(const TimeRow& row) { return range_of(row.per_unit, row.per_unit_within, row); }

std::string form_of_sum(const std::vector<std::string>& parts) { return fmt::format("{}", fmt::join(parts, kPlus)); }

std::vector<std::string> parts_of_sum(std::string_view form) {
  std::vector<std::string> parts;
  while (!form.empty()) {
    const std::size_t end = std::min(form.find(kPlus), form.size());
    parts.emplace_back(form.substr(0, end));
    form.remove_prefix(std::min(form.size(), end + kPlus.size()));
  }
  return parts;
}

std::vector<std::string> TimeTable::add(std::string_view csv, const std::string& name) {
  std::vector<std::string> errors;
  TimesFile read = read_times(csv, name, errors);
  if (!errors.empty()) return errors;
  std::vector<TimeRow> rows;
  for (TimesFile::Line& line : read.lines) rows.push_back(std::move(line.row));
  add(TimeTable(std::move(rows)));
  return {};
}

void TimeTable::add(const TimeTable& correction) {
  rows_.insert(rows_.begin(), correction.rows_.begin(), correction.rows_.end());
}

const TimeRow* TimeTable::find(std::string_view mnemonic, std::optional<Area> first_operand) const {
  const auto fits = [&](const TimeRow& row) {
    return std::find(row.mnemonics.begin(), row.mnemonics.end(), mnemonic) != row.mnemonics.end() &&
           (row.areas == 0 || (first_operand && contains(row.areas, *first_operand)));
  };
  const auto found = std::find_if(rows_.begin(), rows_.end(), fits);
  return found == rows_.end() ? nullptr : &*found;
}

std::optional<Cost> TimeTable::cost(std::string_view mnemonic, std::optional<Area> first_operand) const {
  const TimeRow* row = find(mnemonic, first_operand);
  if (!row) return {};
  return Cost{row->base, row->per_unit};
}

Time TimeTable::operator[](SystemTime what) const { return cost(name_of(what), {}).value_or(Cost{}).base; }

Time TimeTable::added_by(std::string_view mnemonic, std::span<const std::optional<Area>> operands) const {
  Time sum = 0;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (!operands[i]) continue;
    const TimeRow* own = i == 0 ? find(mnemonic, operands[i]) : nullptr;
    if (!own || own->areas == 0) sum += cost(name_of(SystemTime::OperandArea), operands[i]).value_or(Cost{}).base;
  }
  return sum;
}

std::string in_microseconds(Time time) { return fmt::format("{}", static_cast<double>(time) / kMicrosecond); }

}  // namespace s7200
