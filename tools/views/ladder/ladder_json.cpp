#include "tools/views/ladder/ladder_json.hpp"

#include <algorithm>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;
using stl::LadderBranch;
using stl::LadderElement;
using stl::LadderPath;

std::string_view kind_name(LadderElement::Kind kind) {
  return kind == LadderElement::Kind::Contact ? "contact" : kind == LadderElement::Kind::Coil ? "coil" : "box";
}

Json pin_json(const GridPin& pin) {
  return {{"name", pin.name.text},
          {"operand", pin.operand.text},
          {"row", pin.name.row},
          {"name_column", pin.name.column},
          {"operand_column", pin.operand.column},
          {"right", pin.right},
          {"power", pin.power}};
}

Json element_json(const GridShape& shape) {
  Json json{{"kind", kind_name(shape.kind)},
            {"symbol", shape.symbol},
            {"op", shape.op ? Json(*shape.op) : Json()},
            {"line", shape.line},
            {"column", shape.column},
            {"row", shape.row},
            {"width", shape.width},
            {"height", shape.height},
            {"from", shape.from},
            {"to", shape.to == 0 ? Json() : Json(shape.to)}};
  Json operands = Json::array(), pins = Json::array();
  for (const GridText& operand : shape.operands)
    operands.push_back({{"text", operand.text}, {"column", operand.column}, {"row", operand.row}});
  for (const GridPin& pin : shape.pins) pins.push_back(pin_json(pin));
  json["operands"] = std::move(operands);
  json["pins"] = std::move(pins);
  return json;
}

/// The tree as lists of lists, whose leaves are the numbers of the elements in the grid.
class Tree {
 public:
  explicit Tree(const LadderGrid& grid) : grid_(grid) {}

  Json branches(const std::vector<LadderBranch>& list) const {
    Json json = Json::array();
    for (const LadderBranch& branch : list) {
      Json inputs = Json::array();
      for (const LadderPath& input : branch.more_inputs) inputs.push_back(path(input));
      json.push_back(Json::array({path(branch.path), branch.output ? number_of(*branch.output) : Json(), std::move(inputs),
                                  branches(branch.branches)}));
    }
    return json;
  }

 private:
  Json path(const LadderPath& path_) const {
    if (path_.kind == LadderPath::Kind::Contact) return number_of(path_.contact);
    Json json = Json::array({path_.kind == LadderPath::Kind::Series ? "series" : "parallel"});
    for (const LadderPath& part : path_.parts) json.push_back(path(part));
    return json;
  }
  Json number_of(const LadderElement& element) const {
    return std::ranges::find(grid_.shapes, element.op, &GridShape::op) - grid_.shapes.begin();
  }

  const LadderGrid& grid_;
};

Json grid_json(const LadderGrid& grid) {
  Json wires = Json::array(), connectors = Json::array();
  for (const GridWire& wire : grid.wires)
    wires.push_back({{"column", wire.column},
                     {"row", wire.row},
                     {"to_column", wire.to_column},
                     {"to_row", wire.to_row},
                     {"point", wire.point}});
  for (const GridConnector& connector : grid.connectors)
    connectors.push_back({{"text", connector.name.text},
                          {"column", connector.name.column},
                          {"row", connector.name.row},
                          {"begins", connector.begins},
                          {"point", connector.point}});
  return {{"columns", grid.columns}, {"rows", grid.rows},         {"first_rung", grid.first_rung},
          {"points", grid.points},   {"wires", std::move(wires)}, {"connectors", std::move(connectors)}};
}

}  // namespace

nlohmann::ordered_json network_json(const DrawnNetwork& network, const stl::Source& program, const LadderFlow* flow) {
  Json json{{"routine", network.routine},        {"network", network.ladder.number},
            {"title", stl::trim(network.title)}, {"line", network.ladder.position.line},
            {"first_op", network.first},         {"ops", network.end - network.first}};
  Json comments = Json::array(), notes = Json::array();
  for (const std::string& comment : network.ladder.comments) comments.push_back(stl::trim(comment));
  for (const LadderNote& note : notes_on(network, program))
    notes.push_back({{"text", note.text}, {"symbol", note.symbol}, {"comment", stl::trim(note.comment)}});
  json["comments"] = std::move(comments);
  json["notes"] = std::move(notes);
  const auto& head = network.ladder.head;
  json["head"] = head ? Json(head->symbol + (head->operands.empty() ? "" : " " + head->operands.front().text)) : Json();
  json["why_not"] = network.why_not.empty() ? Json() : Json(network.why_not);
  json["other_stl"] = network.other_stl;
  if (head || !network.why_not.empty()) return json;
  const LadderGrid grid = grid_of(network);
  Json elements = Json::array();
  for (std::size_t i = 0; i < grid.shapes.size(); ++i) {
    elements.push_back(element_json(grid.shapes[i]));
    if (flow) elements.back()["value"] = flow->values[i];
  }
  json["elements"] = std::move(elements);
  json["tree"] = Tree(grid).branches(network.ladder.rail.branches);
  json["grid"] = grid_json(grid);
  if (flow) json["power"] = flow->points;
  return json;
}

}  // namespace s7200::tools
