#include "interpreter/program/ladder/ladder_boxes.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

using Form = LadderBox::Form;

// clang-format off
constexpr LadderBox kBoxes[] = {
    {"MOV_B",    "MOVB",  Form::Pins,       {},     {"IN", "OUT"}},
    {"MOV_W",    "MOVW",  Form::Pins,       {},     {"IN", "OUT"}},
    {"MOV_DW",   "MOVD",  Form::Pins,       {},     {"IN", "OUT"}},
    {"MOV_R",    "MOVR",  Form::Pins,       {},     {"IN", "OUT"}},
    {"BLKMOV_B", "BMB",   Form::Pins,       {},     {"IN", "OUT", "N"}},
    {"BLKMOV_W", "BMW",   Form::Pins,       {},     {"IN", "OUT", "N"}},
    {"BLKMOV_D", "BMD",   Form::Pins,       {},     {"IN", "OUT", "N"}},
    {"FILL_N",   "FILL",  Form::Pins,       {},     {"IN", "OUT", "N"}},
    {"ATH",      "ATH",   Form::Pins,       {},     {"IN", "OUT", "LEN"}},
    {"HTA",      "HTA",   Form::Pins,       {},     {"IN", "OUT", "LEN"}},
    {"AD_T_TBL", "ATT",   Form::Pins,       {},     {"DATA", "TBL"}},
    {"READ_RTC", "TODR",  Form::Pins,       {},     {"T"}},
    {"SET_RTC",  "TODW",  Form::Pins,       {},     {"T"}},
    {"DI_REAL",  "DTR",   Form::Pins,       {},     {"IN", "OUT"}},
    {"B_I",      "BTI",   Form::Pins,       {},     {"IN", "OUT"}},
    {"I_B",      "ITB",   Form::Pins,       {},     {"IN", "OUT"}},
    {"I_DI",     "ITD",   Form::Pins,       {},     {"IN", "OUT"}},
    {"DI_I",     "DTI",   Form::Pins,       {},     {"IN", "OUT"}},
    {"MOV_BIR",  "BIR",   Form::Pins,       {},     {"IN", "OUT"}},
    {"MOV_BIW",  "BIW",   Form::Pins,       {},     {"IN", "OUT"}},
    {"ITA",      "ITA",   Form::Pins,       {},     {"IN", "OUT", "FMT"}},
    {"DTA",      "DTA",   Form::Pins,       {},     {"IN", "OUT", "FMT"}},
    {"RTA",      "RTA",   Form::Pins,       {},     {"IN", "OUT", "FMT"}},
    {"I_S",      "ITS",   Form::Pins,       {},     {"IN", "OUT", "FMT"}},
    {"DI_S",     "DTS",   Form::Pins,       {},     {"IN", "OUT", "FMT"}},
    {"R_S",      "RTS",   Form::Pins,       {},     {"IN", "OUT", "FMT"}},
    {"S_I",      "STI",   Form::Pins,       {},     {"IN", "INDX", "OUT"}},
    {"S_DI",     "STD",   Form::Pins,       {},     {"IN", "INDX", "OUT"}},
    {"S_R",      "STR",   Form::Pins,       {},     {"IN", "INDX", "OUT"}},
    {"STR_LEN",  "SLEN",  Form::Pins,       {},     {"IN", "OUT"}},
    {"STR_CPY",  "SCPY",  Form::Pins,       {},     {"IN", "OUT"}},
    {"STR_CAT",  "SCAT",  Form::Pins,       {},     {"IN", "OUT"}},
    {"STR_FIND", "SFND",  Form::Pins,       {},     {"IN1", "IN2", "OUT"}},
    {"CHR_FIND", "CFND",  Form::Pins,       {},     {"IN1", "IN2", "OUT"}},
    {"GET_ADDR", "GPA",   Form::Pins,       {},     {"ADDR", "PORT"}},
    {"SET_ADDR", "SPA",   Form::Pins,       {},     {"ADDR", "PORT"}},
    {"DIAG_LED", "DLED",  Form::Pins,       {},     {"IN"}},
    {"BGN_ITIME","BITIM", Form::Pins,       {},     {"OUT"}},
    {"CAL_ITIME","CITIM", Form::Pins,       {},     {"IN", "OUT"}},
    {"ADD_I",    "+I",    Form::Sum,        "MOVW", {"IN1", "IN2", "OUT"}},
    {"ADD_DI",   "+D",    Form::Sum,        "MOVD", {"IN1", "IN2", "OUT"}},
    {"ADD_R",    "+R",    Form::Sum,        "MOVR", {"IN1", "IN2", "OUT"}},
    {"MUL_I",    "*I",    Form::Sum,        "MOVW", {"IN1", "IN2", "OUT"}},
    {"MUL_DI",   "*D",    Form::Sum,        "MOVD", {"IN1", "IN2", "OUT"}},
    {"MUL_R",    "*R",    Form::Sum,        "MOVR", {"IN1", "IN2", "OUT"}},
    {"SUB_I",    "-I",    Form::Difference, "MOVW", {"IN1", "IN2", "OUT"}},
    {"SUB_DI",   "-D",    Form::Difference, "MOVD", {"IN1", "IN2", "OUT"}},
    {"SUB_R",    "-R",    Form::Difference, "MOVR", {"IN1", "IN2", "OUT"}},
    {"DIV_I",    "/I",    Form::Difference, "MOVW", {"IN1", "IN2", "OUT"}},
    {"DIV_DI",   "/D",    Form::Difference, "MOVD", {"IN1", "IN2", "OUT"}},
    {"DIV_R",    "/R",    Form::Difference, "MOVR", {"IN1", "IN2", "OUT"}},
    {"MUL",      "MUL",   Form::Product,    "MOVW", {"IN1", "IN2", "OUT"}},
    {"DIV",      "DIV",   Form::Product,    "MOVW", {"IN1", "IN2", "OUT"}},
    {"WAND_B",   "ANDB",  Form::Sum,        "MOVB", {"IN1", "IN2", "OUT"}},
    {"WAND_W",   "ANDW",  Form::Sum,        "MOVW", {"IN1", "IN2", "OUT"}},
    {"WAND_DW",  "ANDD",  Form::Sum,        "MOVD", {"IN1", "IN2", "OUT"}},
    {"WOR_B",    "ORB",   Form::Sum,        "MOVB", {"IN1", "IN2", "OUT"}},
    {"WOR_W",    "ORW",   Form::Sum,        "MOVW", {"IN1", "IN2", "OUT"}},
    {"WOR_DW",   "ORD",   Form::Sum,        "MOVD", {"IN1", "IN2", "OUT"}},
    {"WXOR_B",   "XORB",  Form::Sum,        "MOVB", {"IN1", "IN2", "OUT"}},
    {"WXOR_W",   "XORW",  Form::Sum,        "MOVW", {"IN1", "IN2", "OUT"}},
    {"WXOR_DW",  "XORD",  Form::Sum,        "MOVD", {"IN1", "IN2", "OUT"}},
    {"INC_B",    "INCB",  Form::InPlace,    "MOVB", {"IN", "OUT"}},
    {"INC_W",    "INCW",  Form::InPlace,    "MOVW", {"IN", "OUT"}},
    {"INC_DW",   "INCD",  Form::InPlace,    "MOVD", {"IN", "OUT"}},
    {"DEC_B",    "DECB",  Form::InPlace,    "MOVB", {"IN", "OUT"}},
    {"DEC_W",    "DECW",  Form::InPlace,    "MOVW", {"IN", "OUT"}},
    {"DEC_DW",   "DECD",  Form::InPlace,    "MOVD", {"IN", "OUT"}},
    {"INV_B",    "INVB",  Form::InPlace,    "MOVB", {"IN", "OUT"}},
    {"INV_W",    "INVW",  Form::InPlace,    "MOVW", {"IN", "OUT"}},
    {"INV_DW",   "INVD",  Form::InPlace,    "MOVD", {"IN", "OUT"}},
    {"BCD_I",    "BCDI",  Form::InPlace,    "MOVW", {"IN", "OUT"}},
    {"I_BCD",    "IBCD",  Form::InPlace,    "MOVW", {"IN", "OUT"}},
    {"SHL_B",    "SLB",   Form::Shift,      "MOVB", {"IN", "N", "OUT"}},
    {"SHL_W",    "SLW",   Form::Shift,      "MOVW", {"IN", "N", "OUT"}},
    {"SHL_DW",   "SLD",   Form::Shift,      "MOVD", {"IN", "N", "OUT"}},
    {"SHR_B",    "SRB",   Form::Shift,      "MOVB", {"IN", "N", "OUT"}},
    {"SHR_W",    "SRW",   Form::Shift,      "MOVW", {"IN", "N", "OUT"}},
    {"SHR_DW",   "SRD",   Form::Shift,      "MOVD", {"IN", "N", "OUT"}},
    {"ROL_B",    "RLB",   Form::Shift,      "MOVB", {"IN", "N", "OUT"}},
    {"ROL_W",    "RLW",   Form::Shift,      "MOVW", {"IN", "N", "OUT"}},
    {"ROL_DW",   "RLD",   Form::Shift,      "MOVD", {"IN", "N", "OUT"}},
    {"ROR_B",    "RRB",   Form::Shift,      "MOVB", {"IN", "N", "OUT"}},
    {"ROR_W",    "RRW",   Form::Shift,      "MOVW", {"IN", "N", "OUT"}},
    {"ROR_DW",   "RRD",   Form::Shift,      "MOVD", {"IN", "N", "OUT"}},
};
// clang-format on

