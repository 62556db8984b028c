#include "tools/session/commands/answers/action_json.hpp"

#include <fmt/format.h>

#include <string>
#include <variant>
#include <vector>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "serial_sim/line/frame.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr Between<Time> kAnyInstant{0, kNever}, kAnyLength{0, kLongestDuration};

Json serial_format_json(const SerialFormat& format) {
  return {format.baud, format.data_bits, word_of(format.parity), format.stop_bits};
}

SerialFormat take_format(JsonTaker& taker, const Json& json) {
  SerialFormat format{.baud = taker.number<std::uint32_t>(taker.element(json, 0)),
                      .data_bits = taker.number<std::uint8_t>(taker.element(json, 1)),
                      .stop_bits = taker.number<std::uint8_t>(taker.element(json, 3))};
  const std::string word = taker.text(taker.element(json, 2));
  for (std::size_t parity = 0; parity < kParityWords.size(); ++parity)
    if (kParityWords[parity] == word) format.parity = static_cast<Parity>(parity);
  if (format.baud == 0 || format.data_bits < 7 || format.data_bits > 8 || format.stop_bits < 1 || format.stop_bits > 2)
    taker.fail("a format of characters that there is not");
  return format;
}

/// In their order: a place may stand there again, or lie in another one.
Json assignments_json(const std::vector<Assignment>& assignments) {
  Json all = Json::array();
  for (const Assignment& assignment : assignments) all.push_back({assignment.place.name_of(0), assignment.value});
  return all;
}

struct ToJson {
  Json operator()(const SetMemory& set) const { return {{"set", assignments_json(set.assignments)}}; }
  Json operator()(const Force& force) const { return {{"force", assignments_json(force.assignments)}}; }
  Json operator()(const Unforce& unforce) const {
    Json places = Json::array();
    for (const MemoryRange& place : unforce.places)
      places.push_back(place.name_of(0) + (place.count > 1 ? fmt::format(":{}", place.count) : ""));
    return {{"unforce", places}};
  }
  Json operator()(const Jump& jump) const { return {{"goto", jump.to}}; }
  Json operator()(const InjectFault& inject) const {
    Json json{{"fault", inject.fault ? serial::to_text(*inject.fault) : "none"}};
    if (!inject.of.empty()) json["of"] = inject.of;
    return json;
  }
  Json operator()(const SetStack& set) const { return {{"stack", set.stack.bits()}}; }
  Json operator()(const SendFrame& send) const {
    Json json{{"send", serial::to_hex(send.request.frame)},
              {"format", serial_format_json(send.format)},
              {"timeout", send.request.timeout},
              {"gap", send.request.gap},
              {"sync", send.request.sync}};
    if (send.request.silence) json["silence"] = *send.request.silence;
    return json;
  }
  Json operator()(const CancelRequest& cancel) const {
    return {{"cancel",
             {{"sent", cancel.sent},
              {"waited", cancel.waited},
              {"sent_until", cancel.sent_until},
              {"answering", cancel.answering}}}};
  }
  /// Nothing of it can be done again: `save` refuses a session that has one.
  Json operator()(const SystemEvent& event) const { return {{"event", event.words}}; }
  Json operator()(const SetPower& power) const { return {{"power", power.on ? "on" : "off"}}; }
  Json operator()(const SetMode& set) const { return {{"mode", set.mode == Mode::Run ? "run" : "stop"}}; }
  Json operator()(const serial::HostCall& call) const {
    Json characters = Json::array();
    for (const serial::HostCharacter& c : call.characters)
      characters.push_back({c.byte, static_cast<int>(c.fault), c.sender, serial_format_json(c.format)});
    return {{"host", static_cast<int>(call.what)},
            {"format", serial_format_json(call.format)},
            {"characters", characters},
            {"sender", call.sender},
            {"lasts", call.lasts}};
  }
};

MemoryRange take_place(JsonTaker& taker, const std::string& text, const CpuModel& model) {
  const auto place = parse_range(text, model);
  if (place) return *place;
  taker.fail(place.why());
  return {};
}

std::vector<Assignment> take_assignments(JsonTaker& taker, const Json& list, const CpuModel& model) {
  std::vector<Assignment> all;
  for (const Json& assignment : list)
    all.push_back({take_place(taker, taker.text(taker.element(assignment, 0)), model),
                   taker.number<std::uint32_t>(taker.element(assignment, 1))});
  return all;
}

