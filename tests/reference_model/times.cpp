#include "tests/reference_model/times.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "tests/support/source_path.hpp"

namespace s7200::reference {
namespace {

std::set<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::set<std::string> result;
  for (std::string word; in >> word;) result.insert(word);
  return result;
}

std::int64_t nanoseconds(const std::string& microseconds) {
  return microseconds.empty() ? 0 : std::llround(std::stod(microseconds) * 1000);
}

/// The fields of a line of CSV; a comma between quotes does not end one.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

/// The areas that a form names; empty if it contains anything else.
std::set<std::string> areas_of(const std::string& form) {
  static const std::set<std::string> kAreas{"I", "Q", "M", "SM", "S", "V", "T", "C", "AI", "AQ", "HC", "AC", "L"};
  const std::set<std::string> named = words(form);
  for (const std::string& word : named)
    if (!kAreas.contains(word)) return {};
  return named;
}

}  // namespace

Times::Times(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);  // the heading
  while (std::getline(in, line)) {
    const std::vector<std::string> field = fields_of(line);
    if (field.size() < 4) continue;
    const bool bracketed = field[0].starts_with('(');
    rows_.push_back({bracketed ? std::set<std::string>{field[0]} : words(field[0]),
                     areas_of(field[1]),
                     {nanoseconds(field[2]), nanoseconds(field[3])}});
  }
}

const Times::Row* Times::find(const std::string& mnemonic, const std::string& area) const {
  for (const Row& row : rows_)
    if (row.mnemonics.contains(mnemonic) && (row.areas.empty() || row.areas.contains(area))) return &row;
  return nullptr;
}

Cost Times::of(const std::string& mnemonic, const std::string& area) const {
  if (const Row* row = find(mnemonic, area)) return row->cost;
  throw std::out_of_range("no time for " + mnemonic + " " + area);
}

std::int64_t Times::added_by(const std::string& mnemonic, const std::vector<std::string>& areas) const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const Row* own = i == 0 ? find(mnemonic, areas[i]) : nullptr;
    if (own && !own->areas.empty()) continue;  // its figure is for this area
    const Row* adds = areas[i].empty() ? nullptr : find("(operand area adds)", areas[i]);
    if (adds) sum += adds->cost.base;
  }
  return sum;
}

static Times read(const std::string& path) {
  std::ifstream in(test::source_path(path));
  return Times({std::istreambuf_iterator<char>(in), {}});
}

const Times& cpu214_times() {
  static const Times kTimes = read("interpreter/model/cpus/cpu214_times.csv");
  return kTimes;
}

const Times& cpu224_times() {
  static const Times kTimes = read("interpreter/model/cpus/cpu22x_times.csv");
  return kTimes;
}

}  // namespace s7200::reference
