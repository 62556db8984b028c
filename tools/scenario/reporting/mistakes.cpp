#include "tools/scenario/reporting/mistakes.hpp"

#include <fmt/format.h>

namespace s7200::tools {

std::vector<Mistake> mistakes_in(const Messages& messages) {
  std::vector<Mistake> all;
  for (const Message& message : messages) {
    if (message.kind == Message::Kind::Error) all.push_back({.text = message.text});
    if (message.kind != Message::Kind::Diagnostics) continue;
    for (const auto& one : message.diagnostics) {
      if (one.severity == stl::Severity::Warning) continue;
      const stl::FileLine place = stl::in_file(*message.source, one.position.line);
      all.push_back({place.file, {place.line, one.position.column}, one.message});
    }
  }
  return all;
}

std::string mistake_text(const Mistake& mistake) {
  if (mistake.file.empty()) return mistake.text;
  return fmt::format("{}:{}:{}: {}", mistake.file, mistake.position.line, mistake.position.column, mistake.text);
}

}  // namespace s7200::tools
