#include "interpreter/stl/drawings/ladder_graph.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace s7200::stl {

namespace {

constexpr std::size_t kRail = 0;

const LadderElement& first_contact(const LadderPath& path) {
  return path.kind == LadderPath::Kind::Contact ? path.contact : first_contact(path.parts.front());
}

/// Joins two paths, one after the other or beside each other, in one list instead of nested ones.
LadderPath joined(LadderPath::Kind kind, LadderPath a, LadderPath b) {
  if (a.kind != kind) {
    LadderPath list{kind};
    list.parts.push_back(std::move(a));
    a = std::move(list);
  }
  if (b.kind == kind)
    std::move(b.parts.begin(), b.parts.end(), std::back_inserter(a.parts));
  else
    a.parts.push_back(std::move(b));
  return a;
}

/// Joins edges with the same ends in parallel and edges around a point without branches in series, until only a tree is
/// left.
class Reduction {
 public:
  Reduction(LadderGraph graph, const LadderComplaint& complain) : graph_(std::move(graph)), complain_(complain) {
    for (LadderGraph::Contact& contact : graph_.contacts)
      edges_.push_back({contact.from, contact.to, {LadderPath::Kind::Contact, std::move(contact.element)}});
    feeds_.resize(graph_.points);
    for (std::size_t i = 0; i < graph_.outputs.size(); ++i)
      for (const std::size_t point : graph_.outputs[i].inputs) feeds_[point] = true;
  }

  LadderBranch run() {
    if (graph_.outputs.empty() && edges_.empty()) return {};
    while (join_parallel() || join_series()) {
    }
    if (!is_tree()) return {};
    LadderBranch rail = branch_at(kRail);
    if (!complained_) find_unreached();
    return rail;
  }

 private:
  struct Edge {
    std::size_t from, to;
    LadderPath path;
    bool reached = false;  // from the power rail
  };

  void complain(const Position& at, std::string message, std::string hint) {
    complained_ = true;
    complain_(at, std::move(message), std::move(hint));
  }

  bool join_parallel() {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> first;
    std::vector<Edge> kept;
    for (Edge& edge : edges_) {
      const auto [known, added] = first.try_emplace({edge.from, edge.to}, kept.size());
      if (added)
        kept.push_back(std::move(edge));
      else
        kept[known->second].path =
            joined(LadderPath::Kind::Parallel, std::move(kept[known->second].path), std::move(edge.path));
    }
    const bool any = kept.size() < edges_.size();
    edges_ = std::move(kept);
    return any;
  }

  /// Joins all series at once: each point without branches is the end of one edge and the beginning of another.
  bool join_series() {
    constexpr std::size_t kNone = SIZE_MAX;
    std::vector<std::size_t> in(graph_.points), out(graph_.points), next(graph_.points, kNone);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      ++in[edges_[i].to];
      ++out[edges_[i].from];
      next[edges_[i].from] = i;
    }
    const auto inner = [&](std::size_t point) {
      return point != kRail && !feeds_[point] && in[point] == 1 && out[point] == 1;
    };
    std::vector<bool> gone(edges_.size());
    bool any = false;
    for (Edge& edge : edges_) {
      if (inner(edge.from)) continue;  // the edge before takes it
      while (inner(edge.to)) {
        Edge& after = edges_[next[edge.to]];
        gone[next[edge.to]] = any = true;
        edge.path = joined(LadderPath::Kind::Series, std::move(edge.path), std::move(after.path));
        edge.to = after.to;
      }
    }
    std::size_t index = 0;
    std::erase_if(edges_, [&](const Edge&) { return gone[index++]; });
    return any;
  }

