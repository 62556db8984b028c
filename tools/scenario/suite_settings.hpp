// What a suite is to run, and on what.
#pragma once

#include <string>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/model/times/times_band.hpp"
#include "serial_sim/peers/requester.hpp"
#include "tools/coverage/observed.hpp"

namespace s7200::tools {

struct SuiteSettings {
  std::vector<std::string> files{};  ///< of scenarios, or folders with .yaml files
  std::string with{};                ///< a file with values for the `${…}` of scenarios; "" for none
  std::string conformance{};         ///< instead of files, the rules of Modbus RTU for the slave that this file describes
  std::size_t random = 0;            ///< so many random requests
  std::uint32_t seed = 1;            ///< of them
  std::uint8_t station = 1;          ///< most of them go to
  std::string random_cpu = "214";    ///< of a program that gets them
  std::string only{};                ///< a pattern of their names, files or rules; "" for all
  std::string target{};              ///< instead of the programs that scenarios name
  std::string at{};                  ///< of a target that is a system file: the place where the master joins it
  std::vector<std::string> plc{};    ///< settings of a target that is a simulated PLC of another make, ...
  std::string protocol = "modbus";   ///< ... and what it speaks
  serial::MasterSettings line{};     ///< over those of the scenarios

  unsigned jobs = 1;              ///< scenarios at a time, on programs
  BandSettings band{};            ///< of execution times, for all scenarios on programs; none: for those that ask for it
  bool fail_fast = false;         ///< ends at the first failure
  bool exchanges_wanted = false;  ///< all of them are in the results
  bool runs_wanted = false;       ///< all of them can be run again, also those that found nothing
  bool every_scan = false;        ///< of programs: scans that are all alike are run, too
  bool no_stand_ins = false;      ///< a program that needs a stand-in for a library is refused
  Observed observed{};            ///< of programs in simulation
  StopToken stop{};               ///< ends all that runs
};

}  // namespace s7200::tools
