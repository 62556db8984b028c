#include "interpreter/program/ladder/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/program/ladder/ladder_boxes.hpp"
#include "interpreter/program/operands/operand_memory.hpp"
#include "interpreter/stl/blocks.hpp"
#include "interpreter/stl/parser.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/text/encoding.hpp"

namespace s7200 {
namespace {

using Form = LadderBox::Form;
using stl::LadderBranch;
using stl::LadderElement;
using stl::LadderNetwork;
using stl::LadderPath;
using stl::LadderPin;
using stl::LadderText;

// ---- Operands ------------------------------------------------------------------------------------------------------------

void collect(const LadderElement& element, std::set<std::string>& texts) {
  for (const LadderText& operand : element.operands) texts.insert(operand.text);
  for (const LadderPin& pin : element.pins) texts.insert(pin.operand.text);
}

void collect(const LadderPath& path, std::set<std::string>& texts) {
  if (path.kind == LadderPath::Kind::Contact) collect(path.contact, texts);
  for (const LadderPath& part : path.parts) collect(part, texts);
}

void collect(const LadderBranch& branch, std::set<std::string>& texts) {
  collect(branch.path, texts);
  if (branch.output) collect(*branch.output, texts);
  for (const LadderPath& input : branch.more_inputs) collect(input, texts);
  for (const LadderBranch& each : branch.branches) collect(each, texts);
}

/// The operands of a page by their texts, all read at once. What is not an operand is not in it.
std::map<std::string, stl::OperandValue> operands_of(const stl::LadderPage& page) {
  std::set<std::string> texts;
  for (const LadderNetwork& network : page.networks) {
    if (network.head) collect(*network.head, texts);
    collect(network.rail, texts);
  }
  const std::vector<std::string> in_order(texts.begin(), texts.end());
  std::string listing;
  for (const std::string& text : in_order)
    listing += fmt::format("LD {}\n", text.find('/') == std::string::npos ? text : "");
  const stl::ParseResult parsed = stl::parse(listing, {});
  std::set<std::uint32_t> wrong;
  for (const stl::Diagnostic& diagnostic : parsed.diagnostics) wrong.insert(diagnostic.position.line);
  std::map<std::string, stl::OperandValue> operands;
  for (const stl::Line& line : parsed.source.lines) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (statement == nullptr || statement->operands.size() != 1 || wrong.contains(statement->position.line)) continue;
    operands.emplace(in_order[statement->position.line - 1], statement->operands.front().value);
  }
  return operands;
}

// ---- One network ---------------------------------------------------------------------------------------------------------

bool is_wire(const LadderPath& path) { return path.kind == LadderPath::Kind::Series && path.parts.empty(); }

/// NOT and the edges work on the power flow that reaches them, not on a bit.
bool works_on_power_flow(const LadderPath& path) {
  const std::string& symbol = path.contact.symbol;
  return path.kind == LadderPath::Kind::Contact && (symbol == "NOT" || symbol == "P" || symbol == "N");
}

/// `NOT` after `LD`, `A` or `O` for the contact; empty for a contact that does not exist.
std::string contact_mnemonic(std::string_view load, std::string symbol) {
  std::erase(symbol, ' ');
  if (symbol.empty()) return std::string(load);
  if (symbol == "/" || symbol == "I") return fmt::format("{}{}", load, symbol == "I" ? "I" : "N");
  if (symbol == "/I") return fmt::format("{}NI", load);
  const std::size_t relation = symbol.find_first_of("<>=");
  const std::size_t end = symbol.find_last_of("<>=");
  if (relation == std::string::npos) return {};
  const std::string type = symbol.substr(0, relation) + symbol.substr(end + 1);
  std::string sign = symbol.substr(relation, end + 1 - relation);
  if (sign == "==") sign = "=";
  const std::string width = type == "I" ? "W" : type == "DI" ? "D" : type;
  std::string mnemonic = fmt::format("{}{}{}", load, width, sign);
  return find_instruction(mnemonic) ? mnemonic : std::string{};
}

class NetworkWriter {
 public:
  NetworkWriter(const LadderNetwork& network, const std::map<std::string, stl::OperandValue>& operands,
                stl::Diagnostics& diagnostics)
      : network_(network), operands_(operands), diagnostics_(diagnostics) {}

