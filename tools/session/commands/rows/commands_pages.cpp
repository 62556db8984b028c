// The commands that pages and editors ask with: the program, memory and what happened, as JSON.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/observers/tracks_of_past.hpp"
#include "tools/session/past/actions/access.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/words/force_words.hpp"
#include "tools/session/words/print_forms.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/program/program_json.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools::commands {
namespace {

constexpr std::uint32_t kMostListed = 1000;
constexpr std::size_t kMostAsked = 1000;
constexpr Between<std::size_t> kElements{1, 20'000};
constexpr std::size_t kUsualElements = 2000;

std::string outline_text(const Json& outline) {
  std::string text;
  for (const Json& routine : outline["routines"]) {
    text += fmt::format("{:<8} from line {:<5} {}\n", routine["name"].get<std::string>(),
                        routine["line"].get<std::uint32_t>(), counted(routine["networks"].size(), "network"));
  }
  return text;
}

// --- values ---

/// Element `i` of a range in the image, of a bit the bit.
Bits element_bits(const MemoryRange& range, std::uint32_t i) {
  const Bits all = bits_of(range);
  return {all.first + i * (all.count / range.count), all.count / range.count};
}

bool is_forced(const std::vector<Forced>& forced, const Bits& bits) {
  return std::ranges::any_of(forced, [&](const Forced& one) { return bits_of(one.place).overlaps(bits); });
}

struct ValuesReply {
  Session& session;
  const std::vector<Forced> forced = forced_in(session.cpu());
  Reply reply{.json = {{"at_ns", session.history.now().time}, {"values", Json::array()}}};

  std::size_t count() const { return reply.json.at("values").size(); }

  void add(const std::string& name, const PrintForm& form) {
    const Cpu& cpu = session.cpu();
    Words address{name};
    if (const std::string why = with_local_variables(session, address, session.current_op()); !why.empty())
      return add_wrong(name, why);
    const auto place = parse_place(address.front(), cpu.program());
    const auto range = place ? range_now(*place, cpu) : std::nullopt;
    std::string why = place.why();
    if (place && !range) why = "the pointer points nowhere now";
    if (range && count() + range->count > kMostAsked) why = fmt::format("more than {} values are asked for", kMostAsked);
    if (!why.empty()) return add_wrong(name, why);
    for (std::uint32_t i = 0; i < range->count; ++i) add(name, *range, i, form);
  }

 private:
  void add_wrong(const std::string& name, const std::string& why) {
    reply.text += fmt::format("{}: {}\n", name, why);
    reply.json["values"].push_back({{"name", name}, {"error", why}});
  }

  void add(const std::string& name, const MemoryRange& range, std::uint32_t i, const PrintForm& form) {
    const State& state = session.cpu().state();
    const std::string text = form.text(bits_at(state, range, i), range.width, range.real);
    reply.text += fmt::format("{:<8} {}\n", range.name_of(i), text);
    reply.json["values"].push_back({{"name", name},
                                    {"address", range.name_of(i)},
                                    {"symbol", i == 0 ? symbol_name(session.program(), range) : ""},
                                    {"type", type_of(range)},
                                    {"text", text},
                                    {"number", value_json(state, range, i)},
                                    {"forced", is_forced(forced, element_bits(range, i))}});
  }
};

// --- spans ---

Json span_json(const TrackSpan& span, TrackKind kind) {
  Json json{{"at_ns", span.at}, {"end_ns", span.end}, {"text", span.text}};
  if (!span.error.empty()) json["error"] = span.error;
  if (!span.why.empty()) json["why"] = span.why;
  if (span.occurred) json["occurred_ns"] = *span.occurred;
  if (span.op) json["op"] = *span.op;
  if (span.value) json["value"] = *span.value;
  if (span.count == 1) return json;
  json["count"] = span.count;
  json["busy_ns"] = span.busy;
  json["errors"] = span.errors;
  if (is_of_numbers(kind)) {
    json["least"] = span.least;
    json["most"] = span.most;
  }
  return json;
}

Json format_json(const SerialFormat& format) {
  return {{"baud", format.baud},
          {"data_bits", format.data_bits},
          {"parity", word_of(format.parity)},
          {"stop_bits", format.stop_bits}};
}

Json track_json(const Session& session, const NamedTrack& one) {
  Json spans = Json::array();
  for (const TrackSpan& span : one.track.spans()) spans.push_back(span_json(span, one.kind));
  Json json{{"kind", word_of(one.kind)}, {"name", one.name}};
  if (session.is_system()) json["station"] = session.name_of(one.station);
  json["exact"] = one.track.is_exact();
  if (one.format) json["format"] = format_json(*one.format);
  json["spans"] = std::move(spans);
  return json;
}

Json longest_json(const Session& session, const LongestAnswers& longest) {
  Json all = Json::array();
  for (const AnsweredFrame& one : longest.all()) {
    all.push_back({{"at_ns", one.at},
                   {"end_ns", one.end},
                   {"answer_ns", one.answer_at},
                   {"answer_end_ns", one.answer_end},
                   {"text", one.text}});
    if (session.is_system()) all.back()["station"] = session.name_of(one.station);
  }
  return {{"count", longest.count()}, {"longest", std::move(all)}};
}

Json longest_json(const Session& session, const std::vector<LongestScan>& longest) {
  Json all = Json::array();
  for (const LongestScan& one : longest) {
    all.push_back({{"at_ns", one.at}, {"end_ns", one.end}, {"text", one.text}});
    if (session.is_system()) all.back()["station"] = session.name_of(one.station);
  }
  return all;
}

std::string track_text(const Session& session, const NamedTrack& one) {
  std::uint64_t count = 0, errors = 0;
  for (const TrackSpan& span : one.track.spans()) {
    count += span.count;
    errors += span.errors;
  }
  return fmt::format("{}{:<11} {:<18} {}{}\n", session.said_of(one.station), word_of(one.kind), one.name, count,
                     errors ? fmt::format(", {} of them with an error", errors) : "");
}

/// A moment as `at` takes it, within the past: one that is beyond its end means its end.
Result<Time> moment_of(const Session& session, const std::string& word) {
  const Time newest = session.history.newest().time;
  const auto time = parse_duration(word);
  return time && *time > newest ? Result<Time>(newest) : parse_moment(word, session.history);
}

}  // namespace

Reply listing(Session& session, const Words& arguments) {
  const Program& program = session.program();
  if (arguments.empty()) {
    Json outline = outline_json(program, session.listing());
    std::string text = outline_text(outline);
    return {.text = std::move(text), .json = std::move(outline)};
  }
  const auto from = parse_decimal<std::uint32_t>(arguments[0]);
  const auto to = arguments.size() == 2 ? parse_decimal<std::uint32_t>(arguments[1]) : std::nullopt;
  if (!from || !to || *from < 1 || *to < *from || *to - *from >= kMostListed)
    return wrong(expects("listing", fmt::format("the first and the last line, at most {}: listing 1 100", kMostListed)));
  Reply reply{.json = {{"program", program.source.name}, {"text", lines_json(program, *from, *to)}}};
  for (const Json& line : reply.json["text"])
    reply.text +=
        fmt::format("{:>5}  {}\n", line["line"].get<std::uint32_t>(), stl::printable(line["text"].get<std::string>()));
  return reply;
}

Reply values(Session& session, const Words& arguments) {
  if (arguments.empty()) return wrong(expects("values", "addresses, for example: values VW100 /x VB4:8"));
  const PrintForm* form = find_print_form("/d");
  ValuesReply all{session};
  for (const std::string& word : arguments) {
    if (!word.starts_with('/')) {
      all.add(word, *form);
      continue;
    }
    form = find_print_form(word);
    if (!form) return wrong(expects("values", fmt::format("a form ({}) in front of addresses", print_forms_meanings())));
  }
  return std::move(all.reply);
}

Reply spans(Session& session, const Words& arguments) {
  constexpr std::string_view kExpected = "two moments, the first before the second, for example: spans -50ms end VW20";
  if (arguments.size() < 2) return wrong(expects("spans", kExpected));
  const auto from = moment_of(session, arguments[0]);
  const auto to = from ? moment_of(session, arguments[1]) : from;
  if (!to) return wrong(to.why());
  if (*from >= *to) return wrong(expects("spans", kExpected));
  TracksWanted wanted{.from = *from, .to = *to, .most = kUsualElements, .watched_at = session.focus()};
  for (std::size_t i = 2; i < arguments.size(); ++i) {
    const auto count = i == 2 && is_whole_number(arguments[i]) ? parse_decimal<std::size_t>(arguments[i]) : std::nullopt;
    if (i == 2 && is_whole_number(arguments[i]) && !(count && kElements.has(*count)))
      return wrong(expects("spans", fmt::format("from {} to {} elements of a track", kElements.least, kElements.most)));
    if (count) {
      wanted.most = *count;
      continue;
    }
    const auto range = parse_range(arguments[i], session.program());
    if (!range) return wrong(range.why());
    if (range->count != 1) return wrong(fmt::format("spans: {} is several values; name each", stl::shortened(arguments[i])));
    wanted.watched.push_back(*range);
  }
  const TracksOfPast past = tracks_of_past(session.history, wanted, session.setup.stop_request);
  Reply reply{.json = {{"from_ns", wanted.from}, {"to_ns", past.to}, {"interrupted", past.interrupted}},
              .interrupted = past.interrupted};
  if (!past.with_networks) reply.json["left_out"] = {word_of(TrackKind::Queues), word_of(TrackKind::Routines), word_of(TrackKind::Networks)};
  reply.json["tracks"] = Json::array();
  for (const NamedTrack& one : past.tracks) {
    reply.text += track_text(session, one);
    reply.json["tracks"].push_back(track_json(session, one));
  }
  reply.json["answers"] = longest_json(session, past.longest);
  reply.json["longest_scans"] = longest_json(session, past.longest_scans);
  return reply;
}

}  // namespace s7200::tools::commands
