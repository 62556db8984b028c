#include "tools/coverage/coverage_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/ladder/networks.hpp"
#include "tools/coverage/programs.hpp"
#include "tools/views/text_table.hpp"

namespace s7200::tools {
namespace {

/// What stands beside the figures of a network, or of a routine or program.
struct Span {
  std::uint32_t first = 0, end = 0;  ///< its ops
};

class FigureReader {
 public:
  FigureReader(const CoverageMap& map, const Tried& tried)
      : map_(map), tried_(tried), deciding_(tried.deciding(map)), networks_(map.program()) {}

  CoverageFigures of(const Span& span) const {
    CoverageFigures figures;
    for (std::uint32_t op = span.first; op < span.end; ++op) {
      if (networks_.begins(op)) count_network(figures.networks, op);
      if (map_.is_instruction(op)) figures.instructions.count(tried_.was(op, Tried::kExecuted));
      if (map_.is_contact(op)) figures.contacts.count(tried_.was(op, Tried::kOpen) && tried_.was(op, Tried::kClosed));
      if (map_.may_decide(op)) figures.deciding.count(deciding_[op]);
    }
    return figures;
  }

  bool has_decided(std::uint32_t op) const { return deciding_[op]; }
  Span network(std::uint32_t first) const {
    std::uint32_t end = first + 1;
    while (end < map_.program().ops.size() && !networks_.begins(end)) ++end;
    return {first, end};
  }

 private:
  /// Whether something of a network was executed. Heads of routines stand in networks without instructions.
  void count_network(Share& share, std::uint32_t first) const {
    const Span span = network(first);
    bool has_any = false, entered = false;
    for (std::uint32_t op = span.first; op < span.end; ++op) {
      has_any |= map_.is_instruction(op);
      entered |= map_.is_instruction(op) && tried_.marks[op] != 0;
    }
    if (has_any) share.count(entered);
  }