  std::vector<stl::Statement> write() {
    if (network_.head) write_head(*network_.head);
    on_rail(network_.rail.branches);
    if (failed_) statements_.clear();
    return std::move(statements_);
  }

 private:
  void complain(const stl::Position& at, std::string message, std::string hint) {
    failed_ = true;
    diagnostics_.push_back(
        {stl::Severity::Error, at, fmt::format("network {}: {}", network_.number, message), std::move(hint)});
  }

  void put(std::string_view mnemonic, const stl::Position& at, std::vector<stl::Operand> operands = {}) {
    statements_.push_back({std::string(mnemonic), at, std::move(operands), {}});
  }

  stl::Operand operand(const LadderText& text) {
    const auto known = operands_.find(text.text);
    if (known != operands_.end()) return {known->second, text.position};
    complain(text.position, fmt::format("'{}' is not an operand", stl::shortened(text.text)),
             "expected an address such as VW100, I0.3, *AC1 or &VB0, or a constant such as K5 or KH1F");
    return {stl::Name{text.text}, text.position};
  }

  std::vector<stl::Operand> operands_above(const LadderElement& element) {
    std::vector<stl::Operand> operands;
    for (const LadderText& text : element.operands) operands.push_back(operand(text));
    return operands;
  }

  void write_head(const LadderElement& head) {
    const Instruction* instruction = find_instruction(stl::upper_case(head.symbol));
    if (!instruction || !(begins_routine(instruction->structure) || instruction->structure == Structure::Label))
      return complain(head.position,
                      fmt::format("'{}' is not the head of a routine or a label", stl::shortened(head.symbol)),
                      "expected SBR, INT or LBL and a number");
    put(instruction->mnemonic, head.position, operands_above(head));
  }

  // ---- power flow ----

  void always(const stl::Position& at) { put("LD", at, {{stl::Address{"SM", stl::Size::Bit, 0, 0}, at}}); }

  /// What hangs from the power rail: outputs that always run, and contacts that begin a rung.
  void on_rail(const std::vector<LadderBranch>& branches) {
    bool loaded = false;  // SM0.0 is on top of the stack
    for (const LadderBranch& branch : branches) {
      const bool wire = is_wire(branch.path);
      if (wire && branch.output && !loaded && needs_load(*branch.output)) {
        always(branch.output->position);
        loaded = true;
      }
      if (!wire) {
        load(branch.path, true);
        loaded = false;
      }
      after_path(branch, wire);
      loaded = loaded && keeps_power_flow(branch);
    }
  }

  static bool needs_load(const LadderElement& output) {
    const Instruction* instruction = find_instruction(output.symbol);
    return !instruction || instruction->rung.needs_power_flow || instruction->rung.stack.needs > 0;
  }

  void after_path(const LadderBranch& branch, bool on_rail) {
    if (branch.output) output(*branch.output, branch.more_inputs, on_rail);
    if (branch.output && !branch.branches.empty()) put("AENO", branch.output->position);
    at_point(branch.branches);
  }

  /// Whether the top of the stack is the same after a branch: nothing but an output, after whose ENO nothing hangs.
  static bool keeps_power_flow(const LadderBranch& branch) { return is_wire(branch.path) && branch.branches.empty(); }

  /// What hangs from a point whose power flow is on top of the stack.
  void at_point(const std::vector<LadderBranch>& branches) {
    std::size_t restores = 0;  // after each path that is not the last branch
    for (const LadderBranch& branch : branches) restores += !keeps_power_flow(branch) && &branch != &branches.back();
    bool saved = false;
    for (const LadderBranch& branch : branches) {
      if (keeps_power_flow(branch)) {
        after_path(branch, false);
        continue;
      }
      const stl::Position at = is_wire(branch.path) && branch.output ? branch.output->position : place_of(branch.path);
      if (restores > 0 && !saved) put("LPS", at);
      saved = true;
      extend(branch.path, true);
      after_path(branch, false);
      if (restores > 0) put(--restores > 0 ? "LRD" : "LPP", at);
    }
  }