/// A coil has at most an address and a number; all else is a box.
bool is_drawn_as_coil(const Instruction& instruction, const stl::Statement& statement) {
  switch (instruction.structure) {
    case Structure::Call:
      return statement.operands.size() == 1;
    case Structure::Jump:
    case Structure::SegmentBegin:
    case Structure::SegmentTransition:
      return true;
    default:
      return statement.operands.empty() || instruction.group == "Bit logic";
  }
}

std::string coil_symbol(std::string_view mnemonic) {
  if (mnemonic.starts_with('=')) return std::string(mnemonic.substr(1));
  if (mnemonic == "CRET" || mnemonic == "CRETI") return std::string(mnemonic.substr(1));  // as Micro/WIN draws them
  return std::string(mnemonic);
}

/// The pins at which a box takes the levels of the logic stack, from the deepest to the top.
std::vector<std::string> power_pins(const Instruction& instruction) {
  const std::string_view name = instruction.mnemonic;
  if (name == "CTU") return {"CU", "R"};
  if (name == "CTD") return {"CD", "LD"};
  if (name == "CTUD") return {"CU", "CD", "R"};
  return {instruction.hidden == Hidden::Number ? "IN" : "EN"};
}

/// The operands of the instruction at the pins of a box, in the order of the pins; none if the box does not show this.
std::vector<stl::Operand> at_pins(const LadderBox& box, const std::vector<stl::Operand>& operands) {
  const auto take = [&](std::initializer_list<std::size_t> numbers) {
    std::vector<stl::Operand> taken;
    for (const std::size_t number : numbers)
      if (number < operands.size()) taken.push_back(operands[number]);
    return taken;
  };
  switch (box.form) {
    case Form::Pins:
      return operands;
    case Form::InPlace:
      return take({0, 0});
    case Form::Shift:
      return take({0, 1, 0});
    case Form::Sum:
      return take({0, 1, 1});
    case Form::Difference:
      return take({1, 0, 1});
    case Form::Product: {
      if (operands.size() != 2) return {};
      const auto low = low_word(operands[1]);
      return low ? std::vector{*low, operands[0], operands[1]} : std::vector<stl::Operand>{};
    }
  }
  return {};
}

