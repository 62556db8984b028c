// A simulated PLC of another make, on the command line.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/master/protocol.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace s7200::tools {

/// --protocol with the names of `choices`; the value is the first of them until it is given.
CLI::Option* add_protocol_option(CLI::App& app, const Protocol*& protocol, std::vector<const Protocol*> choices,
                                 const std::string& meaning);

/// The protocols that PLCs of another make speak.
std::vector<const Protocol*> protocols_of_other_plcs();

/// westinghouse:MODEL for completion, of an option that takes a PROGRAM too.
void offer_other_plcs(CLI::Option* target);

class OtherPlcOptions {
 public:
  /// --plc.
  CLI::Option* add_to(CLI::App& app);

  /// One of this model as the options set it. Throws std::invalid_argument if there is none that speaks the protocol, or it
  /// has no such setting. The protocol is one of protocols_of_other_plcs().
  std::unique_ptr<westinghouse::Plc> make(const Protocol& protocol, std::string_view model) const;

  /// The values of --plc.
  const std::vector<std::string>& settings() const { return settings_; }

 private:
  std::vector<std::string> settings_;
};

}  // namespace s7200::tools