  static stl::Position place_of(const LadderPath& path) {
    return path.kind == LadderPath::Kind::Contact ? path.contact.position
           : path.parts.empty()                   ? stl::Position{}
                                                  : place_of(path.parts.front());
  }

  /// Pushes the power flow through a path. `whole`: it comes straight from the rail.
  void load(const LadderPath& path, bool whole) {
    switch (path.kind) {
      case LadderPath::Kind::Contact:
        if (!works_on_power_flow(path)) return contact("LD", path.contact);
        if (whole) always(path.contact.position);
        return on_power_flow(path.contact, whole);
      case LadderPath::Kind::Series:
        for (const LadderPath& part : path.parts) &part == &path.parts.front() ? load(part, whole) : extend(part, whole);
        return;
      case LadderPath::Kind::Parallel:
        for (const LadderPath& part : path.parts) {
          if (&part == &path.parts.front()) {
            load(part, whole);
          } else if (part.kind == LadderPath::Kind::Contact && !works_on_power_flow(part)) {
            contact("O", part.contact);
          } else {
            load(part, whole);
            put("OLD", place_of(part));
          }
        }
    }
  }

  /// Leads the power flow on top of the stack through a path. `whole`: it is all that comes from the rail.
  void extend(const LadderPath& path, bool whole) {
    switch (path.kind) {
      case LadderPath::Kind::Contact:
        return works_on_power_flow(path) ? on_power_flow(path.contact, whole) : contact("A", path.contact);
      case LadderPath::Kind::Series:
        for (const LadderPath& part : path.parts) extend(part, whole);
        return;
      case LadderPath::Kind::Parallel:
        load(path, false);
        put("ALD", place_of(path));
    }
  }

  void contact(std::string_view load, const LadderElement& contact) {
    const std::string mnemonic = contact_mnemonic(load, contact.symbol);
    if (mnemonic.empty())
      return complain(
          contact.position, fmt::format("there is no contact ┤{}├", stl::shortened(contact.symbol)),
          "expected ┤   ├, ┤ / ├, ┤ I ├, ┤/I ├, ┤NOT├, ┤ P ├, ┤ N ├, or a comparison of B, W, D or R such as ┤ >= W ├");
    put(mnemonic, contact.position, operands_above(contact));
  }

  void on_power_flow(const LadderElement& contact, bool whole) {
    if (!whole)
      return complain(contact.position, fmt::format("┤{}├ stands in a branch beside others", contact.symbol),
                      "it works on all the power flow from the rail: draw it before the branch, or after it");
    put(contact.symbol == "NOT" ? "NOT" : contact.symbol == "P" ? "EU" : "ED", contact.position);
  }

  // ---- outputs ----

  void output(const LadderElement& element, const std::vector<LadderPath>& more_inputs, bool on_rail) {
    for (const LadderPath& input : more_inputs) is_wire(input) ? always(element.position) : load(input, true);
    if (element.kind == LadderElement::Kind::Coil)
      coil(element, on_rail);
    else
      box(element);
  }

  void coil(const LadderElement& coil, bool on_rail) {
    std::string mnemonic = stl::upper_case(coil.symbol);
    if (mnemonic.empty() || mnemonic == "I") mnemonic = "=" + mnemonic;
    if (!on_rail && (mnemonic == "RET" || mnemonic == "RETI")) mnemonic = "C" + mnemonic;  // as Micro/WIN draws them
    put_checked(mnemonic, coil, operands_above(coil), "coil");
  }