  bool is_tree() {
    std::vector<std::size_t> in(graph_.points), out(graph_.points);
    for (const Edge& edge : edges_) {
      ++in[edge.to];
      ++out[edge.from];
    }
    for (const LadderGraph::Output& output : graph_.outputs)
      if (output.eno) ++in[*output.eno];
    for (const Edge& edge : edges_) {
      const Position& at = first_contact(edge.path).position;
      if (edge.from == edge.to)
        complain(at, "both sides of this contact are joined by a wire",
                 "a contact stands between two points of the network");
      else if (edge.to == kRail)
        complain(at, "this contact leads back to the power rail", "power flows from left to right, to a coil or a box");
      else if (in[edge.to] > 1)
        complain(at, "this branch joins others that begin at another point",
                 "expected contacts in series and in parallel: a branch ends on the branch that it leaves");
      else if (out[edge.to] == 0 && !feeds_[edge.to])
        complain(at, "this contact leads to no coil and no box", "expected a wire from its right side to one");
    }
    return !complained_;
  }

  /// The branch that hangs from a point, from top to bottom.
  LadderBranch branch_at(std::size_t point) {
    struct Hanging {
      Position position;
      LadderBranch branch;
    };
    std::vector<Hanging> hanging;
    for (Edge& edge : edges_) {
      if (edge.from != point) continue;
      edge.reached = true;
      const Position at = first_contact(edge.path).position;
      LadderBranch branch = branch_at(edge.to);
      branch.path = edge.path;
      if (!branch.branches.empty()) hanging.push_back({at, std::move(branch)});
    }
    for (LadderGraph::Output& output : graph_.outputs) {
      if (output.inputs.front() != point) continue;
      hanging.push_back({output.element.position, output_branch(output)});
    }
    std::stable_sort(hanging.begin(), hanging.end(), [](const Hanging& a, const Hanging& b) {
      return std::pair(a.position.line, a.position.column) < std::pair(b.position.line, b.position.column);
    });
    LadderBranch all;
    for (Hanging& each : hanging) all.branches.push_back(std::move(each.branch));
    return all;
  }

  LadderBranch output_branch(const LadderGraph::Output& output) {
    LadderBranch branch;
    branch.output = output.element;
    if (output.eno) branch.branches = branch_at(*output.eno).branches;
    for (std::size_t i = 1; i < output.inputs.size(); ++i) branch.more_inputs.push_back(way_from_rail(output, i));
    return branch;
  }

  /// The logic stack holds the inputs of a counter one above the other; each begins with an LD.
  LadderPath way_from_rail(const LadderGraph::Output& output, std::size_t input) {
    const std::size_t point = output.inputs[input];
    if (point == kRail) return {};
    const auto edge = std::find_if(edges_.begin(), edges_.end(), [&](const Edge& e) { return e.to == point; });
    if (edge != edges_.end() && edge->from == kRail) return edge->path;
    complain(output.element.position, "an input of this box is not wired to the power rail",
             "expected contacts between the rail and each input that takes power flow");
    return {};
  }

  void find_unreached() {
    constexpr const char* kHint = "expected a wire or contacts from the rail to its left side";
    for (const Edge& edge : edges_)
      if (!edge.reached)
        complain(first_contact(edge.path).position, "no wire leads from the power rail to this contact", kHint);
    for (const LadderGraph::Output& output : graph_.outputs) {
      const std::size_t point = output.inputs.front();
      const bool fed =
          std::ranges::any_of(edges_, [&](const Edge& edge) { return edge.to == point; }) ||
          std::ranges::any_of(graph_.outputs, [&](const LadderGraph::Output& other) { return other.eno == point; });
      if (point != kRail && !fed)
        complain(output.element.position, "no wire leads from the power rail to this output", kHint);
    }
  }

  LadderGraph graph_;
  const LadderComplaint& complain_;
  std::vector<Edge> edges_;
  std::vector<bool> feeds_;  // by point: whether an output hangs from it
  bool complained_ = false;
};

}  // namespace

LadderBranch branches_of(LadderGraph graph, const LadderComplaint& complain) {
  return Reduction(std::move(graph), complain).run();
}

}  // namespace s7200::stl
