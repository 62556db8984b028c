#include "serial_sim/record/vcd_capture.hpp"

#include <ostream>

namespace s7200::serial {
namespace {

/// What stands for a wire in the dump.
constexpr std::array<char, kWires> kCode{'r', 't'};

}  // namespace

VcdCapture::VcdCapture(std::ostream& out) : out_(out) {
  out_ << kBeginning
       << "$timescale 1 ns $end\n"
          "$scope module line $end\n"
          "$var wire 1 "
       << kCode[0] << " rx $end\n$var wire 1 " << kCode[1]
       << " tx $end\n"
          "$upscope $end\n"
          "$enddefinitions $end\n"
          "#0\n"
          "$dumpvars\n1"
       << kCode[0] << "\n1" << kCode[1] << "\n$end\n";
}

void VcdCapture::edge(Wire wire, Time at, bool mark) {
  go_to(at);
  out_ << (mark ? '1' : '0') << kCode[static_cast<std::size_t>(wire)] << '\n';
}

void VcdCapture::go_to(Time at) {
  if (at == at_) return;
  out_ << '#' << at << '\n';
  at_ = at;
}

}  // namespace s7200::serial
