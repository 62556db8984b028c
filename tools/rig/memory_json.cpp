#include "tools/rig/memory_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/program/operands/address.hpp"
#include "tools/json/json_taker.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFormat = "s7200 memory 1";
constexpr std::uint32_t kRow = 32;  // bytes

/// A part of memory that is kept: which addresses, and where its bytes are.
struct Kept {
  RetentiveRange range;
  std::uint8_t* bytes;
};

/// The ranges that a system block can make retentive; a range that it does not is 0 in the memory.
std::vector<Kept> kept_in_ram(RetentiveMemory& memory, const CpuModel& model) {
  std::vector<Kept> kept;
  for (const RetentiveRange& range : retainable(model)) kept.push_back({range, memory.image.data() + range.at()});
  return kept;
}

std::vector<Kept> kept_in_eeprom(RetentiveMemory& memory, const CpuModel& model) {
  return {{{Area::V, 0, model.eeprom_bytes}, memory.eeprom.data()}};
}

constexpr std::pair<const char*, std::uint8_t ClockTime::*> kClockFields[] = {
    {"year", &ClockTime::year},      {"month", &ClockTime::month},   {"day", &ClockTime::day},
    {"hour", &ClockTime::hour},      {"minute", &ClockTime::minute}, {"second", &ClockTime::second},
    {"weekday", &ClockTime::weekday}};
constexpr const char* kClockFraction = "nanosecond";
constexpr Time kLongestClockFraction = 2 * kSecond;  // of a second that a slow clock counts

std::string name_of(const RetentiveRange& range, std::uint32_t byte) {
  const bool numbered = info(range.area).element != 0;
  const Width width = numbered ? Width::Word : Width::Byte;
  return MemoryRange{.area = range.area, .width = width, .number = range.first + byte / info(range.area).step()}.name_of(0);
}

Json rows_of(const std::vector<Kept>& kept) {
  Json rows = Json::object();
  for (const auto& [range, bytes] : kept)
    for (std::uint32_t from = 0; from < range.bytes(); from += kRow) {
      const std::span<const std::uint8_t> row(bytes + from, std::min(kRow, range.bytes() - from));
      if (std::any_of(row.begin(), row.end(), [](std::uint8_t byte) { return byte != 0; }))
        rows[name_of(range, from)] = plain_hex(row);
    }
  return rows;
}

/// Takes one row over; what is wrong with it, or nothing.
std::string take_row(const std::string& address, const std::string& hex, const std::vector<Kept>& kept,
                     const CpuModel& model) {
  const auto place = parse_range(address, model);
  if (!place) return place.why();
  if (place->width == Width::Bit || place->count != 1 || hex.size() % 2 != 0)
    return fmt::format("'{}' has no whole bytes", stl::shortened(address));
  const std::uint64_t count = hex.size() / 2;
  const auto part = std::find_if(kept.begin(), kept.end(), [&](const Kept& k) {
    return k.range.area == place->area && place->at >= k.range.at() && place->at + count <= k.range.at() + k.range.bytes();
  });
  if (part == kept.end()) return fmt::format("the {} bytes from '{}' on are not kept by CPU {}", count, address, model.name);
  std::uint8_t* to = part->bytes + (place->at - part->range.at());
  for (std::size_t i = 0; i < count; ++i) {
    const auto high = hex_digit(hex[2 * i]), low = hex_digit(hex[2 * i + 1]);
    if (!high || !low) return fmt::format("'{}' holds something else than hex", stl::shortened(address));
    to[i] = static_cast<std::uint8_t>(*high << 4 | *low);
  }
  return {};
}

std::string take_rows(JsonTaker& taker, const Json& rows, const std::vector<Kept>& kept, const CpuModel& model) {
  for (const auto& [address, hex] : rows.items()) {
    const std::string bytes = taker.text(hex);
    if (std::string why = taker.fine() ? take_row(address, bytes, kept, model) : ""; !why.empty()) return why;
  }
  return {};
}

/// Takes a clock as TODW does: TODW does not check dates, and what a program has set comes back.
void take_clock(JsonTaker& taker, const Json& json, RetentiveMemory& memory) {
  for (const auto& [name, field] : kClockFields) memory.clock.*field = taker.number_at<std::uint8_t>(json, name, {0, 99});
  memory.clock_fraction = taker.number_at<Time>(json, kClockFraction, {0, kLongestClockFraction}, 0);
}

