#include "tools/views/program/listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/statement_text.hpp"

namespace s7200::tools {
namespace {

std::string text_of(const stl::Statement& statement) {
  const std::string text = stl::to_text(statement);
  return statement.comment.empty() ? text : fmt::format("{:<28} //{}", text, statement.comment);
}

std::string text_of(const stl::NetworkHead& head) {
  std::string text = "NETWORK";
  if (head.number != 0) text += fmt::format(" {}", head.number);
  return head.comment.empty() ? text : fmt::format("{} //{}", text, head.comment);
}

std::string name_of(const stl::NetworkHead& head) {
  std::string name = "network";
  if (head.number != 0) name += fmt::format(" {}", head.number);
  const std::string title(stl::trim(head.comment));
  return title.empty() ? name : fmt::format("{} \"{}\"", name, stl::printable(title));
}

}  // namespace

Listing::Listing(const Program& program) : program_(program), networks_(program) {
  std::uint32_t op = 0;
  std::string network;
  for (const stl::Line& line : program.source.lines) {
    if (const auto* statement = std::get_if<stl::Statement>(&line)) {
      const bool goes_on = network.empty() && !networks_.begins(op);
      network_.push_back(goes_on ? network_.back() : std::exchange(network, {}));
      entries_.push_back({statement->position.line, stl::printable(tools::text_of(*statement)), op++});
    } else if (const auto* head = std::get_if<stl::NetworkHead>(&line)) {
      network = name_of(*head);
      entries_.push_back({head->position.line, stl::printable(tools::text_of(*head)), {}});
    } else if (const auto* comment = std::get_if<stl::CommentLine>(&line)) {
      entries_.push_back({comment->line, stl::printable("//" + comment->text), {}});
    }
  }
}

std::optional<std::uint32_t> Listing::op_from_line(std::uint32_t line) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.op && e.line >= line; });
  return found == entries_.end() ? std::nullopt : found->op;
}

std::optional<std::uint32_t> Listing::op_of_network(std::uint32_t number) const {
  for (const stl::Line& line : program_.source.lines)
    if (const auto* head = std::get_if<stl::NetworkHead>(&line); head && head->number == number && number != 0) {
      const auto op = op_from_line(head->position.line);
      const auto is_head = [&](const stl::Line& l) {
        const auto* other = std::get_if<stl::NetworkHead>(&l);
        return other && op && other->position.line > head->position.line && other->position.line < line_of(*op);
      };
      return std::any_of(program_.source.lines.begin(), program_.source.lines.end(), is_head) ? std::nullopt : op;
    }
  return {};
}

std::uint32_t Listing::last_line() const { return line_of(static_cast<std::uint32_t>(program_.ops.size()) - 1); }

std::string Listing::text_of(std::uint32_t op) const { return stl::printable(tools::text_of(program_.statement(op))); }

std::string Listing::around(std::uint32_t line, std::size_t before, std::size_t count, const Mark& mark) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.line >= line; });
  const auto place = static_cast<std::size_t>(found - entries_.begin());
  const std::size_t first = place - std::min(place, before), end = std::min(entries_.size(), first + count);
  const std::span<const Entry> shown(entries_.begin() + static_cast<std::ptrdiff_t>(first), end - first);
  std::size_t width = 5;
  for (const Entry& entry : shown) width = std::max(width, stl::count_characters(line_number(entry.line, program_)));
  std::string text;
  for (const Entry& entry : shown)
    text += fmt::format("{:>2} {:>{}}  {}\n", entry.op ? mark(*entry.op) : "", line_number(entry.line, program_), width,
                        entry.text);
  return text;
}

}  // namespace s7200::tools