SendFrame take_send(JsonTaker& taker, const Json& json) {
  serial::ParsedFrame parsed = serial::parse_hex_frame(taker.text_at(json, "send"));
  if (!parsed.ok()) taker.fail(parsed.errors[0].message);
  SendFrame send{.format = take_format(taker, taker.list_at(json, "format")),
                 .request = {.frame = std::move(parsed.frame),
                             .timeout = taker.number_at<Time>(json, "timeout", kAnyLength),
                             .gap = taker.number_at<Time>(json, "gap", kAnyLength),
                             .silence = {},
                             .sync = taker.truth_at(json, "sync")}};
  if (JsonTaker::has(json, "silence")) send.request.silence = taker.number_at<Time>(json, "silence", kAnyLength);
  return send;
}

serial::HostCall take_call(JsonTaker& taker, const Json& json) {
  using Call = serial::HostCall;
  using Fault = serial::HostCharacter::Fault;
  const int what = taker.number_at<int>(json, "host", {0, static_cast<int>(Call::What::EndBreak)});
  Call call{.what = static_cast<Call::What>(what),
            .format = take_format(taker, taker.list_at(json, "format")),
            .characters = {},
            .sender = taker.number_at<std::uint64_t>(json, "sender"),
            .lasts = taker.number_at<Time>(json, "lasts", kAnyLength, 0)};
  for (const Json& c : taker.list_at(json, "characters")) {
    const int fault = taker.number<int>(taker.element(c, 1), {0, static_cast<int>(Fault::Break)});
    call.characters.push_back({taker.number<std::uint8_t>(taker.element(c, 0)), take_format(taker, taker.element(c, 3)),
                               static_cast<Fault>(fault), taker.number<std::uint64_t>(taker.element(c, 2))});
  }
  return call;
}

InjectFault take_fault(JsonTaker& taker, const Json& json) {
  const std::string text = taker.text_at(json, "fault");
  if (text == "none") return {};
  const serial::ParsedFault parsed = serial::parse_fault(text);
  if (!parsed.ok()) taker.fail(parsed.error->message);
  return {parsed.fault, taker.text_at(json, "of", "")};
}

CancelRequest take_cancel(JsonTaker& taker, const Json& json) {
  return {.sent = taker.number_at<std::size_t>(json, "sent"),
          .waited = taker.number_at<Time>(json, "waited", kAnyInstant),
          .sent_until = taker.number_at<Time>(json, "sent_until", kAnyInstant),
          .answering = taker.truth_at(json, "answering")};
}

Force take_force(JsonTaker& taker, const Json& json, const CpuModel& model) {
  Force force{take_assignments(taker, taker.list_at(json, "force"), model)};
  for (const Assignment& assignment : force.assignments)
    if (!forcing::possible(assignment.place)) taker.fail("something that cannot be forced");
  return force;
}

Unforce take_unforce(JsonTaker& taker, const Json& json, const CpuModel& model) {
  Unforce unforce;
  for (const Json& place : taker.list_at(json, "unforce"))
    unforce.places.push_back(take_place(taker, taker.text(place), model));
  return unforce;
}

/// Whether a text is the first of two words; it has to be one of them.
bool take_first_of(JsonTaker& taker, const std::string& text, const char* first, const char* second, const char* what) {
  if (text != first && text != second) taker.fail(fmt::format("an unknown {}", what));
  return text == first;
}

}  // namespace

Json json_of(const Action& action) { return std::visit(ToJson{}, action); }

Action take_action(JsonTaker& taker, const Json& json, const CpuModel& model) {
  const auto has = [&json](const char* key) { return JsonTaker::has(json, key); };
  if (has("set")) return SetMemory{take_assignments(taker, taker.list_at(json, "set"), model)};
  if (has("send")) return take_send(taker, json);
  if (has("cancel")) return take_cancel(taker, taker.map_at(json, "cancel"));
  if (has("power")) return SetPower{take_first_of(taker, taker.text_at(json, "power"), "on", "off", "state of power")};
  if (has("host")) return take_call(taker, json);
  if (has("goto")) return Jump{taker.number_at<std::uint32_t>(json, "goto")};
  if (has("fault")) return take_fault(taker, json);
  if (has("mode"))
    return SetMode{take_first_of(taker, taker.text_at(json, "mode"), "run", "stop", "mode") ? Mode::Run : Mode::Stop};
  if (has("stack")) return SetStack{LogicStack::from_bits(taker.number_at<std::uint64_t>(json, "stack") & LogicStack::kAll)};
  if (has("force")) return take_force(taker, json, model);
  if (has("unforce")) return take_unforce(taker, json, model);
  taker.fail("an unknown action");
  return SetMemory{};
}

}  // namespace s7200::tools