  void put_checked(std::string_view mnemonic, const LadderElement& element, std::vector<stl::Operand> operands,
                   std::string_view what) {
    const Instruction* instruction = find_instruction(mnemonic);
    if (!instruction || !(instruction->rung.writes_output || instruction->rung.stack == StackUse{}))
      return complain(
          element.position, fmt::format("there is no {} '{}'", what, stl::shortened(element.symbol)),
          element.kind == LadderElement::Kind::Coil
              ? "expected nothing, I, S, R, SI, RI, or an instruction such as CALL, JMP or RET between the brackets"
              : "expected a name such as MOV_W, ADD_I or ATCH in the upper edge");
    const bool parameters = instruction->structure == Structure::Call && !operands.empty();
    if (instruction->modelled() && !parameters && operands.size() != instruction->rules().size())
      return complain(element.position,
                      fmt::format("this {} has {}, and {} takes {}", what, counted(operands.size(), "operand"),
                                  instruction->mnemonic, instruction->rules().size()),
                      fmt::format("expected {}", syntax(*instruction)));
    put(mnemonic, element.position, std::move(operands));
  }

  void box(const LadderElement& box) {
    const LadderBox* row = find_ladder_box(stl::upper_case(box.symbol));
    if (!row || has_pins_of_instruction(box, *row)) {
      std::vector<stl::Operand> operands = operands_above(box);
      for (const bool output : {false, true})
        for (const LadderPin& pin : box.pins)
          if (pin.output == output) operands.push_back(operand(pin.operand));
      return put_checked(stl::upper_case(box.symbol), box, std::move(operands), "box");
    }
    std::vector<stl::Operand> pins;
    for (const std::string_view name : row->pins) {
      if (name.empty()) continue;
      const auto pin = std::ranges::find(box.pins, name, &LadderPin::name);
      if (pin != box.pins.end()) pins.push_back(operand(pin->operand));
    }
    const auto expected =
        static_cast<std::size_t>(std::ranges::count_if(row->pins, [](auto name) { return !name.empty(); }));
    if (pins.size() != expected || box.pins.size() != expected || !box.operands.empty())
      return complain(box.position, fmt::format("the box {} does not have its pins", row->name),
                      fmt::format("expected {}", pins_text(*row)));
    combine(*row, box, pins);
  }

  /// MUL and DIV have the names of their boxes: IN1 and OUT are the operands of the instruction.
  static bool has_pins_of_instruction(const LadderElement& box, const LadderBox& row) {
    const Instruction* instruction = find_instruction(stl::upper_case(box.symbol));
    return row.form == Form::Product && instruction && box.pins.size() == instruction->rules().size();
  }

  static std::string pins_text(const LadderBox& row) {
    std::string text = "EN";
    for (const std::string_view name : row.pins)
      if (!name.empty()) text.append(", ").append(name);
    return text;
  }

  void combine(const LadderBox& row, const LadderElement& box, const std::vector<stl::Operand>& pins) {
    const auto same = [](const stl::Operand& a, const stl::Operand& b) { return a.value == b.value; };
    const stl::Operand& in = pins.front();
    const stl::Operand& out = pins.back();
    switch (row.form) {
      case Form::Pins:
        return put(row.mnemonic, box.position, pins);
      case Form::InPlace:
        if (!same(in, out)) put(row.move, box.position, {in, out});
        return put(row.mnemonic, box.position, {out});
      case Form::Shift:
        if (!same(in, out) && !survives(pins[1], out, box)) return;
        if (!same(in, out)) put(row.move, box.position, {in, out});
        return put(row.mnemonic, box.position, {out, pins[1]});
      case Form::Sum:
        if (same(pins[1], out)) return put(row.mnemonic, box.position, {in, out});
        [[fallthrough]];
      case Form::Difference:
        if (!same(in, out) && !survives(pins[1], out, box)) return;
        if (!same(in, out)) put(row.move, box.position, {in, out});
        return put(row.mnemonic, box.position, {pins[1], out});
      case Form::Product: {
        const std::optional<stl::Operand> low = low_word(out);
        if (!low)
          return complain(out.position, fmt::format("the box {} needs the low word of its result for IN1", row.name),
                          "expected a double word or an accumulator at OUT");
        if (!same(in, *low) && !survives(pins[1], *low, box)) return;
        if (!same(in, *low)) put(row.move, box.position, {in, *low});
        return put(row.mnemonic, box.position, {pins[1], out});
      }
    }
  }

