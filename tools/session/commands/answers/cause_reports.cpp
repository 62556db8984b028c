#include "tools/session/commands/answers/cause_reports.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/causes/coils.hpp"
#include "tools/session/causes/effects/effect.hpp"
#include "tools/session/causes/last/last_decision.hpp"
#include "tools/session/causes/memory_cause.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/commands/instruction_words.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/observers/timeline_of_past.hpp"
#include "tools/session/words/bad_pointers.hpp"

namespace s7200::tools {
namespace {

/// What to type for what is because of a node: `why not M0.0`.
std::string further_question(const Wish& wish, const Obstacle& node, bool is_root) {
  if (is_root) return fmt::format("why not {} all", stl::printable(wish.text));
  const std::string_view asks = node.wanted.empty() ? "why" : node.wanted == "0" ? "why not not" : "why not";
  return fmt::format("{} {}", asks, memory_text(as_named(node.bits)));
}

/// `places`: what it was about; what of it is forced is said if the system wrote it.
FoundInPast found(const Session& session, const WriterSearch& search, const std::vector<Bits>& places) {
  if (search.interrupted) return {interrupted(session)};
  if (!search.writer) return {{.text = search.none + "\n", .json = {{"text", search.none}}}};
  const Writer& writer = *search.writer;
  Json json{{"text", writer.text}};
  if (writer.by) json.update(instruction_json(session, *writer.by));
  const std::string forced = writer.by_system ? forced_text(session, session.cpu(), places) : "";
  return {{.text = writer.text + forced + "\n", .json = std::move(json)}, writer.moment};
}

}  // namespace

std::string coils_text(const Program& program, const std::vector<std::uint32_t>& coils) {
  std::vector<std::string> names;
  for (const std::uint32_t op : coils)
    names.push_back(fmt::format("{} in {}", short_text(program.statement(op)), line_of(op, program)));
  return stl::joined(
      names, [](const std::string& name) { return name; }, " and ");
}

std::string to_come_text(const Session& session, const Bits& bit) {
  const std::vector<std::uint32_t> coils = coils_to_come(session.cpu(), bit);
  if (coils.empty()) return {};
  return fmt::format("  {} still follow{} in this scan\n", coils_text(session.program(), coils),
                     coils.size() == 1 ? "s" : "");
}

FoundInPast last_writer(Session& session, const MemoryRange& range, std::string_view name) {
  return found(session,
               find_writer(session.history, session.focus(), session.listing(), range, name, session.setup.stop_request),
               {bits_of(range)});
}

FoundInPast last_writer(Session& session, std::uint8_t event) {
  return found(session, find_writer(session.history, session.focus(), session.listing(), event, session.setup.stop_request),
               {});
}

FoundInPast last_decider(Session& session) {
  const DecisionSearch search =
      find_last_decision(session.history, session.focus(), session.stepper.host_timeout(), session.setup.stop_request);
  const std::string text = fmt::format("{}", fmt::join(to_lines(search, session.listing()), "\n"));
  if (search.interrupted) {
    Reply reply = interrupted(session);
    return {{.text = (text.empty() ? "" : text + "\n") + reply.text, .interrupted = true}};
  }
  FoundInPast found{{.text = text + "\n", .json = {{"text", text}}}};
  if (const auto origin = search.origin()) {
    found.reply.json.update(instruction_json(session, origin->by));
    found.moment = origin->moment;
  } else {
    found.reply.json["whyNoMoment"] = search.why_no_origin();
  }
  return found;
}

Reply cause_of(Session& session, const MemoryRange& range, std::string_view name) {
  const Cpu& cpu = session.cpu();
  const std::string value = value_of(cpu, range);
  const auto lines = memory_cause(session.history, session.focus(), range, session.setup.stop_request);
  if (!lines) return interrupted(session);
  const std::string to_come = range.width == Width::Bit ? to_come_text(session, bits_of(range)) : "";
  Reply reply{.text = fmt::format("{} is {}; {}\n{}", name, value, fmt::join(*lines, "\n  "), to_come),
              .json = {{"name", name}, {"value", value}, {"causes", *lines}}};
  if (!to_come.empty()) reply.json["stillToCome"] = stl::trim(to_come);
  return reply;
}

Reply obstacles_to(Session& session, const Wish& wish, bool all) {
  const Cpu& cpu = session.cpu();
  const std::string name = stl::printable(wish.text);
  Json json{{"name", name}};
  const auto holds = holds_now(wish, cpu);
  if (!holds) return wrong(fmt::format("{}: {}", name, holds.why()));
  json["holds"] = *holds;
  if (*holds) {
    const std::string values =
        wish.bit ? "" : fmt::format(": {}", wish.condition->places_text(cpu, Expression::SeenBy::Outside));
    return {.text = fmt::format("{} holds now{}\n", name, values), .json = std::move(json)};
  }
  const auto answer = why_not(session.history, session.focus(), wish, session.setup.stop_request);
  if (!answer) return interrupted(session);
  json["whyNot"] = to_json(*answer);
  const std::string standstill = session.simulation().plc().executes()
                                     ? ""
                                     : fmt::format("{} executes nothing now\n", session.name_of(session.focus()));
  const auto question = [&](const Obstacle& node, bool is_root) { return further_question(wish, node, is_root); };
  const std::vector<std::string> lines = all ? lines_of(*answer) : few_lines_of(*answer, question);
  return {.text = fmt::format("{}{}\n", standstill, fmt::join(lines, "\n")), .json = std::move(json)};
}

Reply effect_of(Session& session, const MemoryRange& range, std::string_view name, Time within) {
  const EffectSearch search = find_effect(session.history, session.focus(), range, name, within, session.setup.stop_request);
  if (search.interrupted) return interrupted(session);
  if (!search.answer) return {.text = search.none + "\n", .json = {{"text", search.none}}};
  return {.text = fmt::format("{}\n", fmt::join(lines_of(*search.answer), "\n")),
          .json = {{"effect", to_json(*search.answer)}}};
}

Reply timeline_since(Session& session, Time from, const serial::Exchange& exchange) {
  const std::shared_ptr<const Program> program(std::shared_ptr<void>(), &session.program());  // not owned
  const auto report = timeline_of_past(session.history, session.focus(), program, from, session.setup.stop_request);
  if (!report) return interrupted(session);
  return {.text = stl::wrapped(to_text(*report, exchange, session.setup.colour), session.setup.width),
          .json = {{"text", to_text(*report, exchange, false)}, {"timeline", to_json(*report, exchange)}}};
}

std::string bad_pointer_report(Session& session, const std::string& name, const MemoryRange& pointer) {
  const std::string address = address_name(session.program(), pointer, pointer.name_of(0));
  return bad_pointer_text(session.cpu(), pointer, name, address) + "\n" + last_writer(session, pointer, address).reply.text;
}

}  // namespace s7200::tools
