#include "tools/coverage/coverage_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/coverage/programs.hpp"
#include "tools/views/escapes.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kCoverageStyle =
    "body{font:14px/1.4 sans-serif;margin:2em auto;max-width:72em;padding:0 1em}"
    "table{border-collapse:collapse}td,th{padding:0 .8em;text-align:right}td:first-child,th:first-child{text-align:left}"
    "pre{font:12px/1.35 monospace}pre span{display:block}"
    ".tried{background:#dcf5dc}.part{background:#fff3c4}.never{background:#fbd5d5}i{color:#555;font-style:normal}";

/// The ops of each line of the source.
std::map<std::uint32_t, std::vector<std::uint32_t>> ops_by_line(const Program& program) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> lines;
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) lines[program.statement(op).position.line].push_back(op);
  return lines;
}

/// What stands behind a line, and how it is coloured.
struct LineState {
  std::string style, remark;
};

class PageOfProgram {
 public:
  explicit PageOfProgram(const ProgramCoverage& coverage)
      : map_(*coverage.map), tried_(coverage.tried), deciding_(tried_.deciding(map_)), lines_(ops_by_line(map_.program())) {}

  std::string text() const {
    const Program& program = map_.program();
    std::string page = fmt::format("<h2>{}, CPU {}</h2>\n", as_markup(stl::printable(coverage_name(program))),
                                   as_markup(program.model->name));
    page += figures();
    page += "<pre>\n";
    for (std::uint32_t line = 1; line <= program.source.text.size(); ++line) page += source_line(line);
    return page + "</pre>\n";
  }

 private:
  std::string figures() const {
    const CoverageFigures all = figures_of(map_, tried_);
    std::string table = "<table><tr><th></th><th>tried</th><th>of</th><th>share</th></tr>\n";
    const auto row = [&](std::string_view name, const Share& share) {
      table += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.1f}%</td></tr>\n", name, share.tried, share.all,
                           share.percent());
    };
    row("networks", all.networks);
    row("instructions", all.instructions);
    row("contacts, open and closed", all.contacts);
    row("contacts that have decided alone", all.deciding);
    return table + "</table>\n";
  }

  LineState state_of(std::uint32_t op) const {
    if (!map_.is_instruction(op)) return {};
    if (!tried_.was(op, Tried::kExecuted))
      return {"never", tried_.was(op, Tried::kSkipped) ? "never had power flow" : "never executed"};
    if (!map_.why_constant(op).empty()) return {"tried", map_.why_constant(op)};
    if (!map_.is_contact(op)) return {"tried", ""};
    const bool open = tried_.was(op, Tried::kOpen), closed = tried_.was(op, Tried::kClosed);
    if (!open || !closed) return {"part", open ? "never closed" : "never open"};
    if (map_.may_decide(op) && !deciding_[op]) return {"part", "never decided alone"};
    return {"tried", ""};
  }

  std::string source_line(std::uint32_t line) const {
    const Program& program = map_.program();
    LineState state;
    if (const auto found = lines_.find(line); found != lines_.end())
      for (const std::uint32_t op : found->second) state = state_of(op);
    return fmt::format("<span{}>{:>5}  {}{}</span>", state.style.empty() ? "" : fmt::format(" class=\"{}\"", state.style),
                       stl::in_file(program.source, line).line, as_markup(stl::printable(program.source.text[line - 1])),
                       state.remark.empty() ? "" : fmt::format("   <i>&larr; {}</i>", as_markup(state.remark)));
  }

  const CoverageMap& map_;
  const Tried& tried_;
  std::vector<bool> deciding_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> lines_;
};

/// The records of one file of a program.
struct LcovFile {
  std::string functions, calls, branches, lines;
  std::size_t functions_all = 0, functions_tried = 0, branches_all = 0, branches_tried = 0, lines_all = 0, lines_tried = 0;
};

class LcovOfProgram {
 public:
  explicit LcovOfProgram(const ProgramCoverage& coverage)
      : map_(*coverage.map), tried_(coverage.tried), inspection_(for_places(map_.shared_program())) {
    for (const Routine& routine : inspection_.facts.flow.routines) add(routine);
    for (std::uint32_t op = 0; op < map_.program().ops.size(); ++op)
      if (map_.is_instruction(op)) add(op);
  }

  std::string text() const {
    std::string text;
    for (const auto& [name, file] : files_)
      text += fmt::format("{}SF:{}\n{}{}FNF:{}\nFNH:{}\n{}BRF:{}\nBRH:{}\n{}LF:{}\nLH:{}\nend_of_record\n", kLcovBeginning,
                          name, file.functions, file.calls, file.functions_all, file.functions_tried, file.branches,
                          file.branches_all, file.branches_tried, file.lines, file.lines_all, file.lines_tried);
    return text;
  }

 private:
  stl::FileLine place(std::uint32_t op) const {
    return stl::in_file(map_.program().source, map_.program().statement(op).position.line);
  }
  LcovFile& file_of(std::uint32_t op) {
    return files_[stl::printable(file_path(place(op).file).lexically_normal().string())];
  }

  void add(const Routine& routine) {
    if (routine.first >= routine.end) return;
    bool was = false;
    for (std::uint32_t op = routine.first; op < routine.end; ++op) was |= tried_.marks[op] != 0;
    LcovFile& file = file_of(routine.first);
    file.functions += fmt::format("FN:{},{}\n", place(routine.first).line, routine_text(routine));
    file.calls += fmt::format("FNDA:{},{}\n", int(was), routine_text(routine));
    ++file.functions_all;
    file.functions_tried += was;
  }

  void add(std::uint32_t op) {
    LcovFile& file = file_of(op);
    const std::uint32_t line = place(op).line;
    const bool executed = tried_.was(op, Tried::kExecuted);
    file.lines += fmt::format("DA:{},{}\n", line, int(executed));
    ++file.lines_all;
    file.lines_tried += executed;
    if (!map_.is_contact(op)) return;
    const auto add_branch = [&](int number, Tried::Mark mark) {
      const bool was = tried_.was(op, mark);
      file.branches += fmt::format("BRDA:{},0,{},{}\n", line, number, !executed ? "-" : was ? "1" : "0");
      ++file.branches_all;
      file.branches_tried += was;
    };
    add_branch(0, Tried::kClosed);
    add_branch(1, Tried::kOpen);
  }

  const CoverageMap& map_;
  const Tried& tried_;
  const Inspection inspection_;
  std::map<std::string, LcovFile> files_;
};

}  // namespace

std::string coverage_page(const CoverageOfPrograms& coverage) {
  std::string page = fmt::format(
      "{}<head><meta charset=\"utf-8\"><title>Coverage</title><style>{}</style></head>\n<body>\n"
      "<h1>What was tried</h1>\n",
      kCoveragePageBeginning, kCoverageStyle);
  for (const ProgramCoverage& each : coverage.programs()) page += PageOfProgram(each).text();
  return page + "</body>\n</html>\n";
}

std::string coverage_lcov(const CoverageOfPrograms& coverage) {
  std::string text;
  for (const ProgramCoverage& each : coverage.programs()) text += LcovOfProgram(each).text();
  return text;
}

}  // namespace s7200::tools