/// Takes forced values: `{"I0.0": 1, "VW10": 5}`
std::string take_forced(const Json& values, const CpuModel& model, Forcing& forcing) {
  for (const auto& [address, value] : values.items()) {
    const auto place = parse_range(address, model);
    if (!place) return place.why();
    if (place->count != 1 || !forcing::possible(*place))
      return fmt::format("'{}' cannot be forced", stl::shortened(address));
    const auto forced = parse_value(*place, shown(value));
    if (!forced) return fmt::format("'{}' cannot be forced to {}", stl::shortened(address), shown(value));
    if (!forcing::add(forcing, *place, forced->value))
      return fmt::format("'{}' cannot be forced: there is room for {} values of memory", stl::shortened(address),
                         forcing.memory.size());
  }
  return {};
}

/// Takes the memory. Returns what is wrong with what it says; what is wrong with the JSON, `taker` says.
std::string take(JsonTaker& taker, const Json& json, const CpuModel& model, RetentiveMemory& memory) {
  if (!JsonTaker::has(json, "format") || json["format"] != kFormat)
    return fmt::format("it is not the memory of a CPU (no \"format\": \"{}\")", kFormat);
  if (const std::string cpu = taker.text_at(json, "cpu"); taker.fine() && cpu != model.name)
    return fmt::format("it is the memory of a CPU {}, not of a CPU {}", stl::shortened(cpu), model.name);
  const Json& clock = taker.map_at(json, "clock");
  taker.of("clock", clock, [&](const Json& one) { return take_clock(taker, one, memory), true; });
  for (const auto& [key, kept] :
       {std::pair("ram", kept_in_ram(memory, model)), std::pair("eeprom", kept_in_eeprom(memory, model))})
    if (std::string why = take_rows(taker, taker.map_at(json, key), kept, model); !why.empty()) return why;
  return JsonTaker::has(json, "forced") ? take_forced(taker.map_at(json, "forced"), model, memory.forcing) : "";
}

}  // namespace

std::string memory_beginning() { return fmt::format("{{\n  \"format\": \"{}\"", kFormat); }

std::string memory_to_json(const RetentiveMemory& memory, const CpuModel& model) {
  RetentiveMemory copy = memory;
  Json json{{"format", kFormat}, {"cpu", model.name}};
  for (const auto& [name, field] : kClockFields) json["clock"][name] = memory.clock.*field;
  json["clock"][kClockFraction] = memory.clock_fraction;
  json["ram"] = rows_of(kept_in_ram(copy, model));
  json["eeprom"] = rows_of(kept_in_eeprom(copy, model));
  for (const Assignment& forced : forcing::listed(memory.forcing)) json["forced"][forced.place.name_of(0)] = forced.value;
  return json.dump(2) + "\n";
}

Result<RetentiveMemory> memory_from_json(std::string_view text, const CpuModel& model) {
  RetentiveMemory memory;
  const auto json = parse_json(text);
  if (!json || !json->is_object())
    return trouble("it is not the memory of a CPU (no JSON object{})", json ? "" : ": it is " + json.why());
  JsonTaker taker;
  std::string why = take(taker, *json, model, memory);
  if (!taker.fine()) return trouble("it is damaged: {}", taker.why());
  if (!why.empty()) return Trouble{std::move(why)};
  return memory;
}

void add_kept_memory(Json& json, const RetentiveMemory& memory, const CpuModel& model) {
  json["memory"] = Json::parse(memory_to_json(memory, model));
  json["memory_lost"] = memory.ram_lost;
  json["power_off"] = memory.power_off;
}

std::optional<RetentiveMemory> take_kept_memory(JsonTaker& taker, const Json& json, const CpuModel& model) {
  if (!JsonTaker::has(json, "memory")) return {};
  auto memory = memory_from_json(in_one_line(taker.member(json, "memory")), model);
  if (!memory) return taker.fail(memory.why()), std::nullopt;
  memory->ram_lost = taker.truth_at(json, "memory_lost");
  memory->power_off = taker.number_at<Time>(json, "power_off", {0, kLongestDuration});
  return *std::move(memory);
}

}  // namespace s7200::tools
