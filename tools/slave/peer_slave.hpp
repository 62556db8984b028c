// A slave that is not a program: a simulated station of another make, alone with the master on a simulated line.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "serial_sim/system/system.hpp"
#include "tools/rig/capture_files.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

class PeerSlave final : public SlaveInSimulation {
 public:
  /// `line`: the master's, as far as it is not that of the station. `name`: as it was asked for.
  PeerSlave(std::unique_ptr<serial::Automaton> station, const serial::LineSettings& line,
            const std::vector<serial::Fault>& faults, std::string name);

  /// After Ctrl-C what there was of it. Throws std::invalid_argument for a byte with wrong parity in a format without.
  serial::Exchange exchange(const serial::Request& request) override;
  serial::Exchange receive(const serial::Listening& listening) override;
  void wait(Time duration) override { system_.run_until(system_.time() + duration); }
  Time now() const override { return system_.time(); }
  Time pause() const override;
  std::string remark() const override { return remark_; }
  std::string name() const override { return name_; }
  SerialFormat format() const override { return master_.uart().state().format; }

  const serial::Faults& faults() { return line_.faults(); }

  /// The line at the station's port is captured from now on. Not owned; they outlive the slave.
  void capture(CaptureFiles& captures) { captures.watch(station_, system_.time()); }

 private:
  serial::Exchange finish();

  serial::System system_;
  serial::SharedLine& line_;
  serial::ResponderStation& station_;
  serial::RequesterStation& master_;
  std::string name_;
  std::string remark_;
};

}  // namespace s7200::tools