  const CoverageMap& map_;
  const Tried& tried_;
  std::vector<bool> deciding_;
  const Networks networks_;
};

std::string share_text(const Share& share) { return share.all == 0 ? "-" : fmt::format("{} of {}", share.tried, share.all); }

std::string rounded(double percent) { return fmt::format("{:.1f}%", std::floor(percent * 10) / 10); }

std::string share_line(std::string_view name, const Share& share) {
  return fmt::format("  {:<14} {:>6}  {} of {}\n", name, rounded(share.percent()), share.tried, share.all);
}

bool is_complete(const CoverageFigures& figures) {
  return figures.instructions.complete() && figures.contacts.complete() && figures.deciding.complete();
}

std::string table_text(const FigureReader& reader, const Inspection& inspection) {
  TextTable table({{"routine"},
                   {"network", TextTable::Align::Right},
                   {"instructions", TextTable::Align::Right},
                   {"contacts", TextTable::Align::Right},
                   {"deciding", TextTable::Align::Right}});
  const auto add = [&](const std::string& routine, const std::string& network, const CoverageFigures& figures) {
    table.add(
        {routine, network, share_text(figures.instructions), share_text(figures.contacts), share_text(figures.deciding)});
  };
  for (const Routine& routine : inspection.facts.flow.routines) {
    add(routine_text(routine), "", reader.of({routine.first, routine.end}));
    for (std::uint32_t op = routine.first; op < routine.end;) {
      const Span network = reader.network(op);
      const CoverageFigures figures = reader.of(network);
      const std::uint32_t number = inspection.facts.networks[op];
      if (!is_complete(figures)) add("", number == 0 ? "-" : fmt::format("{}", number), figures);
      op = network.end;
    }
  }
  return table.text(100);
}

std::string untried_line(const Untried& untried, const Inspection& inspection) {
  const std::uint32_t more = untried.end - untried.op - 1;
  std::string what = untried.what;
  if (more > 0) what += fmt::format(", nor the {} after it", more == 1 ? "one" : std::to_string(more));
  if (!untried.why.empty()) what += ": " + untried.why;
  std::string row = row_text(inspection, "  ", untried.op);
  while (row.ends_with('\n') || row.ends_with(' ')) row.pop_back();
  constexpr std::size_t kBeside = 64;  // column of what was not tried, if the instruction leaves room for it
  if (stl::count_characters(row) + 2 > kBeside) return row + "\n" + std::string(8, ' ') + wrapped_at(what, 8, 8) + "\n";
  return column(std::move(row), kBeside) + wrapped_at(what, kBeside, kBeside) + "\n";
}

std::string with_line_end(std::string text) {
  if (!text.ends_with('\n')) text += '\n';
  return text;
}

}  // namespace

std::string coverage_name(const Program& program) { return file_path(program.source.name).lexically_normal().string(); }

void CoverageOfPrograms::add(const std::shared_ptr<const CoverageMap>& map, const Tried& tried) {
  for (ProgramCoverage& known : programs_)
    if (known.map == map || is_same_program(known.map->program(), map->program())) return known.tried.add(tried);
  programs_.push_back({map, tried});
}

double CoverageOfPrograms::least() const {
  double least = 100;
  for (const ProgramCoverage& each : programs_) least = std::min(least, figures_of(*each.map, each.tried).least());
  return least;
}

CoverageFigures figures_of(const CoverageMap& map, const Tried& tried) {
  return FigureReader(map, tried).of({0, static_cast<std::uint32_t>(map.program().ops.size())});
}

std::vector<Untried> untried_of(const CoverageMap& map, const Tried& tried, const Inspection& inspection) {
  const FigureReader reader(map, tried);
  const std::vector<bool> reachable = reachable_ops(inspection.facts.flow);
  const Networks networks(map.program());
  std::vector<Untried> all;
  const auto executed = [&](std::uint32_t op) { return !map.is_instruction(op) || tried.was(op, Tried::kExecuted); };
  for (std::uint32_t op = 0; op < map.program().ops.size(); ++op) {
    Untried found{.op = op, .end = op + 1};
    if (!executed(op)) {
      while (found.end < map.program().ops.size() && !executed(found.end) && !networks.begins(found.end) &&
             tried.marks[found.end] == tried.marks[op])
        ++found.end;
      found.what = tried.was(op, Tried::kSkipped) ? "never had power flow" : "never executed";
      if (!reachable[op]) found.why = "nothing in the program leads to it";
      op = found.end - 1;
    } else if (map.is_contact(op)) {
      const bool open = tried.was(op, Tried::kOpen), closed = tried.was(op, Tried::kClosed);
      if (open && closed && (!map.may_decide(op) || reader.has_decided(op))) continue;
      found.what = !open ? "never open" : !closed ? "never closed" : "never decided alone";
    } else {
      continue;
    }
    all.push_back(std::move(found));
  }
  return all;
}

std::string figures_text(const CoverageFigures& figures) {
  return fmt::format("instructions {}, contacts {}, deciding {}", rounded(figures.instructions.percent()),
                     rounded(figures.contacts.percent()), rounded(figures.deciding.percent()));
}

std::string coverage_text(const ProgramCoverage& coverage) {
  const CoverageMap& map = *coverage.map;
  const Inspection inspection = for_places(map.shared_program());
  const FigureReader reader(map, coverage.tried);
  const CoverageFigures figures = figures_of(map, coverage.tried);
  std::string text =
      fmt::format("coverage of {}, CPU {}\n", stl::printable(coverage_name(map.program())), map.program().model->name);
  text += share_line("networks", figures.networks) + share_line("instructions", figures.instructions) +
          share_line("contacts", figures.contacts) + share_line("deciding", figures.deciding);
  text += "\n" + with_line_end(table_text(reader, inspection));
  const std::vector<Untried> untried = untried_of(map, coverage.tried, inspection);
  if (untried.empty()) return text + "\nnothing was left untried\n";
  text += "\nnever tried:\n";
  for (const Untried& each : untried) text += untried_line(each, inspection);
  return text;
}

namespace {

nlohmann::ordered_json share_json(const Share& share) {
  return {{"tried", share.tried}, {"all", share.all}, {"percent", std::floor(share.percent() * 100) / 100}};
}

}  // namespace

nlohmann::ordered_json figures_json(const CoverageFigures& figures) {
  return {{"networks", share_json(figures.networks)},
          {"instructions", share_json(figures.instructions)},
          {"contacts", share_json(figures.contacts)},
          {"deciding", share_json(figures.deciding)}};
}

nlohmann::ordered_json coverage_json(const ProgramCoverage& coverage) {
  const CoverageMap& map = *coverage.map;
  const Inspection inspection = for_places(map.shared_program());
  const FigureReader reader(map, coverage.tried);
  nlohmann::ordered_json json{{"program", coverage_name(map.program())}, {"cpu", map.program().model->name}};
  json.update(figures_json(figures_of(map, coverage.tried)));
  json["routines"] = nlohmann::ordered_json::array();
  for (const Routine& routine : inspection.facts.flow.routines) {
    nlohmann::ordered_json of_routine{{"routine", routine_text(routine)}};
    of_routine.update(figures_json(reader.of({routine.first, routine.end})));
    json["routines"].push_back(std::move(of_routine));
  }
  json["untried"] = nlohmann::ordered_json::array();
  for (const Untried& each : untried_of(map, coverage.tried, inspection)) {
    nlohmann::ordered_json one = place_json(inspection, each.op);
    one["instructions"] = each.end - each.op;
    one["what"] = each.what;
    one["why"] = each.why;
    json["untried"].push_back(std::move(one));
  }
  json["constant"] = nlohmann::ordered_json::array();
  for (std::uint32_t op = 0; op < map.program().ops.size(); ++op)
    if (!map.why_constant(op).empty()) {
      nlohmann::ordered_json one = place_json(inspection, op);
      one["why"] = map.why_constant(op);
      json["constant"].push_back(std::move(one));
    }
  return json;
}

}  // namespace s7200::tools
