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
    std::vector<std::string> field;
    std::istringstream fields(line);
    for (std::string text; std::getline(fields, text, ',');) field.push_back(text);
    if (field.size() < 4) continue;
    const bool bracketed = field[0].starts_with('(');
    rows_.push_back({bracketed ? std::set<std::string>{field[0]} : words(field[0]),
                     areas_of(field[1]),
                     {nanoseconds(field[2]), nanoseconds(field[3])}});
  }
}

Cost Times::of(const std::string& mnemonic, const std::string& area) const {
  for (const Row& row : rows_)
    if (row.mnemonics.contains(mnemonic) && (row.areas.empty() || row.areas.contains(area))) return row.cost;
  throw std::out_of_range("no time for " + mnemonic + " " + area);
}

const Times& cpu214_times() {
  static const Times kTimes = [] {
    std::ifstream in(test::source_path("interpreter/model/cpu214_times.csv"));
    return Times({std::istreambuf_iterator<char>(in), {}});
  }();
  return kTimes;
}

}  // namespace s7200::reference
