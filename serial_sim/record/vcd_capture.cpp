#include "serial_sim/record/vcd_capture.hpp"

#include <ostream>

namespace s7200::serial {
namespace {

struct Variable {
  char code;  ///< what stands for it in the dump
  std::string_view name;
};
constexpr std::array<Variable, kWires> kVariables{{{'r', "rx"}, {'t', "tx"}, {'l', "line"}}};

}  // namespace

VcdCapture::VcdCapture(std::ostream& out) : out_(out) {
  out_ << kBeginning
       << "the others drive, with what disturbs the line; tx is what the PLC drives; line is the level at its port, in a "
          "collision too; 1 is mark, the idle level $end\n"
          "$timescale 1 ns $end\n"
          "$scope module line $end\n";
  for (const Variable& variable : kVariables) out_ << "$var wire 1 " << variable.code << ' ' << variable.name << " $end\n";
  out_ << "$upscope $end\n"
          "$enddefinitions $end\n"
          "#0\n"
          "$dumpvars\n";
  for (const Variable& variable : kVariables) out_ << '1' << variable.code << '\n';
  out_ << "$end\n";
}

void VcdCapture::edge(Wire wire, Time at, bool mark, int) {
  go_to(at);
  out_ << (mark ? '1' : '0') << kVariables[static_cast<std::size_t>(wire)].code << '\n';
}

void VcdCapture::go_to(Time at) {
  if (at == at_) return;
  out_ << '#' << at << '\n';
  at_ = at;
}

}  // namespace s7200::serial