  /// Whether the second input is still there after the first has been moved to the result.
  bool survives(const stl::Operand& input, const stl::Operand& result, const LadderElement& box) {
    if (!changes(result, input)) return true;
    complain(input.position,
             fmt::format("{} is lost when the first input of the box {} is moved to {}", stl::to_text(input), box.symbol,
                         stl::to_text(result)),
             "expected another address for the result; STL has two operands for this box");
    return false;
  }

  const LadderNetwork& network_;
  const std::map<std::string, stl::OperandValue>& operands_;
  stl::Diagnostics& diagnostics_;
  std::vector<stl::Statement> statements_;
  bool failed_ = false;
};

}  // namespace

namespace {

/// The statements of a network that is not drawn, at their places in the page.
void add_listing(const LadderNetwork& network, stl::ParseResult& result) {
  if (network.listing.empty()) return;
  std::string text;
  for (const LadderText& line : network.listing) text += line.text + "\n";
  const auto move = [&](stl::Position& at) { at.line = network.listing[at.line - 1].position.line; };
  stl::ParseResult parsed = stl::parse(text, {});
  for (stl::Line& line : parsed.source.lines) {
    auto* statement = std::get_if<stl::Statement>(&line);
    if (!statement) continue;
    move(statement->position);
    for (stl::Operand& operand : statement->operands) move(operand.position);
    result.source.lines.emplace_back(std::move(*statement));
  }
  for (stl::Diagnostic& diagnostic : parsed.diagnostics) {
    move(diagnostic.position);
    result.diagnostics.push_back(std::move(diagnostic));
  }
}

}  // namespace

namespace {

bool begins_routine(const LadderNetwork& network) {
  return network.head && (network.head->symbol == "SBR" || network.head->symbol == "INT");
}

void end_block(std::uint32_t line, stl::ParseResult& result) {
  auto& blocks = result.source.blocks;
  if (!blocks.empty() && blocks.back().last_line == 0) blocks.back().last_line = line;
}

/// The block of a routine whose head declares variables: what follows until the next head is in it.
void add_block(const LadderNetwork& head, stl::ParseResult& result) {
  const std::string& number = head.head->operands.front().text;
  stl::Block block{.kind = head.head->symbol == "INT" ? stl::Block::Kind::Interrupt : stl::Block::Kind::Subroutine,
                   .position = head.position,
                   .variables = head.variables};
  if (std::from_chars(number.data(), number.data() + number.size(), block.number).ec != std::errc{}) return;
  if (const stl::Variable* const last = stl::place_variables(block.variables))
    result.diagnostics.push_back({stl::Severity::Error, last->position,
                                  fmt::format("{} does not fit: the local memory of a block has {} bytes",
                                              stl::shortened(last->name), stl::kLocalBytes),
                                  "use V memory for some of the variables"});
  result.source.blocks.push_back(std::move(block));
}

}  // namespace

stl::ParseResult ladder_to_stl(const stl::LadderPage& page) {
  stl::ParseResult result;
  static_cast<stl::SourceLines&>(result.source) = page.source;
  result.diagnostics = page.diagnostics;
  const auto operands = operands_of(page);
  for (const LadderNetwork& network : page.networks) {
    for (const std::string& comment : network.comments)
      result.source.lines.emplace_back(stl::CommentLine{comment, network.position.line});
    result.source.lines.emplace_back(stl::NetworkHead{network.number, network.position, {}});
    if (!network.readable) continue;
    if (begins_routine(network)) end_block(network.position.line - 1, result);
    if (begins_routine(network) && !network.variables.empty()) add_block(network, result);
    add_listing(network, result);
    for (stl::Statement& statement : NetworkWriter(network, operands, result.diagnostics).write())
      result.source.lines.emplace_back(std::move(statement));
  }
  end_block(static_cast<std::uint32_t>(page.source.text.size()), result);
  stl::sort(result.diagnostics);
  return result;
}

Result<SourceText> read_drawings(std::string_view bytes, const std::string& name) {
  const auto decoded = stl::decode(bytes);
  if (!decoded) return decoded.trouble();
  return SourceText{ladder_to_stl(stl::read_ladder(decoded->text, name)), decoded->encoding, SourceKind::Document};
}

}  // namespace s7200
