#include "tools/views/inspection/document_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/views/escapes.hpp"
#include "tools/views/inspection/inspect_views.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kName = "document";

constexpr std::string_view kDocumentStyle =
    "body{font:11pt/1.35 sans-serif;margin:2em auto;max-width:64em;padding:0 1em}"
    "pre{font:8.5pt/1.25 monospace;white-space:pre-wrap}h1,h2,h3{line-height:1.2}"
    "nav ul{margin:0}@page{margin:15mm}"
    "@media "
    "print{body{margin:0;max-width:none}section{break-before:page}h2,h3{break-after:avoid}a{color:inherit;text-decoration:"
    "none}}";

/// A part of the page, with parts of its own.
struct Part {
  std::string anchor, title, text;
  std::vector<Part> parts{};
};

std::string symbols_text(const Inspection& inspection) {
  std::string text;
  for (const stl::Symbol& symbol : inspection.program->source.symbols) {
    const std::string value = symbol.value ? stl::to_text(stl::Operand{*symbol.value}) : "";
    text +=
        column(stl::printable(symbol.name), 28) + column(stl::printable(value), 16) + stl::printable(symbol.comment) + "\n";
  }
  return text;
}

/// The program as it was read, with the numbers of its lines, file by file.
std::vector<Part> source_parts(const Inspection& inspection) {
  const stl::Source& source = inspection.program->source;
  std::vector<Part> files;
  std::string_view name;
  for (std::uint32_t line = 1; line <= source.text.size(); ++line) {
    const stl::FileLine place = stl::in_file(source, line);
    if (files.empty() || place.file != name) {
      name = place.file;
      files.push_back({fmt::format("file{}", files.size() + 1), stl::printable(name), "", {}});
    }
    files.back().text += fmt::format("{:>5}  {}\n", place.line, stl::printable(source.text[line - 1]));
  }
  return files;
}

bool is_in_document(const Inspection& inspection, const Routine& routine) {
  return inspection.selection.ops.empty() || std::ranges::any_of(inspection.selection.ops, [&](const Selection::Ops& each) {
           return each.first < routine.end && routine.first < each.end;
         });
}

/// The ladder, a part for each routine.
std::vector<Part> routine_parts(const Inspection& inspection, const InspectView& view) {
  std::vector<Part> routines;
  Inspection of_routine = inspection;
  for (const Routine& routine : inspection.facts.flow.routines) {
    if (!is_in_document(inspection, routine)) continue;
    of_routine.selection.ops = {{routine_text(routine), routine.first, routine.end}};
    routines.push_back(
        {fmt::format("ladder-{}", routine_text(routine)), routine_in_words(inspection, routine), view.text(of_routine), {}});
  }
  return routines;
}

std::vector<Part> parts_of(const Inspection& inspection) {
  std::vector<Part> parts;
  for (const InspectView& view : inspect_views()) {
    if (view.name == kName) continue;
    Part part{std::string(view.name), fmt::format("{}: {}", view.name, view.meaning), "", {}};
    if (view.name == "ladder")
      part.parts = routine_parts(inspection, view);
    else
      part.text = view.text(inspection);
    parts.push_back(std::move(part));
  }
  if (!inspection.program->source.symbols.empty()) parts.push_back({"symbols", "symbols", symbols_text(inspection), {}});
  parts.push_back({"source", "the program as it was read", "", source_parts(inspection)});
  return parts;
}

std::string contents(const std::vector<Part>& parts) {
  std::string html = "<ul>\n";
  for (const Part& part : parts)
    html += fmt::format("<li><a href=\"#{}\">{}</a>{}</li>\n", as_markup(part.anchor), as_markup(part.title),
                        part.parts.empty() ? "" : "\n" + contents(part.parts));
  return html + "</ul>\n";
}

std::string shown(const Part& part, int level) {
  std::string html = fmt::format("<h{0} id=\"{1}\">{2}</h{0}>\n", level, as_markup(part.anchor), as_markup(part.title));
  if (!part.text.empty()) html += fmt::format("<pre>{}</pre>\n", as_markup(part.text));
  for (const Part& inner : part.parts) html += shown(inner, level + 1);
  return level == 2 ? fmt::format("<section>\n{}</section>\n", html) : html;
}

std::string summary(const Inspection& inspection) {
  const Program& program = *inspection.program;
  return fmt::format("CPU {}, {} in {}; s7200 {}", program.model->name, counted(program.ops.size(), "instruction"),
                     counted(inspection.facts.flow.routines.size(), "routine"), version());
}

}  // namespace

std::string document_text(const Inspection& inspection) {
  const std::string title = as_markup(stl::printable(inspection.program->source.name));
  const std::vector<Part> parts = parts_of(inspection);
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; style-src 'unsafe-inline'\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
      "<h1>{0}</h1>\n<p>{2}</p>\n<nav>\n{3}</nav>\n",
      title, kDocumentStyle, as_markup(summary(inspection)), contents(parts));
  for (const Part& part : parts) html += shown(part, 2);
  return html + "</body>\n</html>\n";
}

nlohmann::ordered_json document_json(const Inspection& inspection) { return document_text(inspection); }

}  // namespace s7200::tools
