#include "tools/trials/trial_text.hpp"

#include <fmt/format.h>

#include <array>

#include "interpreter/model/area.hpp"
#include "tools/trials/trial_scenario.hpp"

namespace s7200::tools {
namespace {

/// What each stimulus does, in words.
std::vector<std::string> words(const Trial& trial) {
  std::array<std::uint8_t, image::kPointBytes> inputs{};
  std::vector<std::string> all;
  for (const Stimulus& stimulus : trial) {
    std::string text;
    if (stimulus.what == Stimulus::What::Power) {
      text = "power fails and comes back";
    } else if (stimulus.what == Stimulus::What::Break) {
      text = fmt::format("holds the line at space for {}, a break", format_duration(kBreak));
    } else if (stimulus.what == Stimulus::What::Frame) {
      text = "sends " + frame_text(stimulus);
      if (stimulus.gap != 0) text += fmt::format(", {} between characters", format_duration(stimulus.gap));
      if (stimulus.bad_stop) text += fmt::format(", character {} with a wrong stop bit", stimulus.damaged);
    } else if (stimulus.what == Stimulus::What::Input) {
      const std::uint8_t value = stimulus.bytes.front();
      for (unsigned bit = 0; bit < 8; ++bit)
        if ((inputs[stimulus.place] ^ value) >> bit & 1)
          text += fmt::format("{}I{}.{} = {}", text.empty() ? "" : ", ", stimulus.place, bit, value >> bit & 1);
      inputs[stimulus.place] = value;
    } else {
      std::uint32_t value = 0;
      for (const std::uint8_t byte : stimulus.bytes) value = value << 8 | byte;
      text = fmt::format("{} = {}", place_text(stimulus.place, stimulus.bytes.size()), value);
    }
    if (stimulus.other_port) text += ", at the other port";
    all.push_back(text.empty() ? "nothing more: time passes" : text);
  }
  return all;
}

constexpr std::size_t kManyPairs = 4;

/// How often stimulus `first` and the next one come again, one after the other: the pulses that a counter counts.
std::size_t further_pairs(const std::vector<std::string>& does, std::size_t first) {
  std::size_t end = first + 2;
  while (end < does.size() && does[end] == does[end - 2]) ++end;
  return end > does.size() ? 0 : (end - first) / 2 - 1;
}

}  // namespace

std::string trial_text(const Trial& trial, const std::vector<Time>& begun) {
  const auto does = words(trial);
  std::string text;
  const auto add = [&](std::size_t i) { text += fmt::format("    {:>10}  {}\n", format_duration(begun[i], 3), does[i]); };
  for (std::size_t i = 0; i < trial.size();) {
    const std::size_t pairs = further_pairs(does, i);
    add(i++);
    if (pairs < kManyPairs) continue;
    add(i);
    i += 1 + 2 * pairs;
    text += fmt::format("    {:>10}  both {} times more, until {}\n", "…", pairs, format_duration(begun[i - 1], 3));
  }
  return text;
}

nlohmann::ordered_json trial_json(const Trial& trial, const std::vector<Time>& begun) {
  const auto does = words(trial);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < trial.size(); ++i) json.push_back({{"at_ns", begun[i]}, {"does", does[i]}});
  return json;
}

}  // namespace s7200::tools
