// The differences of two runs as a tree: each below what led to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "interpreter/analysis/flow/flow.hpp"
#include "tools/session/causes/effects/effect.hpp"
#include "tools/session/causes/effects/run_differences.hpp"

namespace s7200::tools {

class EffectTree {
 public:
  /// `known` is the run with the change, `without` the one without it; all must live as long as this. `changed`: the memory
  /// that it was a change of, of an input its point and its image.
  EffectTree(const Program& program, const RunRecord& known, const RunRecord& without, const RunDifferences& differences,
             const std::vector<Bits>& changed);

  std::vector<Effect> effects() const { return children_of(kRoot); }
  std::vector<std::string> by_timing() const;

  /// The last turn in which the runs differ, if they are alike after it; what has no cause but the times of scans does not
  /// count. Nothing if they differ at the end.
  std::optional<Time> alike_from(Time change) const;

 private:
  static constexpr std::size_t kRoot = 0;

  /// What a node is about: memory by its place, and what only hands on by who wrote it too; an instruction; records by kind,
  /// port or event, and routine or code.
  using Subject = std::tuple<std::uint8_t, std::uint64_t, std::uint64_t>;

  struct Node {
    Effect effect{};
    Bits bits{0, 0};       ///< of memory
    bool settled = false;  ///< it is told what the memory has between scans
    std::optional<std::size_t> parent{};
    std::vector<SeriesKey> keys{};
    Time last = 0;
    std::vector<std::uint16_t> known{}, without{};  ///< characters that only that run has sent
  };

  const Happening& happening_of(const RunDifference& difference) const;
  static Subject subject_of(const RunDifference& difference, const Happening& happening);
  bool is_of_root(SeriesKey key) const;
  void add(const RunDifference& difference);
  void note_end(const RunDifference& difference);
  void settle(Node& node, const Happening& happening, const RunDifference& difference) const;
  std::optional<std::size_t> cause_of(const Happening& happening, const RunDifference& difference, std::size_t self);
  std::optional<std::size_t> looked_at(const Happening& happening, const RunDifference& difference, std::size_t self,
                                       Look& by) const;
  bool hands_on_to(const Node& node, const Look& look, std::uint64_t bit, const RunDifference& difference) const;
  std::optional<std::size_t> way_to(std::uint32_t op, Time at) const;
  std::optional<std::size_t> occasion_of(const Happening& happening) const;
  std::optional<std::size_t> record_node(TraceKind kind, std::uint8_t where) const;
  void describe(Node& node, const Happening& happening, const RunDifference& difference) const;
  void describe_memory(Node& node, const Happening& happening, const RunDifference& difference) const;
  void describe_way(Node& node, const Happening& happening, const RunDifference& difference) const;
  Point told_at(const RunRecord& run, const Happening& happening, const RunDifference& difference) const;
  std::vector<std::uint8_t> value_beside(const RunRecord& run, const Bits& place, Point point, Time at,
                                         const std::vector<std::uint8_t>& other) const;
  std::string place_of(std::uint32_t op) const;
  std::optional<MemoryRange> range_of(const Bits& bits) const;
  bool is_shown(const Node& node) const;
  bool differs_at_the_end(const Node& node) const;
  std::vector<Effect> children_of(std::size_t node) const;

  const Program& program_;
  const RunRecord &known_, &without_;
  const RunDifferences& differences_;
  ControlFlow flow_;
  std::vector<Node> nodes_{};
  std::map<Subject, std::size_t> node_of_{};
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> nodes_of_bit_{};
  std::unordered_map<SeriesKey, std::vector<std::size_t>> nodes_of_key_{};
};

}  // namespace s7200::tools
