// `run` in real time and its bridges, on the command line.
#pragma once

#include <memory>
#include <string>

#include "tools/bridge.hpp"
#include "tools/master_options.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class BridgeOptions {
 public:
  void add_to(CLI::App& app);

  bool realtime() const { return realtime_ || speed_given_ || bridged(); }
  bool bridged() const { return !pty_.empty(); }
  double speed() const { return speed_; }
  const LineOptions& line() const { return line_; }

  /// The bridge asked for; null for none.
  std::unique_ptr<Bridge> make() const;

 private:
  std::string pty_;
  LineOptions line_;
  bool realtime_ = false, speed_given_ = false;
  double speed_ = 1;
};

}  // namespace s7200::tools
