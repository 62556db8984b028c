#include "interpreter/model/times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <sstream>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"

namespace s7200 {
namespace {

constexpr std::string_view kHeader = "mnemonic,form,base_us,per_unit_us,unit,marker";

/// What a figure can be, and by how many percent it may be wrong if its line does not say.
struct Marker {
  std::string_view name;
  double uncertainty;
};
constexpr std::array<Marker, 5> kMarkers{
    {{"manual", 5}, {"measured", 5}, {"calibrated", 25}, {"remembered", 25}, {"estimate", 50}}};

std::vector<std::string> words(std::string_view text) {
  std::istringstream in{std::string(text)};
  std::vector<std::string> result;
  for (std::string word; in >> word;) result.push_back(word);
  return result;
}

/// The fields of a CSV line, quoted as in RFC 4180.
std::vector<std::string> fields(std::string_view line) {
  std::vector<std::string> result(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quoted && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      result.back() += line[i++];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      result.emplace_back();
    } else {
      result.back() += line[i];
    }
  }
  for (std::string& field : result) field = std::string(stl::trim(field));
  return result;
}

/// Microseconds with decimals, up to one second.
std::optional<Time> microseconds(const std::string& text) {
  const auto value = parse_decimal<double>(text);
  if (!value || !Between<double>{0, 1e6}.has(*value)) return {};
  return static_cast<Time>(std::llround(*value * 1000));
}

/// The areas that a form names; none if it contains any other word.
Areas areas_of(std::string_view form) {
  Areas areas = 0;
  for (const std::string& word : words(form)) {
    const auto area = area_named(word);
    if (!area) return 0;
    areas |= set_of(*area);
  }
  return areas;
}

std::vector<std::string> mnemonics_of(const std::string& text) {
  static constexpr std::string_view kAlso = "(and A O)";
  if (text.starts_with('(')) return {text};
  if (!text.ends_with(kAlso)) return words(text);
  std::vector<std::string> result = words(text.substr(0, text.size() - kAlso.size()));
  const std::vector<std::string> loads = result;
  for (const char* prefix : {"A", "O"})
    for (const std::string& load : loads) result.push_back(prefix + load.substr(2));
  return result;
}

bool may_be_free(const TimeRow& row) {
  return std::all_of(row.mnemonics.begin(), row.mnemonics.end(),
                     [](const std::string& m) { return m == "LBL" || m == "SBR" || m == "INT"; });
}

/// Reads one line into `row`. Returns what is wrong with it; empty if nothing is.
std::string read_row(std::string_view line, TimeRow& row) {
  const std::vector<std::string> field = fields(line);
  if (field.size() < 6) return fmt::format("{} columns, but {} are needed ({})", field.size(), 6, kHeader);
  row.mnemonics = mnemonics_of(field[0]);
  if (row.mnemonics.empty()) return "the mnemonic is missing";
  row.form = field[1];
  row.areas = areas_of(row.form);
  const auto base = microseconds(field[2]);
  if (!base) return fmt::format("'{}' is not a time in microseconds (0 to 1000000)", stl::shortened(field[2]));
  row.base = *base;
  const auto per_unit = field[3].empty() ? Time{0} : microseconds(field[3]);
  if (!per_unit) return fmt::format("'{}' is not a time in microseconds (0 to 1000000)", stl::shortened(field[3]));
  row.per_unit = *per_unit;
  row.unit = field[4];
  row.marker = field[5];
  const auto* const marker = std::ranges::find(kMarkers, row.marker, &Marker::name);
  if (marker == kMarkers.end()) {
    std::string known;
    for (const Marker& each : kMarkers) known.append(known.empty() ? "" : ", ").append(each.name);
    return fmt::format("'{}' is not a marker; there are {}", stl::shortened(row.marker), known);
  }
  row.source = field.size() > 6 ? field[6] : "";
  const bool has_uncertainty = field.size() > 7 && !field[7].empty();
  const auto uncertainty = has_uncertainty ? parse_decimal<double>(field[7]) : marker->uncertainty;
  if (!uncertainty || !Between<double>{0, 1000}.has(*uncertainty))
    return fmt::format("'{}' is not an uncertainty in percent (0 to 1000)", stl::shortened(field[7]));
  row.uncertainty = *uncertainty;
  if (row.base == 0 && !may_be_free(row)) return fmt::format("{}: an execution time must be above 0", field[0]);
  return {};
}

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"") == std::string::npos) return field;
  std::string text = "\"";
  for (const char c : field) text.append(c == '"' ? 2 : 1, c);
  return text + '"';
}

}  // namespace

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

std::vector<std::string> TimeTable::add(std::string_view csv, const std::string& name) {
  std::vector<std::string> errors;
  std::vector<TimeRow> rows;
  bool header_seen = false;
  std::size_t number = 0;
  while (!csv.empty()) {
    ++number;
    const std::string_view line = csv.substr(0, csv.find('\n'));
    csv.remove_prefix(std::min(csv.size(), line.size() + 1));
    if (stl::trim(line).empty()) continue;
    if (!header_seen) {
      header_seen = true;
      if (stl::trim(line).starts_with(kHeader)) continue;
      return {fmt::format("{}:{}: not a table of execution times: the first line must be {}[,source[,uncertainty_percent]]",
                          name, number, kHeader)};
    }
    TimeRow row;
    if (const std::string error = read_row(line, row); !error.empty())
      errors.push_back(fmt::format("{}:{}: {}", name, number, error));
    else
      rows.push_back(std::move(row));
  }
  if (!header_seen) errors.push_back(fmt::format("{}: the table is empty", name));
  if (errors.empty()) rows_.insert(rows_.begin(), rows.begin(), rows.end());
  return errors;
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

std::string in_microseconds(Time time) { return fmt::format("{:g}", static_cast<double>(time) / 1000); }

std::string to_csv(const TimeTable& times) {
  std::string text = std::string(kHeader) + ",source,uncertainty_percent\n";
  for (const TimeRow& row : times.rows())
    text += fmt::format("{},{},{},{},{},{},{},{:g}\n", fmt::join(row.mnemonics, " "), quoted(row.form),
                        in_microseconds(row.base), row.per_unit ? in_microseconds(row.per_unit) : "", quoted(row.unit),
                        row.marker, quoted(row.source), row.uncertainty);
  return text;
}

}  // namespace s7200
