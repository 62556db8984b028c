#include "interpreter/program/loading/slips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200 {
namespace {

struct SlipRow {
  std::string_view id, routine;  // an empty routine: in any of them
  std::string_view printed, meant, reason;
};

// The PC protocol with commands of 33 bytes for a CPU 22x.
constexpr std::array kPcProtocol{
    SlipRow{"R1", "Initialize", "MOVB +1000, SMW92", "MOVW +1000, SMW92", "1000 is not a byte, and SMW92 is a word"},
    SlipRow{"R2", "Initialize", "MOVB &VB102, VD149", "MOVD &VB102, VD149", "a pointer is a double word"},
    SlipRow{"R3", "Initialize", "MOVB &VB156, VD181", "MOVD &VB156, VD181", "a pointer is a double word"},
    SlipRow{"R4", "", "MOVB 26, VB174", "MOVB 16#26, VB174", "the text says that an answer ends with 26 in hex"},
    SlipRow{"R5", "Initialize", "MOVB 35, SMB94", "MOVB 33, SMB94", "a command has 33 characters, and the buffer too"},
    SlipRow{"R6", "Initialize", "R SM87.2, 1", "", "it switches off the time-out that is set up before it"},
    SlipRow{"R7", "Verify", "R M0.1, 1", "R M0.1, 1\nR M0.0, 1", "a command for another station leaves M0.0 on"},
    SlipRow{"R8", "", "CALL initialize", "CALL Initialize", "the heading is written with a capital"},
};

struct Listing {
  std::span<const std::string_view> routines;  // by these it is known
  std::span<const SlipRow> slips;
};

constexpr std::array<std::string_view, 6> kPcProtocolRoutines{"Read",       "Write",       "Verify",
                                                              "Initialize", "RCVcomplete", "XMTcomplete"};
constexpr std::array kListings{Listing{kPcProtocolRoutines, kPcProtocol}};

const Listing* listing_of(const stl::Source& source) {
  const auto has = [&](std::string_view name) {
    return std::ranges::find(source.blocks, name, &stl::Block::name) != source.blocks.end();
  };
  const auto known =
      std::ranges::find_if(kListings, [&](const Listing& each) { return std::ranges::all_of(each.routines, has); });
  return known == kListings.end() ? nullptr : &*known;
}

std::vector<stl::Statement> statements(std::string_view text) {
  std::vector<stl::Statement> found;
  for (stl::Line& line : stl::parse(text, {}).source.lines)
    if (auto* statement = std::get_if<stl::Statement>(&line)) found.push_back(std::move(*statement));
  return found;
}

std::string_view routine_at(const stl::Source& source, std::uint32_t line) {
  for (const stl::Block& block : source.blocks)
    if (line >= block.position.line && line <= block.last_line) return block.name;
  return {};
}

/// Whether a statement is `printed` and nothing else.
bool is_printed(const stl::Statement& statement, const stl::Statement& printed) {
  return statement.mnemonic == printed.mnemonic &&
         std::ranges::equal(statement.operands, printed.operands, {}, &stl::Operand::value, &stl::Operand::value);
}

/// The lines of `source` that hold a slip.
std::vector<std::size_t> find(const stl::Source& source, const SlipRow& row) {
  const stl::Statement printed = statements(row.printed).front();
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    const auto* statement = std::get_if<stl::Statement>(&source.lines[i]);
    if (statement == nullptr || !is_printed(*statement, printed)) continue;
    if (row.routine.empty() || row.routine == routine_at(source, statement->position.line)) found.push_back(i);
  }
  return found;
}

/// Puts what was meant in place of a line; its place and its comment stay.
void put(stl::Source& source, std::size_t line, const SlipRow& row) {
  auto meant = statements(row.meant);
  const auto& printed = std::get<stl::Statement>(source.lines[line]);
  for (stl::Statement& statement : meant) {
    statement.position = printed.position;
    for (stl::Operand& operand : statement.operands) operand.position = printed.position;
  }
  if (!meant.empty()) meant.front().comment = printed.comment;
  const auto place = source.lines.erase(source.lines.begin() + static_cast<std::ptrdiff_t>(line));
  source.lines.insert(place, std::make_move_iterator(meant.begin()), std::make_move_iterator(meant.end()));
}

}  // namespace

std::vector<Slip> find_slips(const stl::Source& source) {
  std::vector<Slip> slips;
  const Listing* listing = listing_of(source);
  if (listing == nullptr) return slips;
  for (const SlipRow& row : listing->slips) {
    Slip slip{row.id, row.printed, row.meant, row.reason, false, {}};
    for (const std::size_t line : find(source, row))
      slip.places.push_back(std::get<stl::Statement>(source.lines[line]).position);
    if (!slip.places.empty()) slips.push_back(std::move(slip));
  }
  return slips;
}

Result<Repairs> parse_repairs(std::string_view text) {
  Repairs repairs{.all = text == "all"};
  while (!repairs.all && text != "none") {
    const std::size_t end = std::min(text.find(','), text.size());
    const std::string id = stl::upper_case(stl::trim(text.substr(0, end)));
    const bool number = id.size() > 1 && id.front() == 'R' && std::all_of(id.begin() + 1, id.end(), stl::is_digit);
    if (!number) return trouble("'{}' is not a repair; write for example R1,R2 or all", stl::shortened(id));
    repairs.ids.insert(id);
    if (end == text.size()) break;
    text.remove_prefix(end + 1);
  }
  return repairs;
}

std::vector<Slip> repair(stl::Source& source, const Repairs& repairs, std::vector<std::string>& unknown) {
  std::vector<Slip> slips = find_slips(source);
  for (const std::string& id : repairs.ids)
    if (std::ranges::find(slips, id, &Slip::id) == slips.end()) unknown.push_back(id);
  for (Slip& slip : slips) {
    slip.applied = repairs.has(slip.id);
    if (!slip.applied) continue;
    const SlipRow& row = *std::ranges::find(listing_of(source)->slips, slip.id, &SlipRow::id);
    const auto lines = find(source, row);
    for (auto line = lines.rbegin(); line != lines.rend(); ++line) put(source, *line, row);
  }
  return slips;
}

std::string to_text(const Slip& slip, const stl::Source& source) {
  std::vector<std::uint32_t> lines;
  for (const stl::Position& place : slip.places) lines.push_back(stl::in_file(source, place.line).line);
  std::string meant(slip.meant);
  if (const std::size_t end = meant.find('\n'); end != std::string::npos) meant.replace(end, 1, " / ");
  const std::string action = meant.empty() ? "left out" : "read as " + meant;
  return fmt::format("{}: slip {} in {} {}: {} is {}{}: {}", source.name, slip.id, noun(lines.size(), "line"),
                     fmt::join(lines, ", "), slip.printed,
                     slip.applied ? "" : fmt::format("kept; --repair {} has it ", slip.id), action, slip.reason);
}

}  // namespace s7200
