// interrupts: how often something happened since the last request began, or since power-up when there was none.
#include "interpreter/base/text/text.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {
namespace {

struct InterruptCount {
  enum class What : std::uint8_t { Routine, Event, Lost };
  What what{};
  std::uint8_t number = 0;  ///< of the routine or event; lost events are counted all together
  Count count{};

  std::string name() const {
    if (what == What::Lost) return "lost events";
    return fmt::format("{} {}", what == What::Routine ? "INT" : "event", number);
  }

  std::uint64_t found(const InterruptCounter& counter) const {
    if (what == What::Lost) return counter.lost();
    return what == What::Routine ? counter.of_routine(number) : counter.of_event(number);
  }
};

struct InterruptsStep final : StepAction {
  std::vector<InterruptCount> counts{};

  Needs needs() const override { return Needs::ToLook; }

  void act(Run& run) const override {
    run.count_check();
    for (const InterruptCount& asked : counts) {
      const std::uint64_t found = asked.found(run.plant()->interrupts());
      if (!asked.count.has(found))
        run.add({.what = asked.name(), .expected = in_words(asked.count), .found = std::to_string(found)});
    }
  }
};

/// The number after a word, if it is below `limit`.
std::optional<std::uint8_t> number_after(std::string_view prefix, const std::string& text, std::int64_t limit) {
  const auto parsed = text.starts_with(prefix) ? parse_number(text.substr(prefix.size())) : std::nullopt;
  if (!parsed || *parsed < 0 || *parsed >= limit) return {};
  return static_cast<std::uint8_t>(*parsed);
}

/// `INT 123`, `event 10`, `lost`
std::optional<InterruptCount> parse_what(const std::string& text) {
  using What = InterruptCount::What;
  if (text == "lost") return InterruptCount{.what = What::Lost};
  if (const auto routine = number_after("int ", text, 128)) return InterruptCount{What::Routine, *routine};
  if (const auto event = number_after("event ", text, kEvents)) return InterruptCount{What::Event, *event};
  return {};
}

}  // namespace

std::shared_ptr<const StepAction> read_interrupts(const StepSource& source) {
  auto step = std::make_shared<InterruptsStep>();
  ValueReader& values = source.values;
  const YamlNode& map = source.is;
  if (!map.is_map() || map.keys.empty())
    values.wrong(map, "counts are a map, not " + (map.is_map() ? "an empty one" : to_text(map)),
                 "write for example {INT 123: 7, event 10: 1, lost: 0}");
  for (std::size_t i = 0; i < map.keys.size() && i < map.items.size(); ++i) {
    const auto name = values.text(map.keys[i]);
    if (!name) continue;
    const Count count = values.count(map.items[i]);
    if (auto one = parse_what(stl::lower_case(*name))) {
      one->count = count;
      step->counts.push_back(*one);
    } else {
      values.wrong(map.keys[i], fmt::format("'{}' cannot be counted", stl::shortened(*name)),
                   "write INT 0 to INT 127, event 0 to event 33, or lost");
    }
  }
  return step;
}

}  // namespace s7200::tools