std::size_t pin_count(const LadderBox& box) {
  return static_cast<std::size_t>(std::ranges::count_if(box.pins, [](std::string_view name) { return !name.empty(); }));
}

/// The name of a parameter of a subroutine, and whether it is a result.
std::pair<std::string, bool> drawn_parameter(const stl::Statement& call, std::size_t number, const stl::Source& program) {
  const auto* subroutine = std::get_if<stl::Integer>(&call.operands.front().value);
  for (const stl::Block& block : program.blocks) {
    if (!subroutine || block.kind != stl::Block::Kind::Subroutine || block.number != subroutine->value) continue;
    std::size_t next = 1;
    for (const stl::Variable& variable : block.variables)
      if (variable.kind != stl::Variable::Kind::Temporary && next++ == number)
        return {variable.name, variable.kind == stl::Variable::Kind::Output};
  }
  return {"P" + std::to_string(number), false};
}

/// Pins named as the instruction's operands are. Those at the right come after all others, as they are read back.
void add_named_pins(stl::LadderElement& box, const stl::Statement& statement, const Instruction& instruction,
                    std::size_t first, const stl::Source& program) {
  for (std::size_t i = first; i < statement.operands.size(); ++i) {
    stl::LadderPin pin{"", operand_in_ladder(statement.operands[i]), false};
    if (instruction.structure == Structure::Call) {
      std::tie(pin.name, pin.output) = drawn_parameter(statement, i, program);
    } else if (i < instruction.rules().size()) {
      pin.name = instruction.rules()[i].name;
      pin.output = instruction.rules()[i].role == Role::Out;
    }
    box.pins.push_back(std::move(pin));
  }
  bool last = true;
  for (auto pin = box.pins.rbegin(); pin != box.pins.rend(); ++pin) pin->output = last = last && pin->output;
}

}  // namespace

