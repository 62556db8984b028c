#include "interpreter/program/operands/parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/checking/special_memory_use.hpp"
#include "interpreter/stl/block_words.hpp"

namespace s7200 {
namespace {

using VariableKind = stl::Variable::Kind;
using Type = stl::Variable::Type;

constexpr Areas kBytes = set_of(Area::I) | set_of(Area::Q) | set_of(Area::M) | set_of(Area::SM) | set_of(Area::S) |
                         set_of(Area::V) | set_of(Area::L);
constexpr Areas kTimers = set_of(Area::T) | set_of(Area::C);

struct TypeRow {
  Width width;
  Areas read, written;  ///< besides kBytes
  Sign sign;
};

// By stl::Variable::Type.
constexpr std::array kTypes{
    TypeRow{Width::Bit, kTimers, kTimers, Sign::Either},
    TypeRow{Width::Byte, set_of(Area::AC), set_of(Area::AC), Sign::Either},
    TypeRow{Width::Byte, set_of(Area::AC), set_of(Area::AC), Sign::Either},
    TypeRow{Width::Word, kTimers | set_of(Area::AC) | set_of(Area::AI), kTimers | set_of(Area::AC), Sign::Either},
    TypeRow{Width::Word, kTimers | set_of(Area::AC) | set_of(Area::AI), kTimers | set_of(Area::AC), Sign::Signed},
    TypeRow{Width::Double, set_of(Area::AC) | set_of(Area::HC), set_of(Area::AC), Sign::Either},
    TypeRow{Width::Double, set_of(Area::AC) | set_of(Area::HC), set_of(Area::AC), Sign::Signed},
    TypeRow{Width::Double, set_of(Area::AC), set_of(Area::AC), Sign::Either},
    TypeRow{Width::Double, 0, 0, Sign::Either},
};

const TypeRow& row(Type type) { return kTypes[static_cast<std::size_t>(type)]; }

Role role_of(VariableKind kind) {
  return kind == VariableKind::Input ? Role::In : kind == VariableKind::Output ? Role::Out : Role::InOut;
}

OperandRule rule_of(const stl::Variable& variable) {
  const TypeRow& type = row(variable.type);
  const Role role = role_of(variable.kind);
  const bool input = role == Role::In, bit = type.width == Width::Bit, string = variable.type == Type::String;
  OperandRule rule{.name = variable.name, .width = type.width, .role = role, .sign = type.sign};
  rule.areas = static_cast<Areas>(string ? 0 : kBytes | (input ? type.read : type.written));
  rule.constant = input && !string;
  rule.pointer = !bit && !string;
  rule.address_of = input && (variable.type == Type::DWord || string);
  rule.real = variable.type == Type::Real;
  if (bit) {
    rule.min = 0;
    rule.max = 1;
  }
  return rule;
}

/// The operand that is meant by what is written for some types: 1 for TRUE, and a pointer for the address of a string.
stl::Operand as_meant(stl::Operand written, Type type) {
  if (const auto* name = std::get_if<stl::Name>(&written.value); name && type == Type::Bool) {
    const std::string upper = stl::upper_case(name->text);
    if (upper == "TRUE" || upper == "ON") written.value = stl::Integer{1};
    if (upper == "FALSE" || upper == "OFF") written.value = stl::Integer{0};
  }
  if (const auto* address = std::get_if<stl::Address>(&written.value); address && type == Type::String)
    written.value = stl::AddressOf{*address};
  return written;
}

std::vector<const stl::Variable*> formal_parameters(const stl::Block& block) {
  std::vector<const stl::Variable*> formal;
  for (const stl::Variable& variable : block.variables)
    if (variable.kind != VariableKind::Temporary) formal.push_back(&variable);
  return formal;
}

std::string declarations(const std::vector<const stl::Variable*>& formal) {
  std::vector<std::string> all;
  for (const stl::Variable* variable : formal)
    all.push_back(fmt::format("{} : {}", stl::shortened(variable->name), stl::word(variable->type).name));
  return fmt::format("{}", fmt::join(all, ", "));
}

Operand place_of(const stl::Address& local, Width width) {
  return {.at = info(Area::L).base + local.number, .bit = local.bit, .width = static_cast<std::uint16_t>(bytes_of(width))};
}

}  // namespace

std::optional<std::vector<Parameter>> place_parameters(const Instruction& call, const stl::Statement& statement,
                                                       const stl::Block& block, const CpuModel& model,
                                                       ConstantPool& constants, stl::Diagnostics& diagnostics) {
  const auto error = [&](const stl::Position& at, std::string message, std::string hint, std::string cause = {}) {
    diagnostics.push_back({stl::Severity::Error, at, std::move(message), std::move(hint), std::move(cause)});
    return std::nullopt;
  };
  const auto formal = formal_parameters(block);
  const std::size_t given = statement.operands.size() - 1;
  const std::string name = stl::shortened(block.name.empty() ? fmt::format("SBR{}", block.number) : block.name);
  if (given != formal.size())
    return error(given > formal.size() ? statement.operands[formal.size() + 1].position : statement.position,
                 fmt::format("CALL of {} takes {}, not {}", name,
                             formal.empty() ? "no parameters" : counted(formal.size(), "parameter"), given),
                 formal.empty() ? "" : fmt::format("they are {}", declarations(formal)));
  if (given > kMostParameters)
    return error(statement.operands[kMostParameters + 1].position,
                 fmt::format("a subroutine has at most {} parameters", kMostParameters),
                 "pass a pointer to a table instead");
  if (given > 0 && model.size_of(Area::L) == 0)
    return error(statement.operands[1].position, fmt::format("CPU {} has no parameters of subroutines", model.name),
                 needs("they need", kCpu22x), "parameters of subroutines");
  std::vector<Parameter> parameters;
  bool good = true;
  for (std::size_t i = 0; i < given; ++i) {
    const stl::Variable& variable = *formal[i];
    const OperandRule rule = rule_of(variable);
    const auto placed =
        place_operand(call, rule, as_meant(statement.operands[i + 1], variable.type), model, constants, diagnostics);
    good = good && placed;
    if (placed && placed->area == Area::SM)
      warn_of_special_memory(model, {placed->operand.at - image::kSM, bytes_of(rule.width)}, rule, statement, i + 1,
                             diagnostics);
    if (placed)
      parameters.push_back({placed->operand, place_of(variable.address, rule.width), rule.width, rule.role, rule.real});
  }
  if (!good) return {};
  return parameters;
}

}  // namespace s7200
