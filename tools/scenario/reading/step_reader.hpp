// The steps of a scenario, with their loops run out.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scenario/reading/value_reader.hpp"
#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

inline constexpr int kDeepestLoop = 5;

/// Reads the steps of the scenarios of one file.
class StepReader {
 public:
  StepReader(ValueReader& values, std::size_t most_steps) : values_(values), most_steps_(most_steps) {}

  /// Those of a scenario, whose head has been read. There is at least one, unless what they need is not there.
  void read_all(const YamlNode& list, Scenario& scenario);

  void read_repeat(const YamlNode& node, const YamlNode& times, const Scenario& scenario, std::vector<Step>& steps);
  void read_for(const YamlNode& node, const YamlNode& variables, const Scenario& scenario, std::vector<Step>& steps);

 private:
  void read_steps(const YamlNode& list, const Scenario& scenario, std::vector<Step>& steps);
  void read_step(const YamlNode& node, const Scenario& scenario, std::vector<Step>& steps);
  const YamlNode* find_action(const YamlNode& node);
  void read_place(const YamlNode& node, const Scenario& scenario, bool needed, Step& step);
  void check_place(const YamlNode& node, const Scenario& scenario, const Step& step);
  bool too_much(const YamlNode& node);
  const YamlNode* loop_body(const YamlNode& node);
  template <class Body>
  void in_loop(const std::string& turn, Body body);
  void loop_over(const YamlNode& variables, std::size_t which, const YamlNode& body, const Scenario& scenario,
                 std::vector<Step>& steps);
  std::vector<std::string> loop_values(const YamlNode& node);

  ValueReader& values_;
  int depth_ = 0;
  std::size_t work_ = 0, most_steps_;
  bool left_out_ = false;  ///< a step of this scenario, for want of what it needs
};

/// A key whose `steps` are run out when they are read.
struct LoopKind {
  std::string_view key;
  void (StepReader::*read)(const YamlNode& node, const YamlNode& is, const Scenario& scenario, std::vector<Step>& steps);
  std::string_view form, meaning;
};
std::span<const LoopKind> loop_kinds();

}  // namespace s7200::tools