stl::LadderText operand_in_ladder(const stl::Operand& operand) {
  stl::Operand unnamed = operand;
  unnamed.symbol.clear();
  return {stl::to_text(unnamed), operand.position};
}

const LadderBox* find_ladder_box(std::string_view name) {
  const auto* found = std::ranges::find(kBoxes, name, &LadderBox::name);
  return found == std::end(kBoxes) ? nullptr : found;
}

std::optional<stl::Operand> low_word(const stl::Operand& operand) {
  const auto* address = std::get_if<stl::Address>(&operand.value);
  if (!address) return {};
  if (address->area == "AC") return operand;
  if (address->size != stl::Size::Double) return {};
  stl::Operand low = operand;
  low.value = stl::Address{address->area, stl::Size::Word, address->number + 2, 0};
  return low;
}

stl::LadderElement ladder_output(const stl::Statement& statement, const Instruction& instruction,
                                 const stl::Source& program) {
  using Kind = stl::LadderElement::Kind;
  stl::LadderElement output{is_drawn_as_coil(instruction, statement) ? Kind::Coil : Kind::Box, "", statement.position};
  if (output.kind == Kind::Coil) {
    output.symbol = coil_symbol(instruction.mnemonic);
    for (const stl::Operand& operand : statement.operands) output.operands.push_back(operand_in_ladder(operand));
    return output;
  }
  output.power = power_pins(instruction);
  const auto* row = std::ranges::find(kBoxes, instruction.mnemonic, &LadderBox::mnemonic);
  const auto pins = row == std::end(kBoxes) ? std::vector<stl::Operand>{} : at_pins(*row, statement.operands);
  if (!pins.empty() && pins.size() == pin_count(*row)) {
    output.symbol = row->name;
    for (std::size_t i = 0; i < pins.size(); ++i)
      output.pins.push_back({std::string(row->pins[i]), operand_in_ladder(pins[i]), row->pins[i] == "OUT"});
    return output;
  }
  const bool above = instruction.hidden == Hidden::Number || instruction.structure == Structure::Call;
  output.symbol = instruction.mnemonic;
  if (above && !statement.operands.empty()) output.operands.push_back(operand_in_ladder(statement.operands.front()));
  add_named_pins(output, statement, instruction, above ? 1 : 0, program);
  return output;
}

}  // namespace s7200
