// Mnemonics that the S7-200 does not have, written by people who know its German set or another family of controllers, or
// mistyped.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/nearest.hpp"
#include "interpreter/model/instruction.hpp"

namespace s7200 {
namespace {

struct Row {
  std::string_view mnemonic, what, hint;
};

constexpr std::string_view kGerman = "a German mnemonic";
constexpr std::string_view kStep7 = "a mnemonic of STEP 7 for the S7-300 and S7-400";
constexpr std::string_view kSmart = "an instruction of the S7-200 SMART";
constexpr std::string_view kAsCpu226 =
    "a program for the SMART runs here as CPU 226 as far as it goes; what GET and PUT do there, NETR and NETW do on a 226";
constexpr std::string_view kEnds = "the main program ends with MEND, a subroutine with RET, an interrupt routine with RETI";

// clang-format off
constexpr Row kRows[] = {
    {"NETZWERK", "a German keyword", "write NETWORK"},
    // German mnemonics that differ from the English ones in more than U for A.
    {"ZV",   kGerman, "write CTU"},
    {"ZVR",  kGerman, "write CTUD"},
    {"ZR",   kGerman, "write CTD"},
    {"SPA",  kGerman, "write JMP"},
    {"SPB",  kGerman, "write JMP"},
    {"L",    kStep7,  "the S7-200 has no accumulator to load: MOVB, MOVW, MOVD and MOVR move a value, MOVW IN, OUT"},
    {"T",    kStep7,  "the S7-200 moves a value with MOVB, MOVW, MOVD or MOVR: MOVW IN, OUT"},
    {"FP",   kStep7,  "write EU after the contact"},
    {"FN",   kStep7,  "write ED after the contact"},
    {"SE",   kStep7,  "write TON"},
    {"SS",   kStep7,  "write TONR"},
    {"SPBN", kStep7,  "write NOT, then JMP"},
    {"CC",   kStep7,  "write CALL, which needs power flow"},
    {"UC",   kStep7,  "write CALL after LD SM0.0"},
    {"BEB",  kStep7,  "write CRET in a subroutine, CRETI in an interrupt routine, END in the main program"},
    {"BE",   kStep7,  kEnds},
    {"BEA",  kStep7,  kEnds},
    {"GET",  kSmart,  kAsCpu226},
    {"PUT",  kSmart,  kAsCpu226},
    {"GIP",  kSmart,  kAsCpu226},
    {"SIP",  kSmart,  kAsCpu226},
};
// clang-format on

/// Of the German set or of another controller family.
std::optional<UnknownMnemonic> foreign_mnemonic(std::string_view mnemonic) {
  if (const auto* row = std::ranges::find(kRows, mnemonic, &Row::mnemonic); row != std::end(kRows))
    return UnknownMnemonic{std::string(row->what), std::string(row->hint)};
  const Instruction* meant = find_german_instruction(mnemonic);
  if (!meant) return {};
  return UnknownMnemonic{std::string(kGerman), std::string("write ").append(meant->mnemonic)};
}

/// The mnemonic that was probably meant; empty if none is close.
std::string_view nearest_mnemonic(std::string_view mnemonic) {
  static const std::vector<std::string_view> kMnemonics = [] {
    std::vector<std::string_view> mnemonics;
    for (const Instruction& instruction : all_instructions()) mnemonics.push_back(instruction.mnemonic);
    return mnemonics;
  }();
  return nearest(mnemonic, kMnemonics);
}

}  // namespace

const Instruction* find_german_instruction(std::string_view mnemonic) {
  if (!mnemonic.starts_with('U')) return nullptr;
  const Instruction* meant = find_instruction(std::string("A").append(mnemonic.substr(1)));
  return meant && !meant->rung.needs_power_flow && meant->modelled() ? meant : nullptr;  // but not ATCH, ATH, ATT
}

UnknownMnemonic unknown_mnemonic(std::string_view mnemonic) {
  if (auto foreign = foreign_mnemonic(mnemonic)) return *std::move(foreign);
  const std::string_view nearest = nearest_mnemonic(mnemonic);
  return {"", nearest.empty() ? "" : std::string("did you mean ").append(nearest).append("?")};
}

}  // namespace s7200
